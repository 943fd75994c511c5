# SPDX-License-Identifier: Apache-2.0
"""A body that flies freely through the grid, in one, two and three dimensions."""
import math

from verification import Verification

AXES = {"line": 1, "plane_strain": 2, "solid": 3}
GRAVITY = [-1.7, -9.81, 0.9]
VELOCITY = [2.0, 3.0, -1.0]
STEP, STEPS = 1 / 1024, 512


def scene(dimension):
    axes = AXES[dimension]
    return {
        "title": f"free fall, {dimension}",
        "dimension": dimension,
        "duration": STEP * STEPS,
        "grid": {"cell": 0.25, "min": [-4] * axes, "max": [4] * axes},
        "solver": {"time_step": STEP},
        "materials": {"body": {"model": "linear_elastic", "density": 1500,
                               "young_modulus": 1e7, "poisson_ratio": 0.3}},
        "bodies": [{"material": "body",
                    "box": {"min": [0.1] * axes, "max": [0.7] * axes},
                    "particles_per_cell": [2] * axes, "velocity": VELOCITY[:axes]}],
        "gravity": GRAVITY[:axes],
        "probes": [{"name": "centre", "kind": "centre_of_mass"}],
        "output": {"history": {"every": STEP * 16}},
    }


def check(verification, dimension):
    axes = AXES[dimension]
    run = verification.run(scene(dimension))
    duration = STEP * STEPS
    discrete, exact = 0.0, 0.0
    for axis in range(axes):
        name = "probe.centre" + ("." + "xyz"[axis] if axes > 1 else "")
        if name not in run.series:
            name = "probe.centre.x"
        for time, value in zip(run.time, run.series[name]):
            parabola = 0.4 + VELOCITY[axis] * time + GRAVITY[axis] * time**2 / 2
            # Velocity first, then position: the sum over the steps is the parabola plus g t dt / 2.
            discrete = max(discrete, abs(value - parabola - GRAVITY[axis] * time * STEP / 2))
            exact = max(exact, abs(value - parabola))
    speed = math.dist([VELOCITY[a] + GRAVITY[a] * duration for a in range(axes)], [0] * axes)
    mass = 1500 * 0.6**axes
    bound = max(abs(g) for g in GRAVITY[:axes]) * duration * STEP / 2
    verification.below(f"{dimension}: distance from the parabola as summed by steps [m]",
                       discrete, 1e-12)
    verification.below(f"{dimension}: distance from the exact parabola [m], bound g t dt / 2",
                       exact, bound * (1 + 1e-9))
    verification.relative(f"{dimension}: kinetic energy at the end [J]",
                          run.series["energy.kinetic"][-1], mass * speed**2 / 2, 1e-12)
    verification.below(f"{dimension}: strain energy over kinetic energy",
                       max(run.series["energy.strain"]) / (mass * speed**2 / 2), 1e-20)


verification = Verification("free-fall")
for dimension in AXES:
    check(verification, dimension)
verification.finish()
