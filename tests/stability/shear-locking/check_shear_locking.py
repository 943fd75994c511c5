# SPDX-License-Identifier: Apache-2.0
"""Bending in cells four times as long as high: the shear stress of the standard method follows the
cells, not the beam (Mast 2013, sec. 6.2, Fig. 6.9b)."""
import math

import numpy

import beam_theory
from verification import FULL, Verification

MODULI = (70.28e9, 26.23e9)
HEIGHT = 0.25 if FULL else 0.5
CELL = [4 * HEIGHT, HEIGHT]
beam = beam_theory.Beam(*MODULI)


def shear_at_peak(verification, method, field):
    """RMS error of sigma_12, x > H, over the largest of theory, and the share of the cells' rows of
    particles along which it changes its sign. Theory changes none."""
    run = verification.run(beam_theory.scene(f"long cells, {method}", "plane_stress", MODULI, CELL,
                                             2e-5 * HEIGHT, math.pi / 2 / beam.timoshenko, field, 4))
    motion = beam_theory.Motion(run)
    shear = motion.stress[-1][:, 3]
    expected = beam.stress(motion.x, motion.y, beam.amplitude)[1]
    far = motion.x > beam_theory.DEPTH
    rows = {}
    for x, y, value in zip(motion.x, motion.y, shear):
        rows.setdefault((int(x // CELL[0]), round(float(y), 6)), []).append(value)
    flips = numpy.mean([min(row) * max(row) < 0 for row in rows.values()])
    error = numpy.sqrt(((shear - expected)[far] ** 2).mean()) / beam.largest_stress()[1]
    return float(error), float(flips)


verification = Verification("shear-locking")
error, flips = shear_at_peak(verification, "standard", None)
verification.above("standard: RMS error of sigma_12 over its largest value", error, 1.0)
verification.above("standard: share of cells along which sigma_12 changes its sign", flips, 0.8)
# A shear that is constant over a cell misses the parabola over two cells by up to half of its height.
error, flips = shear_at_peak(verification, "full anti-locking", "full")
verification.below("full: RMS error of sigma_12 over its largest value", error, 0.5)
verification.equal("full: share of cells along which sigma_12 changes its sign", flips, 0.0)
verification.finish()
