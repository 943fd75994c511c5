# SPDX-License-Identifier: Apache-2.0
"""Soil that hits a column: the largest force among output samples is less than the largest force,
and the more so the rarer they are. Talus takes its peaks of every step."""
import numpy as np
from verification import FULL, Verification

CELL = 0.125 if FULL else 0.25
SPEED = 4.0


def scene(every):
    return {
        "title": f"soil against a column, a row every {every:g} s", "dimension": "plane_strain",
        "duration": 0.5, "grid": {"cell": CELL, "min": [0, 0], "max": [8, 4]},
        "solver": {"time_step": 2e-3 * CELL, "stabilise": {"viscous_damping": 0.2}},
        "materials": {"soil": {"model": "drucker_prager_cap", "density": 2000,
                               "bulk_modulus": 8.33e6, "shear_modulus": 3.85e6,
                               "friction_angle": 20, "cone_strength": 10}},
        "bodies": [{"material": "soil", "box": {"min": [1, 0], "max": [4, 2]},
                    "particles_per_cell": [2, 2], "velocity": [SPEED, 0],
                    "initial_stress": {"geostatic": {"k0": "auto"}}}],
        "gravity": [0, -10],
        "boundaries": [
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
             "condition": "friction", "friction_angle": 20},
            {"name": "column", "box": {"min": [5, 0], "max": [6, 3]}, "condition": "slip",
             "tension_release": True}],
        "output": {"history": {"every": every}, "frames": {"every": 1}},
    }


def largest_sample(run):
    instants = zip(run.series["reaction.column.x_min.instant.x"],
                   run.series["reaction.column.x_min.instant.y"])
    return max(np.hypot(x, y) for x, y in instants)


verification = Verification("missed-peak")
step = 2e-3 * CELL
every = verification.run(scene(step))
peak = every.metrics["reaction.column.x_min.peak"]
verification.relative("a row every step: largest sample [N]", largest_sample(every), peak, 1e-12)
missed = []
for count in (10, 100):
    run = verification.run(scene(count * step))
    missed.append(1 - largest_sample(run) / peak)
    verification.relative(f"a row every {count} steps: Talus' peak [N]",
                          run.metrics["reaction.column.x_min.peak"], peak, 1e-12)
verification.above("a row every 10 steps: share of the peak that samples miss", missed[0], 0.0)
verification.above("a row every 100 steps: share of the peak that samples miss", missed[1],
                   missed[0])
verification.finish()
