# SPDX-License-Identifier: Apache-2.0
"""The dam that breaks onto a vertical wall (Mast 2013, sec. 6.1.2), as a scene."""
from verification import FULL

LENGTH, HEIGHT, TANK, TOP = 4.0, 2.0, 6.0, 12.0
DENSITY, GRAVITY, CELL = 997.5, 9.81, 0.25


def scene(control, duration=2.0, every=0.002, settle=0.0, stiff=FULL):
    return {
        "title": f"dam break onto a barrier, anti-locking {control}", "dimension": "plane_strain",
        "duration": duration, "grid": {"cell": CELL, "min": [0, 0], "max": [TANK, TOP]},
        # Reduced: water at a hundredth of its stiffness, whose sound is still 16 times faster than
        # the flow. Locking is a matter of stiffness, so that the run that shows it keeps it.
        "solver": {"time_step": 1e-5 if FULL and settle == 0 else "auto",
                   "anti_locking": {"control": control},
                   "stabilise": {"viscous_damping": 0.5,
                                 "settle": {"time": settle, "damping": 4 if settle else 0}}},
        "materials": {"water": {"model": "newtonian_fluid", "density": DENSITY,
                                "bulk_modulus": 2e9 if stiff else 2e7, "viscosity": 0.001}},
        "bodies": [{"material": "water", "box": {"min": [0, 0], "max": [LENGTH, HEIGHT]},
                    "count": [80, 40] if FULL else [48, 24], "initial_stress": "hydrostatic"}],
        "gravity": [0, -GRAVITY],
        "boundaries": [
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "slip"},
            {"name": "lower", "condition": "slip",
             "face": {"min": [0, 0], "max": [0, HEIGHT / 2], "normal": [1, 0]}},
            {"name": "upper", "condition": "slip",
             "face": {"min": [0, HEIGHT / 2 + CELL], "max": [0, TOP], "normal": [1, 0]}},
            {"name": "barrier", "plane": {"point": [TANK, 0], "normal": [-1, 0]},
             "condition": "slip"}],
        "probes": [{"name": "front", "kind": "front", "along": [1, 0]},
                   {"name": "level", "kind": "height", "measure": "centre_of_mass",
                    "within": {"min": [4.0, None], "max": [None, None]}},
                   {"name": "depth", "kind": "height", "measure": "centre_of_mass",
                    "within": {"min": [None, None], "max": [4.0, None]}}],
        "output": {"history": {"every": every},
                   "frames": {"every": 0.02, "fields": ["velocity", "mean_stress", "mass"],
                              "precision": "double"}},
    }
