# SPDX-License-Identifier: Apache-2.0
"""A column in a corner of two smooth walls, pressed into both: with one averaged normal at the corner
node it slips into the floor, with Talus' rule it does not."""
import h5py
import numpy as np
from small_mpm import SmallMpm
from verification import FULL, Verification

CELL, DENSITY, YOUNG, POISSON = 0.1, 1000.0, 1e5, 0.2
GRAVITY = (-3.0, -10.0)
STEP, DURATION = 5e-4, (0.4 if FULL else 0.15)
CORNER, TOP = (0.2, 0.2), (0.6, 1.0)  # two cells of room behind the walls, to slip into


def no_motion_along(normal):
    def constrain(velocity):
        return velocity - (velocity @ normal)[:, None] * normal

    def rule(velocity, force, mass, step):
        free = velocity + step * force / np.maximum(mass, 1e-300)[:, None]
        after = constrain(free)
        return after, (mass[:, None] * (after - free)).sum(axis=0)
    return rule, constrain


def way_of_the_corner(average):
    """How far the node of the corner moves material into the floor, in cells. With `average` that node
    is held along (1, 1) / sqrt(2) only; else along both normals, which small_mpm can do just as well:
    the difference is the rule and nothing else."""
    mpm = SmallMpm(CELL, 12, 12, DENSITY, YOUNG, POISSON, GRAVITY)
    mpm.fill(CORNER, TOP, 2)
    line = round(CORNER[0] / CELL)
    floor = [mpm.node(column, line) for column in range(line + 1, 13)]
    wall = [mpm.node(line, row) for row in range(line + 1, 13)]
    x, y, both = np.array([1.0, 0]), np.array([0, 1.0]), np.array([1, 1]) / np.sqrt(2)
    rule, constrain = no_motion_along(both) if average else (
        lambda velocity, force, mass, step: (np.zeros_like(velocity), np.zeros(2)), np.zeros_like)
    way = [0.0]

    def watched(velocity, force, mass, step):
        after, impulse = rule(velocity, force, mass, step)
        way.append(way[-1] - step * after[0, 1])
        return after, impulse
    mpm.rules = [(np.array(floor), *no_motion_along(y)), (np.array(wall), *no_motion_along(x)),
                 (np.array([mpm.node(line, line)]), watched, constrain)]
    for _ in range(round(DURATION / STEP)):
        mpm.step(STEP)
    return max(way) / CELL


def talus_scene():
    return {
        "title": "column in a corner", "dimension": "plane_strain", "duration": DURATION,
        "grid": {"cell": CELL, "min": [0, 0], "max": [1.2, 1.2]},
        "solver": {"time_step": STEP, "strain": "small"},
        "materials": {"stone": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": POISSON}},
        "bodies": [{"material": "stone", "box": {"min": CORNER, "max": TOP},
                    "particles_per_cell": [2, 2]}],
        "gravity": GRAVITY,
        # As faces, so that behind them there is the same room.
        "boundaries": [
            {"name": "floor", "condition": "slip",
             "face": {"min": [CORNER[0], CORNER[1]], "max": [1.2, CORNER[1]], "normal": [0, 1]}},
            {"name": "wall", "condition": "slip",
             "face": {"min": [CORNER[0], CORNER[1]], "max": [CORNER[0], 1.2], "normal": [1, 0]}}],
        "output": {"history": {"every": DURATION / 50},
                   "frames": {"every": DURATION / 50, "grid_fields": ["velocity"],
                              "precision": "double"}},
    }


def fastest_at_the_corner(run):
    speeds = []
    for path in sorted((run.folder / "frames").glob("grid_*.hdf"))[1:]:
        with h5py.File(path) as file:
            place, velocity = file["VTKHDF/Points"][...], file["VTKHDF/PointData/velocity"][...]
        corner = np.abs(place[:, :2] - np.array(CORNER)).max(axis=1) < 1e-9
        speeds.append(np.abs(velocity[corner]).max())
    return max(speeds)


verification = Verification("corner-walls")
verification.above("averaged normal: way of the corner into the floor, in cells",
                   way_of_the_corner(True), 0.05)
verification.equal("both normals, in the same small program, in cells", way_of_the_corner(False), 0.0)
run = verification.run(talus_scene())
verification.equal("Talus: largest speed of the node of the corner [m/s]", fastest_at_the_corner(run),
                   0.0)
verification.finish()
