# SPDX-License-Identifier: Apache-2.0
"""A block sheared to F_12 = 20: domains of its particles become strings that reach over many cells.
They are shortened for the interpolation, counted, and warned of."""
import h5py
import numpy as np
from verification import Verification, log_tail, particle_bodies

CELL, DENSITY, LENGTH, HEIGHT, SHEAR = 0.1, 1000.0, 1.0, 0.4, 20.0
CAP = 2.0  # [cells] largest reach of a domain


def scene(shear):
    """Every particle keeps its velocity: what stress there is moves nothing in a second."""
    spacing = CELL / 2
    points = [(x, y) for x in np.arange(-LENGTH / 2 + spacing / 2, LENGTH / 2, spacing)
              for y in np.arange(-HEIGHT / 2 + spacing / 2, HEIGHT / 2, spacing)]
    return {
        "title": f"block sheared to {shear:g}", "dimension": "plane_strain", "duration": 1.0,
        "grid": {"cell": CELL, "min": [-5.5, -1], "max": [5.5, 1]},
        "solver": {"shape": "cpdi", "time_step": 0.002},
        "materials": {"jelly": {"model": "neo_hookean", "density": DENSITY, "young_modulus": 1.0,
                                "poisson_ratio": 0}},
        "bodies": particle_bodies(points, (spacing, spacing), "jelly",
                                  lambda centre: (shear * centre[1], 0)),
        "output": {"history": {"every": 0.01},
                   "frames": {"every": 0.05,
                              "fields": ["deformation_gradient", "stress", "velocity"],
                              "precision": "double", "grid_fields": ["mass"]}},
    }


def gradients(frame):
    return frame["deformation_gradient"].reshape(-1, 3, 3)[:, :2, :2]


def reach(frame):
    """Of every domain as the deformation has made it, in cells."""
    half = CELL / 4
    return (np.abs(gradients(frame)).sum(axis=2).max(axis=1) * half / CELL)


def aspect(frame):
    stretches = np.linalg.svd(gradients(frame), compute_uv=False)
    return stretches[:, 0] / stretches[:, 1]


def farthest_node(run, index):
    """Largest distance along an axis of a node with mass from the particle nearest to it, in cells;
    and the mass of all nodes."""
    path = sorted((run.folder / "frames").glob("grid_*.hdf"))[index]
    with h5py.File(path) as file:
        place, mass = file["VTKHDF/Points"][...][:, :2], file["VTKHDF/PointData/mass"][...]
    particles = run.frame(index)["position"][:, :2]
    away = np.abs(place[mass > 0][:, None] - particles[None]).max(axis=2).min(axis=1)
    return away.max() / CELL, mass.sum()


verification = Verification("string-like-domains")
run = verification.run(scene(SHEAR))
last = run.frame()
verification.above("largest F_12", np.abs(gradients(last)[:, 0, 1]).max(), 10.0)
verification.above("largest ratio of the stretches", aspect(last).max(), 10.0)
verification.above("largest reach of a domain by its deformation, in cells", reach(last).max(), CAP)
verification.above("domains shortened, over all steps", run.metrics["domains.capped"], 0)
verification.equal("the run warns of it", "domain" in log_tail(run.folder), True)
distance, mass = zip(*(farthest_node(run, index) for index in range(21)))
# A corner within the cap, and the far node of the cell in which it lies.
verification.below("farthest node that a particle reaches, in cells", max(distance), CAP + 1)
verification.relative("mass of all nodes at the end", mass[-1], DENSITY * LENGTH * HEIGHT, 1e-12)
verification.equal("all fields are finite", all(
    np.isfinite(last[name]).all() for name in ("position", "velocity", "stress")), True)
moderate = verification.run(scene(1.0))
verification.equal("sheared to 1: domains shortened", moderate.metrics["domains.capped"], 0)
verification.finish()
