# SPDX-License-Identifier: Apache-2.0
"""Rotation must not strain: each material along a path with and without a superposed rotation, and
a disc that spins freely through the grid."""
import math

import numpy

from verification import Verification, particle_bodies

SOIL = {"density": 2000, "bulk_modulus": 8.33e6, "shear_modulus": 3.85e6}
MATERIALS = {
    "linear_elastic": SOIL,
    "neo_hookean": SOIL,
    "newtonian_fluid": {"density": 1000, "bulk_modulus": 8.33e6},
    "j2": {**SOIL, "yield_stress": 2e5, "isotropic_hardening": 1e5, "kinematic_hardening": 2e5},
    "drucker_prager": {**SOIL, "friction_angle": 30, "cohesion": 1000, "dilation_angle": 5,
                       "isotropic_hardening": 1e5, "kinematic_hardening": 2e5},
    "drucker_prager_cap": {**SOIL, "friction_angle": 30, "cone_strength": 1000, "flow_ratio": 0.1},
    "drucker_prager_mobilised": {**SOIL, "friction": {"a0": 35, "a1": 9, "a3": 0.3, "a4": 10,
                                                      "strain_scale": 100}},
    "matsuoka_nakai": {**SOIL, "friction": {"a0": 35, "a1": 9, "a3": 0.3, "a4": 10,
                                            "strain_scale": 100}},
    "matsuoka_nakai, own potential": {**SOIL, "model": "matsuoka_nakai", "friction_angle": 35,
                                      "dilation_angle": 10, "cohesion": 1000,
                                      "potential": "matsuoka_nakai"},
    "mohr_coulomb": {**SOIL, "friction_angle": 30, "dilation_angle": 10, "cohesion": 1000,
                     "tensile_strength": 500, "residual_friction_angle": 20, "softening_rate": 20},
    "tresca": {**SOIL, "cohesion": 2e4, "residual_cohesion": 1e4, "softening_rate": 20},
}
STEPS, TURN = 200, 2 * math.pi


def rotation(angle):
    """About an axis that is none of the grid's."""
    x, y, z = numpy.array([1.0, 2.0, -1.0]) / math.sqrt(6)
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def stretch(share):
    """Shear with some compression, up to 12 % and into plastic flow."""
    return numpy.array([[1 + 0.02 * share, 0.12 * share, 0],
                        [0, 1 - 0.04 * share, 0.02 * share],
                        [0.01 * share, 0, 1 + 0.015 * share]])


def tensor(components):
    xx, yy, zz, xy, yz, xz = components
    return numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def drive(verification, model, turn):
    path = [{"deformation_gradient": (rotation(turn * k / STEPS)
                                      @ stretch(k / STEPS)).reshape(-1).tolist(), "steps": 1}
            for k in range(1, STEPS + 1)]
    return verification.point({"material": {"model": model, **MATERIALS[model]},
                               "strain": "finite", "initial_stress": [-5e4] * 3 + [0] * 3,
                               "path": path})


def check_point(verification, model):
    plain, turned = drive(verification, model, 0), drive(verification, model, TURN * 0.7)
    worst = 0.0
    for k, (a, b) in enumerate(zip(plain, turned), start=1):
        spin = rotation(TURN * 0.7 * k / STEPS)
        expected = spin @ tensor(a["stress"]) @ spin.T
        worst = max(worst, numpy.abs(tensor(b["stress"]) - expected).max()
                    / numpy.abs(expected).max())
    verification.below(f"{model}: stress with superposed rotation against rotated stress, relative",
                       worst, 1e-9)
    if model not in ("linear_elastic", "neo_hookean", "newtonian_fluid"):
        verification.above(f"{model}: plastic strain on the way", plain[-1]["plastic_strain"], 0.01)


RADIUS, SPACING, CELL, RATE = 0.5, 0.05, 0.1, TURN
DENSITY, YOUNG = 1000.0, 1e6


def disc_scene():
    centre = (1.013, 0.987)
    half = round(RADIUS / SPACING)
    points = [(centre[0] + (i + 0.5) * SPACING, centre[1] + (j + 0.5) * SPACING)
              for i in range(-half, half) for j in range(-half, half)
              if math.hypot((i + 0.5) * SPACING, (j + 0.5) * SPACING) <= RADIUS]
    return {
        "title": "spinning disc",
        "dimension": "plane_strain",
        "duration": TURN / RATE,
        "grid": {"cell": CELL, "min": [0, 0], "max": [2, 2]},
        "solver": {"strain": "finite", "stabilise": {"viscous_damping": 0.3}},
        "materials": {"rubber": {"model": "linear_elastic", "density": DENSITY,
                                 "young_modulus": YOUNG, "poisson_ratio": 0.3}},
        "bodies": particle_bodies(points, [SPACING] * 2, "rubber",
                                  lambda c: [-RATE * (c[1] - centre[1]),
                                             RATE * (c[0] - centre[0])]),
        "probes": [{"name": name, "kind": "integral", "field": "stress", "component": name}
                   for name in ("xx", "yy", "xy")],
        "output": {"history": {"every": 0.002},
                   "frames": {"every": 0.25, "fields": ["velocity", "mass"],
                              "precision": "double"}},
    }


def angular_momentum(frame):
    mass, position, velocity = frame["mass"].reshape(-1), frame["position"], frame["velocity"]
    return float((mass * (position[:, 0] * velocity[:, 1] - position[:, 1] * velocity[:, 0])).sum()
                 - (mass * position[:, 0]).sum() * (mass * velocity[:, 1]).sum() / mass.sum()
                 + (mass * position[:, 1]).sum() * (mass * velocity[:, 0]).sum() / mass.sum())


def check_disc(verification):
    """Virial theorem: over a long time the integral of tr sigma is twice the kinetic energy."""
    run = verification.run(disc_scene())
    begin, end = 0.5 * TURN / RATE, TURN / RATE
    trace = run.mean("probe.xx", begin, end) + run.mean("probe.yy", begin, end)
    kinetic = run.mean("energy.kinetic", begin, end)
    verification.relative("spinning disc, second half turn: integral of tr sigma against 2 K [J/m]",
                          trace, 2 * kinetic, 0.03)
    verification.relative("spinning disc: integral of sigma_xx against sigma_yy [J/m]",
                          run.mean("probe.xx", begin, end), run.mean("probe.yy", begin, end), 0.05)
    verification.below("spinning disc: integral of sigma_xy over that of sigma_xx",
                       abs(run.mean("probe.xy", begin, end) / run.mean("probe.xx", begin, end)),
                       0.05)
    # A lumped mass does not keep angular momentum: the centroid of what moves a node at the rim is
    # not the node. The step has no part in it (7.3 % a turn, 7.5 % at a quarter of the step, 10 % in
    # cells of twice the size).
    lost = 1 - angular_momentum(run.frame(-1)) / angular_momentum(run.frame(0))
    verification.deviation("spinning disc, one turn: angular momentum lost", lost, 0.02, 0.10)


verification = Verification("rotation")
for model in MATERIALS:
    check_point(verification, model)
check_disc(verification)
verification.finish()
