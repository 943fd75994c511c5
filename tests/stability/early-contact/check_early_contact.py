# SPDX-License-Identifier: Apache-2.0
"""Two discs meet where their functions do, cells before their surfaces, and never touch. This is
reported, not cured: with cells half as wide the gap is half as wide."""
import numpy as np
from verification import FULL, Verification

RADIUS, GAP, SPEED, DENSITY = 0.2, 0.25, 0.1, 1000.0
# Cells from a particle's surface over which its functions reach at most: two discs share a node from
# twice that.
SHAPES = {"linear": 1.0, "cpdi": 1.0, "bspline2": 1.5}


def scene(shape, cell):
    duration = 1.6 * GAP / (2 * SPEED)
    return {
        "title": f"discs, {shape}, cells of {cell}", "dimension": "plane_strain",
        "duration": duration, "grid": {"cell": cell, "min": [-1, -0.5], "max": [1, 0.5]},
        "solver": {"shape": shape},
        "materials": {"rubber": {"model": "linear_elastic", "density": DENSITY,
                                 "young_modulus": 1e6, "poisson_ratio": 0.3}},
        "bodies": [{"name": name, "material": "rubber",
                    "sphere": {"centre": [side * (RADIUS + GAP / 2), 0], "radius": RADIUS},
                    "particles_per_cell": [2, 2], "velocity": [-side * SPEED, 0]}
                   for name, side in (("left", -1), ("right", 1))],
        "probes": [{"name": name, "kind": "centre_of_mass", "body": name}
                   for name in ("left", "right")],
        # The meeting itself gains some per cent of the energy that there is.
        "audits": {"energy_growth": 0.1},
        "output": {"history": {"every": duration / 400}, "frames": {"every": 0}},
    }


def gaps(run):
    """Between the surfaces of round discs when their approach has slowed by 5 %, and the smallest; the
    deformation of the discs is below 1/100 of that (10 Pa on 1 MPa)."""
    time = np.array(run.time)
    gap = np.array(run.probe("right.x")) - np.array(run.probe("left.x")) - 2 * RADIUS
    approach = -np.diff(gap) / np.diff(time)
    return gap[1 + np.argmax(approach < 0.95 * 2 * SPEED)], gap.min()


verification = Verification("early-contact")
for shape, support in SHAPES.items():
    found = []
    for cell in ((0.1, 0.05, 0.025) if FULL else (0.1, 0.05)):
        first, least = gaps(verification.run(scene(shape, cell)))
        found.append(first)
        verification.between(f"{shape}, cells of {cell}: gap at contact, in cells", first / cell, 1.0,
                             2 * support)
        verification.above(f"{shape}, cells of {cell}: smallest gap, in cells", least / cell, 1.0)
    for coarse, fine in zip(found, found[1:]):
        verification.between(f"{shape}: gap with cells half as wide, over the wider", fine / coarse,
                             0.4, 0.6)
verification.finish()
