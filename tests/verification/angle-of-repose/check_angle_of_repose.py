# SPDX-License-Identifier: Apache-2.0
"""Dry sand behind a wall that is drawn away slowly: the slope that stays is at the angle of repose."""
import math

import numpy as np
from verification import FULL, Verification

CELL = 0.025 if FULL else 0.05
WIDTH, HEIGHT, WAY, SPEED = 1.0, 0.5, 1.5, 0.25
DENSITY, GRAVITY = 2000.0, 9.81
# Each column of the surface is known within half a particle spacing, CELL / 4 = 0.0125 m: 2.4 degrees
# over the fitted height of 0.3 m, if only the two ends counted; a fit over eight columns or more is
# sqrt(8) times better.
FIT = 1.0  # degrees


def scene(model, angle):
    return {
        "title": f"heap of {model}, friction angle {angle:g}", "dimension": "plane_strain",
        "duration": WAY / SPEED + 0.5,
        "grid": {"cell": CELL, "min": [0, 0], "max": [WIDTH + WAY + 0.5, 1]},
        "solver": {"stabilise": {"viscous_damping": 0.2}},
        "materials": {"sand": {"model": model, "density": DENSITY, "young_modulus": 5e6,
                               "poisson_ratio": 0.3, "friction_angle": angle,
                               **({"cone_fit": "plane_strain"} if "prager" in model else {})}},
        "bodies": [{"material": "sand", "box": {"min": [0, 0], "max": [WIDTH, HEIGHT]},
                    "particles_per_cell": [2, 2], "initial_stress": {"geostatic": {"k0": "auto"}}}],
        "gravity": [0, -GRAVITY],
        "boundaries": [
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "stick"},
            {"name": "back", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip"},
            {"name": "front", "plane": {"point": [WIDTH, 0], "normal": [-1, 0]},
             "condition": "velocity", "velocity": [SPEED, 0], "components": ["x"]}],
        "output": {"history": {"every": 0.05},
                   "frames": {"every": 1, "fields": ["velocity"], "precision": "double"}},
    }


def surface(frame):
    place = frame["position"]
    columns = np.floor(place[:, 0] / CELL).astype(int)
    x = (np.arange(columns.max() + 1) + 0.5) * CELL
    return x, np.array([place[columns == k, 1].max(initial=0.0) for k in range(len(x))])


def check(verification, model, angle):
    """Degrees of the slope between a fifth and four fifths of its height."""
    run = verification.run(scene(model, angle))
    x, y = surface(run.frame(-1))
    inner = (y > 0.2 * y.max()) & (y < 0.8 * y.max())
    slope = math.degrees(math.atan(-np.polyfit(x[inner], y[inner], 1)[0]))
    lowest = math.degrees(math.atan(math.sin(math.radians(angle))))
    verification.between(f"{model}, friction angle {angle:g}: slope [deg]", slope, lowest - FIT, angle + FIT)
    drop = run.series["energy.potential"][0] - run.series["energy.potential"][-1]
    verification.below(f"{model}, friction angle {angle:g}: kinetic energy left, over what fell",
                       run.series["energy.kinetic"][-1] / drop, 0.01)
    verification.relative(f"{model}, friction angle {angle:g}: force on the floor at rest [N/m]",
                          run.mean("reaction.floor.force.y", run.time[-1] - 0.3),
                          -DENSITY * GRAVITY * WIDTH * HEIGHT, 0.01)
    return slope


verification = Verification("angle-of-repose")
for angle in (25.0, 35.0):
    slopes = [check(verification, model, angle) for model in ("mohr_coulomb", "drucker_prager")]
    verification.absolute(f"friction angle {angle:g}: Drucker-Prager, fitted to plane strain, against "
                          "Mohr-Coulomb [deg]", slopes[1], slopes[0], 2 * FIT)
verification.finish()
