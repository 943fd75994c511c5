# SPDX-License-Identifier: Apache-2.0
"""Water as stiff as water in a tank, without viscosity or damping: what begins to ring goes on."""
import numpy as np
from verification import FULL, Verification

SIZE, CELL, DENSITY, GRAVITY, BULK = 4.0, 0.25, 1000.0, 9.81, 2.2e9
WEIGHT = DENSITY * GRAVITY * SIZE ** 2
BOTTOM_PRESSURE = DENSITY * GRAVITY * SIZE


def scene(title, count, damping, initial_stress, duration, shape="linear"):
    return {
        "title": f"{title}, {shape}, C = {damping}", "dimension": "plane_strain",
        "duration": duration,
        "grid": {"cell": CELL, "min": [-CELL, -CELL], "max": [SIZE + CELL, SIZE + 4 * CELL]},
        "solver": {"shape": shape, "stabilise": {"viscous_damping": damping}},
        "materials": {"water": {"model": "newtonian_fluid", "density": DENSITY,
                                "bulk_modulus": BULK}},
        "bodies": [{"material": "water", "box": {"min": [0, 0], "max": [SIZE, SIZE]},
                    "count": [count, count], "initial_stress": initial_stress}],
        "gravity": [0, -GRAVITY],
        "boundaries": [
            {"name": "floor", "condition": "slip", "plane": {"point": [0, 0], "normal": [0, 1]}},
            {"name": "left", "condition": "slip", "plane": {"point": [0, 0], "normal": [1, 0]}},
            {"name": "right", "condition": "slip",
             "plane": {"point": [SIZE, 0], "normal": [-1, 0]}}],
        "output": {"history": {"every": duration / 2000},
                   "frames": {"every": duration / 20, "fields": ["mean_stress"],
                              "precision": "double"}},
    }


def amplitude(run, begin, end):
    """Half of the range of the force on the floor in a part of the run, over the weight."""
    chosen = [force for time, force in zip(run.time, run.reaction("floor", "y"))
              if begin * run.time[-1] < time <= end * run.time[-1]]
    return (max(chosen) - min(chosen)) / 2 / WEIGHT


def noise(run):
    """Largest error of a particle's pressure in the second half of the run, over that at the floor."""
    errors = []
    for index in range(10, 21):
        frame = run.frame(index)
        hydrostatic = DENSITY * GRAVITY * (SIZE - frame["position"][:, 1])
        errors.append(np.abs(-frame["mean_stress"] - hydrostatic).max())
    return max(errors) / BOTTOM_PRESSURE


verification = Verification("stiff-fluid")
# Gravity that begins at once makes the wave of the first mode with the amplitude of the weight. It goes
# up and down 93 times in a second.
DURATION = 1.0 if FULL else 0.5
free = verification.run(scene("sudden gravity", 32, 0, "none", DURATION))
verification.above("C = 0: amplitude of the wave in the last tenth", amplitude(free, 0.9, 1), 0.5)
verification.above("C = 0: largest error of a pressure in the second half", noise(free), 0.5)
damped = verification.run(scene("sudden gravity", 32, 0.5, "none", DURATION))
verification.below("C = 0.5: amplitude of the wave in the last tenth", amplitude(damped, 0.9, 1),
                   0.01)
# Particles lie a quarter of a cell, 1/64 of the depth, above and below the middle of their cell, whose
# pressure both have at rest.
verification.below("C = 0.5: largest error of a pressure in the second half", noise(damped), 0.05)

# At rest from the beginning, but with 37 particles for 16 cells.
DURATION = 1.0 if FULL else 0.2
noises = {}
for shape, damping in (("linear", 0), ("linear", 0.5), ("bspline2", 0.5)):
    run = verification.run(scene("uneven lattice", 37, damping, "hydrostatic", DURATION, shape))
    noises[shape, damping] = noise(run)
verification.above("uneven lattice, C = 0: largest error of a pressure", noises["linear", 0], 1.0)
verification.deviation("uneven lattice, C = 0.5: largest error of a pressure",
                       noises["linear", 0.5], 1.0, 2.0)
verification.below("uneven lattice, C = 0.5, bspline2: largest error of a pressure",
                   noises["bspline2", 0.5], 0.5)
verification.finish()
