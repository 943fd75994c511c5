# SPDX-License-Identifier: Apache-2.0
"""A bar under uniform stress that moves through the cells: hat functions make noise wherever a
particle changes its cell, smoother functions and domains do not."""
import math

import numpy as np
from verification import FULL, Verification, particle_bodies

DENSITY, YOUNG, STRESS, SPEED = 1000.0, 1e6, -1e3, 1.0
# With a whole number of particles a cell all of them change cells at once, and what one node gains
# its neighbour gains too: no force. 2.3 a cell is what any other lattice does.
PARTICLES_PER_CELL = 2.3
WAVE_SPEED = math.sqrt(YOUNG / DENSITY)
# What the free ends send has come 0.3 m far: it has not reached the middle fifth, 0.4 m away.
DURATION = 0.3 / WAVE_SPEED
SHAPES = ("linear", "gimp", "gimp_scaled", "cpdi", "bspline2", "bspline3")


def scene(shape, cells, per_cell=PARTICLES_PER_CELL):
    cell = 1.0 / cells
    return {
        "title": f"bar of {cells} cells, {shape}", "dimension": "line", "duration": DURATION,
        "grid": {"cell": cell, "min": [-4 * cell], "max": [1.2]},
        "solver": {"shape": shape, "strain": "small"},
        "materials": {"steel": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": 0}},
        "bodies": [{"material": "steel", "box": {"min": [0], "max": [1]},
                    "count": [round(per_cell * cells)], "velocity": [SPEED],
                    "initial_stress": [STRESS, 0, 0, 0, 0, 0]}],
        "output": {"history": {"every": DURATION / 20},
                   "frames": {"every": DURATION / 20, "fields": ["stress"],
                              "precision": "double"}},
    }


CROSSING = 0.15 / 50 / SPEED  # [s] until the particle ahead of its place crosses a node


def one_goes_before():
    """Two particles a cell, whose forces cancel; one, in the middle, is ahead of its place by a tenth of a
    cell."""
    described = scene("linear", 50)
    half = 0.5 / 50
    centres = [[(k + 0.5) * half + (0.2 * half if k == 51 else 0)] for k in range(100)]
    described["bodies"] = particle_bodies(centres, [half], "steel", lambda centre: [SPEED])
    for body in described["bodies"]:
        body["initial_stress"] = [STRESS, 0, 0, 0, 0, 0]
    described["duration"] = CROSSING + 2e-3  # the others cross after 5 ms
    described["output"]["frames"]["every"] = 2e-4
    return described


def stress_errors(run):
    """RMS of what the stress in the middle fifth has changed, over itself, frame by frame."""
    errors = []
    for index in range(len(list((run.folder / "frames").glob("frame_*.hdf")))):
        frame = run.frame(index)
        middle = np.abs(frame["position"][:, 0] - 0.5 - SPEED * frame["time"]) < 0.1
        errors.append(np.sqrt(np.mean((frame["stress"][middle, 0] / STRESS - 1) ** 2)))
    return errors


def stress_error(run):
    return max(stress_errors(run))


verification = Verification("cell-crossing")
lone = verification.run(one_goes_before())
errors = stress_errors(lone)
before = [error for k, error in enumerate(errors) if lone.frame(k)["time"] < 0.99 * CROSSING]
verification.below("linear, 2 a cell: error before the first particle crosses a node", max(before), 1e-9)
# A node has half of STRESS too much, the next too little: with the mass of a cell it moves by a t^2 / 2,
# which strains the cells beside it by STRESS / 4 / E (c t / h)^2: the size of the error after c t = h.
verification.above("linear, 2 a cell: error 0.4 ms later (c t = 0.6 h)",
                   errors[len(before) + 2], 0.01)
together = stress_error(verification.run(scene("linear", 50, per_cell=2)))
verification.note("linear, 2 particles a cell: error", together, "all cross at once, and forces cancel")
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
