# SPDX-License-Identifier: Apache-2.0
"""A block that hits a wall: the recorded impulse is its change of momentum."""
from verification import Verification

VARIANTS = [  # title, dimension, release, wall, stress update
    ("bounces, one-sided wall", "plane_strain", True, "stop", "modified_last"),
    ("bounces, wall that keeps what runs into it", "plane_strain", True, "keep", "modified_last"),
    ("is caught, two-sided wall", "plane_strain", False, "stop", "modified_last"),
    ("bounces, three dimensions", "solid", True, "stop", "modified_last"),
    ("bounces, one dimension", "line", True, "stop", "modified_last"),
    ("bounces, stress last", "plane_strain", True, "stop", "last"),
]


def scene(title, dimension, release, wall, update):
    axes = {"line": 1, "plane_strain": 2, "solid": 3}[dimension]
    return {
        "title": f"block that {title}",
        "dimension": dimension,
        "duration": 0.25,
        "grid": {"cell": 0.1, "min": [0] + [-1] * (axes - 1), "max": [2] + [1] * (axes - 1)},
        "solver": {"stress_update": update, "courant": 0.1 if update == "last" else 0.4},
        "materials": {"rubber": {"model": "linear_elastic", "density": 1000,
                                 "young_modulus": 1e6, "poisson_ratio": 0.2}},
        "bodies": [{"material": "rubber",
                    "box": {"min": [0.15] + [-0.2] * (axes - 1),
                            "max": [0.95] + [0.2] * (axes - 1)},
                    "particles_per_cell": [2] * axes, "velocity": [-1] + [0] * (axes - 1)}],
        "boundaries": [{"name": "wall", "condition": "slip", "tension_release": release,
                        "wall": wall,
                        "plane": {"point": [0] * axes, "normal": [1] + [0] * (axes - 1)}}],
        "output": {"history": {"every": 0.003},
                   "frames": {"every": 1, "fields": ["velocity", "mass"], "precision": "double"}},
    }


def momentum(frame):
    return float((frame["mass"].reshape(-1) * frame["velocity"][:, 0]).sum())


verification = Verification("wall-impulse")
for case in VARIANTS:
    run = verification.run(scene(*case))
    before, after = momentum(run.frame(0)), momentum(run.frame(-1))
    # The reaction is what the material does to the wall.
    verification.relative(f"{case[0]}: change of momentum against impulse [N s]",
                          after - before, -run.impulse("wall", "x"), 1e-9)
    verification.below(f"{case[0]}: momentum error of the audit",
                       run.metrics["momentum_error"], 1e-9)
    if case[2] and case[4] == "modified_last":
        verification.between(f"{case[0]}: rebound over approach", -after / before, 0.5, 1.0)
verification.finish()
