# SPDX-License-Identifier: Apache-2.0
"""A vibrating bar that drifts slowly through cells: its edge node carries hardly any mass each time a
particle has just entered a cell, and `last` with linear functions tears the bar apart there."""
import math

from verification import Verification, particle_bodies

CELL, YOUNG, DENSITY, LENGTH = 0.1, 1e6, 1000.0, 1.0
SPEED = math.sqrt(YOUNG / DENSITY)
DRIFT = SPEED / 50
WAVE = 1e-4 * DRIFT  # energy of the vibration over that of the drift: 0.5e-8
CELLS = 3


def scene(update, courant, small_mass="none", shape="linear", front=None):
    centres = [[0.2 + (k + 0.5) * CELL / 2] for k in range(round(2 * LENGTH / CELL))]
    return {
        "title": f"drifting bar, {update}, {small_mass}, {front}, {shape}, Courant {courant:g}",
        "dimension": "line", "duration": CELLS * CELL / DRIFT,
        "grid": {"cell": CELL, "min": [0], "max": [2.5]},
        "solver": {"stress_update": update, "time_step": courant * CELL / SPEED, "shape": shape,
                   "allow_unstable": True, "stabilise": {"small_mass": small_mass} | (
                       {"front_smoothing": {"reading": front}} if front else {})},
        "materials": {"metal": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": 0}},
        "bodies": particle_bodies(
            centres, [CELL / 2], "metal",
            lambda c: [DRIFT + WAVE * math.cos(math.pi * (c[0] - 0.2) / LENGTH)]),
        "output": {"frames": {"every": 0}, "history": {"every": CELL / DRIFT / 100}},
    }


def growth(verification, *arguments, expected_exit=0, **options):
    """Largest energy of the vibration over that at the start."""
    run = verification.run(scene(*arguments, **options), expected_exit=expected_exit)
    drift = 0.5 * DENSITY * LENGTH * DRIFT**2
    waves = [kinetic + strain - drift for kinetic, strain in
             zip(run.series["energy.kinetic"], run.series["energy.strain"])]
    return max(waves) / waves[0], run


verification = Verification("small-nodal-mass")
failure, _ = growth(verification, "last", 0.3, expected_exit=11)
verification.above("last, linear: energy of the vibration grows within three cells", failure, 1e6)
for update in ("modified_last", "first"):
    for courant, bound in ((0.3, 1.2), (0.6, 1.2), (0.9, 2.0)):
        calm, _ = growth(verification, update, courant)
        verification.below(f"{update}, Courant {courant:g}: the same", calm, bound)
calm, _ = growth(verification, "last", 0.3, shape="bspline2")
verification.below("last, quadratic splines: the same", calm, 1.2)
# The treatments move forces, which costs energy of the order of the vibration at every crossing; what
# they must do is to keep it from growing without bound.
for treatment, bound in (("redistribute", 2.0), ("cutoff", 1e4)):
    calm, run = growth(verification, "last", 0.3, small_mass=treatment)
    verification.below(f"last, small_mass {treatment}: the same", calm, bound)
    verification.below(f"last, small_mass {treatment}: momentum", run.metrics["momentum_error"], 1e-12)
# Where an edge node is nearly empty its particles strain with the velocity before the step, as with
# `first`. Flying on without strain keeps nothing together: energy grows.
calm, run = growth(verification, "last", 0.3, front="start_velocity")
verification.below("last, front smoothing with the start velocity: the same", calm, 1.06)
verification.below("last, front smoothing with the start velocity: momentum",
                   run.metrics["momentum_error"], 1e-12)
growing, run = growth(verification, "last", 0.3, front="free_flight")
verification.above("last, front smoothing by free flight: the same", growing, 2.0)
verification.finish()
