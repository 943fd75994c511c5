# SPDX-License-Identifier: Apache-2.0
"""A bar under uniform stress that moves through the cells: hat functions make noise wherever a
particle changes its cell, smoother functions and domains do not."""
import math

import numpy as np
from verification import FULL, Verification

DENSITY, YOUNG, STRESS, SPEED = 1000.0, 1e6, -1e3, 1.0
# With a whole number of particles a cell all of them change cells at once, and what one node gains
# its neighbour gains too: no force. 2.3 a cell is what any other lattice does.
PARTICLES_PER_CELL = 2.3
WAVE_SPEED = math.sqrt(YOUNG / DENSITY)
# What the free ends send has come 0.3 m far: it has not reached the middle fifth, 0.4 m away.
DURATION = 0.3 / WAVE_SPEED
SHAPES = ("linear", "gimp", "gimp_scaled", "cpdi", "bspline2", "bspline3")


def scene(shape, cells):
    cell = 1.0 / cells
    return {
        "title": f"bar of {cells} cells, {shape}", "dimension": "line", "duration": DURATION,
        "grid": {"cell": cell, "min": [-4 * cell], "max": [1.2]},
        "solver": {"shape": shape, "strain": "small"},
        "materials": {"steel": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": 0}},
        "bodies": [{"material": "steel", "box": {"min": [0], "max": [1]},
                    "count": [round(PARTICLES_PER_CELL * cells)], "velocity": [SPEED],
                    "initial_stress": [STRESS, 0, 0, 0, 0, 0]}],
        "output": {"history": {"every": DURATION / 20},
                   "frames": {"every": DURATION / 20, "fields": ["stress"],
                              "precision": "double"}},
    }


def stress_error(run):
    """Largest RMS over the frames of what the stress in the middle fifth has changed, over itself."""
    errors = []
    for index in range(21):
        frame = run.frame(index)
        middle = np.abs(frame["position"][:, 0] - 0.5 - SPEED * frame["time"]) < 0.1
        errors.append(np.sqrt(np.mean((frame["stress"][middle, 0] / STRESS - 1) ** 2)))
    return max(errors)


verification = Verification("cell-crossing")
of_linear = []
for cells in ((50, 100, 200) if FULL else (50, 200)):
    error = {shape: stress_error(verification.run(scene(shape, cells))) for shape in SHAPES}
    # A node that loses one of its 2.3 particles a cell is left with a force of the order of the
    # stress itself, so that the stress goes wrong by a good part of itself.
    verification.above(f"linear, {cells} cells: error of the stress over the stress",
                       error["linear"], 0.1)
    of_linear.append(error["linear"])
    for shape in SHAPES[1:]:
        ratio = error[shape] / error["linear"]
        if shape == "bspline2":
            verification.deviation(f"{shape}, {cells} cells: error over that of linear", ratio, 0.1,
                                   0.2)
        else:
            verification.below(f"{shape}, {cells} cells: error over that of linear", ratio, 0.1)
verification.above("linear: finer cells, with more crossings in the same time, over the coarsest",
                   of_linear[-1] / of_linear[0], 1.0)
verification.finish()
