# SPDX-License-Identifier: Apache-2.0
"""Two elastic blocks meet head-on with flat faces. Where there is one velocity at a node they are one
block from then on: nothing parts them when the waves come back. This is reported, not cured; against
a wall that lets go, a block does leave."""
import math

from verification import FULL, Verification

DENSITY, YOUNG, LENGTH, SPEED = 1000.0, 1e6, 1.0, 1.0
WAVE_SPEED = math.sqrt(YOUNG / DENSITY)
CONTACT = 2 * LENGTH / WAVE_SPEED  # [s] until the waves are back from the far ends
WELDED_PERIOD = 2 * CONTACT  # [s] of the bar that both make, free at its ends
SHAPES = ("linear", "gimp", "cpdi", "bspline2") if FULL else ("linear", "cpdi")


def scene(title, bodies, boundaries, cells, shape):
    duration = CONTACT + 2 * WELDED_PERIOD
    return {
        "title": f"{title}, {cells} cells, {shape}", "dimension": "line", "duration": duration,
        "grid": {"cell": LENGTH / cells, "min": [-1.5 * LENGTH], "max": [9 * LENGTH]},
        "solver": {"shape": shape},
        "materials": {"steel": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": 0}},
        "bodies": [{"name": name, "material": "steel", "box": {"min": [begin], "max": [begin + LENGTH]},
                    "particles_per_cell": [2], "velocity": [velocity]}
                   for name, begin, velocity in bodies],
        "boundaries": boundaries,
        "probes": [{"name": name, "kind": "centre_of_mass", "body": name} for name, _, _ in bodies],
        # The meeting itself gains a few per cent of the energy that there is.
        "audits": {"energy_growth": 0.1},
        "output": {"history": {"every": duration / 500}, "frames": {"every": 0}},
    }


def mean_speed(run, name, begin, end):
    """Of the centre of a body between two times."""
    series = "probe." + name
    return (run.value_at(series, end) - run.value_at(series, begin)) / (end - begin)


verification = Verification("sticking-blocks")
for shape in SHAPES:
    for cells in (20, 40):
        pair = verification.run(scene("pair", [("left", -LENGTH, SPEED), ("right", 0.0, -SPEED)], [],
                                      cells, shape))
        # Over one and two periods of the bar, so that its vibration does not count. Apart, the blocks
        # would leave each other as fast as they came, at 2 m/s.
        for periods in (1, 2):
            end = CONTACT + periods * WELDED_PERIOD
            parting = (mean_speed(pair, "right", CONTACT, end)
                       - mean_speed(pair, "left", CONTACT, end))
            verification.below(f"{shape}, {cells} cells: relative velocity after {periods} periods over "
                               "that of the approach", abs(parting) / (2 * SPEED), 0.1)
loss = {}
for cells in (20, 40):
    mirror = {"name": "mirror", "plane": {"point": [0], "normal": [1]}, "condition": "slip",
              "tension_release": True}
    alone = verification.run(scene("wall that lets go", [("right", 0.0, -SPEED)], [mirror], cells,
                                   "linear"))
    rebound = mean_speed(alone, "right", CONTACT + WELDED_PERIOD / 2, alone.time[-1])
    # Four fifths of the energy at least.
    verification.above(f"wall that lets go, {cells} cells: velocity of the rebound", rebound,
                       math.sqrt(0.8))
    loss[cells] = 1 - rebound / SPEED
# What stands still at the wall is the share of a node, of the size of a cell.
verification.between("wall that lets go: loss with cells half as wide, over the wider",
                     loss[40] / loss[20], 0.35, 0.65)
verification.finish()
