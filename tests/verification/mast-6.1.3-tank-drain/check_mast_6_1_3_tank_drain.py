# SPDX-License-Identifier: Apache-2.0
"""A tank that drains through a hole in its floor (Mast 2013, sec. 6.1.3): static forces, the triangular
force on the wall while it drains, and where the mass goes."""
import math

import h5py
import numpy as np
from verification import FULL, Verification

WIDTH, HEIGHT, HOLE = 4.0, 4.0, 0.5  # half of the tank; the axis is at x = 0
DENSITY, GRAVITY, CELL = 997.5, 9.81, 0.25
STATIC = DENSITY * GRAVITY * HEIGHT**2 / 2  # 78 284 N/m
TOTAL = DENSITY * WIDTH * HEIGHT
# The wall in bands of nodes, whose mean forces the history knows.
BANDS = {"wall_0": (0, 0.75), "wall_1": (1, 1.75), "wall_2": (2, 2.75), "wall_3": (3, 5),
         "spout": (-2.5, -CELL)}


def scene(control, duration, drain=True, every=0.002, frames=0.01):
    return {
        "title": f"tank, anti-locking {control}{'' if drain else ', closed'}",
        "dimension": "plane_strain", "duration": duration,
        "grid": {"cell": CELL, "min": [0, -2.5], "max": [WIDTH, 5]},
        # Reduced: water at a hundredth of its stiffness, whose sound is still 16 times faster than
        # what flows out. Locking is a matter of stiffness, so that the run that shows it keeps it.
        "solver": {"time_step": 1e-5 if FULL else "auto", "anti_locking": {"control": control},
                   "stabilise": {"viscous_damping": 0.5}},
        "materials": {"water": {"model": "newtonian_fluid", "density": DENSITY, "viscosity": 0.001,
                                "bulk_modulus": 2e9 if FULL or control == "none" else 2e7}},
        "bodies": [{"material": "water", "box": {"min": [0, 0], "max": [WIDTH, HEIGHT]},
                    "count": [80, 80] if FULL else [48, 48], "initial_stress": "hydrostatic"}],
        "gravity": [0, -GRAVITY],
        "boundaries": [
            {"name": "axis", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip"},
            *({"name": name, "condition": "slip",
               "face": {"min": [WIDTH, low], "max": [WIDTH, high], "normal": [-1, 0]}}
              for name, (low, high) in BANDS.items()),
            {"name": "floor", "condition": "slip",
             "face": {"min": [HOLE if drain else 0, 0], "max": [WIDTH, 0], "normal": [0, 1]}},
            {"name": "outlet", "plane": {"point": [0, -2], "normal": [0, 1]},
             "condition": "eliminate"}],
        "probes": [{"name": "left", "kind": "mass"},
                   {"name": "level", "kind": "height", "measure": "centre_of_mass",
                    "within": {"min": [3.0, 0], "max": [None, None]}}],
        "output": {"history": {"every": every},
                   "frames": {"every": frames, "fields": ["velocity", "mass"],
                              "grid_fields": ["reaction"], "precision": "double"}},
    }


def wall_force(run):
    return np.sum([run.reaction(name, "x") for name in BANDS], axis=0)


def mean_force(run, name, begin, end=math.inf):
    return run.mean(f"reaction.{name}.force.x", begin, end)


def first_wall_nodes(run):
    """Heights of the nodes of the wall, and the forces on them in the first step."""
    with h5py.File(sorted((run.folder / "frames").glob("grid_*.hdf"))[1]) as file:
        place, force = file["VTKHDF/Points"][...], file["VTKHDF/PointData/reaction"][...]
    inner = (np.abs(place[:, 0] - WIDTH) < 1e-9) & (place[:, 1] > 0) & (place[:, 1] < HEIGHT)
    return place[inner, 1], force[inner, 0]


def check_start(verification):
    run = verification.run(scene("cell", 2e-3, drain=False, every=1e-7, frames=1e-7))
    verification.relative("force on the wall in the first step [N/m]", wall_force(run)[1], STATIC,
                          0.005)
    verification.relative("force on the floor in the first step [N/m]", run.reaction("floor", "y")[1],
                          -TOTAL * GRAVITY, 0.005)
    height, force = first_wall_nodes(run)
    triangle = DENSITY * GRAVITY * (HEIGHT - height) * CELL
    verification.below("forces on the nodes of the wall against rho g d h: largest relative error",
                       np.abs(force / triangle - 1).max(), 0.005)


def check_hold(verification):
    run = verification.run(scene("cell", 0.1, drain=False))
    force = wall_force(run)[1:]
    verification.below("closed for 0.1 s: largest change of the force on the wall",
                       max(abs(value / STATIC - 1) for value in force), 0.01)


def thrust(run, begin, end):
    """Mean force on the wall over that of water at rest at the level beside it."""
    at_rest = [DENSITY * GRAVITY * run.probe("level")[k]**2 / 2
               for k, t in enumerate(run.time) if begin <= t <= end]
    return sum(mean_force(run, name, begin, end) for name in BANDS) / np.mean(at_rest)


def check_drain(verification, control):
    """Opening the hole sets off waves that take 4 x 4 m / c = 0.11 s (K = 20 MPa) to come back;
    forces are means over 0.2 s."""
    run = verification.run(scene(control, 1.0))
    for begin in (0.2, 0.4, 0.6, 0.8):
        verification.relative(f"{control}: force on the wall, t = {begin:g} to {begin + 0.2:g} s, over "
                              "rho g H^2 / 2", thrust(run, begin, begin + 0.2), 1.0, 0.15)
    level = run.mean("probe.level", 0.4)
    for name, (low, high) in list(BANDS.items())[:3]:
        lines = np.arange(low, high + CELL / 2, CELL)
        areas = CELL * np.where(lines == 0, 0.5, 1)
        at_rest = DENSITY * GRAVITY * ((level - np.maximum(lines, CELL / 4)) * areas).sum()
        verification.relative(f"{control}: force on the wall from {low:g} to {high:g} m, t > 0.4 s, over "
                              "a triangle's", mean_force(run, name, 0.4) / at_rest, 1.0, 0.15)
    fastest = 0.0
    for k in range(len(list((run.folder / "frames").glob("frame_*.hdf")))):
        frame = run.frame(k)
        place, speed = frame["position"], frame["velocity"][:, 1]
        hole = (np.abs(place[:, 1]) < CELL / 2) & (place[:, 0] < HOLE)
        fastest = max(fastest, -speed[hole].min(initial=0.0))
    verification.below(f"{control}: largest exit speed, over sqrt(2 g H)",
                       fastest / math.sqrt(2 * GRAVITY * HEIGHT), 1.0)
    verification.relative(f"{control}: mass left and drained [kg/m]",
                          run.probe("left")[-1] + run.metrics["eliminated_mass"], TOTAL, 1e-12)
    return run


def check_locking(verification, run):
    locked = verification.run(scene("none", 1.0, frames=1))
    verification.below("without anti-locking: mass drained, over that with it",
                       locked.metrics["eliminated_mass"] / run.metrics["eliminated_mass"], 0.8)

    def unrest(one):
        return np.std([thrust(one, 0.4 + 0.05 * k, 0.45 + 0.05 * k) for k in range(12)])
    verification.note("without anti-locking: unrest of the force on the wall, over that with it",
                      unrest(locked) / unrest(run), "stiff water rings with both")


verification = Verification("mast-6.1.3-tank-drain")
check_start(verification)
check_hold(verification)
drained = check_drain(verification, "cell")
check_drain(verification, "hybrid")
check_locking(verification, drained)
verification.finish()
