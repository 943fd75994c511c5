# SPDX-License-Identifier: Apache-2.0
"""A cantilever in plane stress: shear locking, stresses and their convergence (Mast 2013, sec. 6.2)."""
import math

import numpy

import beam_theory
from verification import FULL, Verification

MODULI = (70.28e9, 26.23e9)
METHODS = {"STD": None, "AL": "full", "ALCV": "full_constant_volume"}
LEVELS = [1, 2, 3, 4] + ([5] if FULL else [])
FINEST = LEVELS[-1]

beam = beam_theory.Beam(*MODULI)
PERIOD = 2 * math.pi / beam.timoshenko
FRAMES = 48


def rms(values):
    return float(numpy.sqrt((values ** 2).mean()))


class Result:
    def __init__(self, verification, title, cell, time_step, field):
        run = verification.run(beam_theory.scene(title, "plane_stress", MODULI, cell, time_step,
                                                 PERIOD, field, FRAMES))
        motion = beam_theory.Motion(run)
        tip, place = motion.tip()
        amplitude, omega = beam_theory.fit_sine(motion.time, tip, beam.timoshenko)
        self.period = 2 * math.pi / omega / PERIOD
        self.amplitude = amplitude / float(beam.shape(place)) * beam.timoshenko / beam_theory.TIP_SPEED
        self.far = motion.x > beam_theory.DEPTH
        self.energy_error = run.metrics["energy_error"]
        self.peak(motion)
        everywhere = numpy.ones(len(motion.x), dtype=bool)
        self.error = self.energy_norm(motion, beam.timoshenko, everywhere)
        self.far_error = self.energy_norm(motion, beam.timoshenko, self.far)
        self.euler_error = self.energy_norm(motion, beam.euler, self.far)

    def peak(self, motion):
        """Stresses at the first largest deflection, over the largest of the theory."""
        frame = int(numpy.argmin(abs(motion.time - PERIOD / 4)))
        normal, shear = beam.stress(motion.x, motion.y, beam.amplitude)
        largest = beam.largest_stress()
        self.normal = rms((motion.stress[frame][:, 0] - normal)[self.far]) / largest[0]
        self.shear = rms((motion.stress[frame][:, 3] - shear)[self.far]) / largest[1]
        self.wild = abs(motion.stress[frame][:, 3][self.far]).max() / largest[1]
        self.reversed = float((motion.stress[frame][:, 3] * shear < 0)[self.far].mean())

    def energy_norm(self, motion, omega, chosen):
        """Eq. 6.4 of the source over that of the theory itself: a sum over particles, integrated
        over a period."""
        def density(xx, yy, xy):
            return (xx * xx + yy * yy - 2 * beam.poisson * xx * yy
                    + 2 * (1 + beam.poisson) * xy * xy) / beam.young

        wrong, whole = [], []
        for time, stress in zip(motion.time, motion.stress):
            deflection = beam_theory.TIP_SPEED / omega * math.sin(omega * time)
            normal, shear = beam.stress(motion.x, motion.y, deflection)
            gap = density(stress[:, 0] - normal, stress[:, 1], stress[:, 3] - shear)
            wrong.append((motion.volume * gap)[chosen].sum())
            whole.append((motion.volume * density(normal, 0 * normal, shear))[chosen].sum())
        return float(numpy.trapz(wrong, motion.time) / numpy.trapz(whole, motion.time))


def order(results, method, name):
    coarse, fine = (getattr(results[method, level], name) for level in (3, FINEST))
    return math.log2(coarse / fine) / (FINEST - 3)


def report(label, result):
    """What the source shows as plots."""
    print(f"  {label}: over Timoshenko's, period {result.period:.4f}, amplitude "
          f"{result.amplitude:.4f}; energy norm {result.error:.4g}, x > H {result.far_error:.4g}, "
          f"with Euler's frequency {result.euler_error:.4g}; RMS errors at the peak, x > H, "
          f"sigma_11 {result.normal:.4g}, sigma_12 {result.shear:.4g}, largest sigma_12 "
          f"{result.wild:.3g}")


def check_levels(verification):
    results = {}
    for level in LEVELS:
        size = 0.5 ** (level - 1)
        for method, field in METHODS.items():
            results[method, level] = Result(verification, f"cantilever #{level}, {method}", size,
                                            2e-5 * size, field)
            report(f"#{level} {method}", results[method, level])
    verification.relative("#4 AL: period against Timoshenko's",
                          results["AL", 4].period, 1.0, 0.02)
    verification.below(f"#{FINEST} AL: sigma_12, RMS error over the largest of theory",
                       results["AL", FINEST].shear, 0.10)
    verification.above(f"#{FINEST}: RMS error of sigma_12, STD over AL",
                       results["STD", FINEST].shear / results["AL", FINEST].shear, 2.0)
    for method in METHODS:
        verification.above(f"{method}: order of the energy norm, x > H, #3 to #{FINEST}",
                           order(results, method, "far_error"), 1.5)
        verification.below(f"{method}: energy gained, largest of all levels",
                           max(results[method, level].energy_error for level in LEVELS), 0.01)
    verification.above("AL: orders of the energy norm, without over with the clamp",
                       order(results, "AL", "far_error") / order(results, "AL", "error"), 1.2)
    for level in LEVELS:
        others = min(results[method, level].far_error for method in ("STD", "ALCV"))
        verification.below(f"#{level}: energy norm of AL over the better of the others, x > H",
                           results["AL", level].far_error / others, 1.0)
    for level in (1, 2):
        verification.above(f"#{level}: energy norm of ALCV over that of STD, x > H (coarse: worse)",
                           results["ALCV", level].far_error / results["STD", level].far_error, 1.0)
    verification.below(f"#{FINEST}: energy norm of ALCV over that of STD, x > H (fine: better)",
                       results["ALCV", FINEST].far_error / results["STD", FINEST].far_error, 1.0)


def check_rectangular(verification):
    """Cells four times as long as high, at the height of #4."""
    results = {}
    for method in ("STD", "AL"):
        results[method] = Result(verification, f"cantilever, h_x = 4 h_y, {method}", [0.5, 0.125],
                                 2.5e-6, METHODS[method])
        report(f"h_x = 4 h_y, {method}", results[method])
    verification.above("h_x = 4 h_y, STD: RMS error of sigma_12 over its largest value",
                       results["STD"].shear, 1.0)
    verification.above("h_x = 4 h_y, STD: share of particles with sigma_12 of the wrong sign",
                       results["STD"].reversed, 0.1)
    verification.below("h_x = 4 h_y, AL: RMS error of sigma_12 over its largest value",
                       results["AL"].shear, 0.2)


verification = Verification("mast-6.2-cantilever")
verification.relative("Euler-Bernoulli frequency [rad/s]", beam.euler, 51.579, 1e-5)
verification.relative("Timoshenko over Euler-Bernoulli frequency", beam.timoshenko / beam.euler,
                      0.99198, 1e-5)
check_levels(verification)
check_rectangular(verification)
verification.finish()
