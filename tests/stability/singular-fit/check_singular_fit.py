# SPDX-License-Identifier: Apache-2.0
"""Three particles on a line in a cell, four on a plane in 3D: the second moments over which the slopes of
the full field of anti-locking are found are singular. Talus fits the volumetric strain there alone, and
counts it."""
import numpy as np

from verification import Verification, particle_bodies

# Binary fractions, so that moments and determinants have no rounding.
CELL, SIZE, LOW, HIGH = 1 / 8, 1 / 64, 5 / 32, 7 / 32
PLACES = {
    "plane_strain": {"on a line": [(LOW, LOW), (3 / 16, 3 / 16), (HIGH, HIGH)],
                     "apart": [(LOW, LOW), (HIGH, 3 / 16), (3 / 16, HIGH)]},
    "solid": {"on a plane": [(x, y, x) for x in (LOW, HIGH) for y in (LOW, HIGH)],
              "apart": [(LOW, LOW, LOW), (HIGH, LOW, LOW), (LOW, HIGH, LOW), (LOW, LOW, HIGH)]},
}


def moments(places):
    away = np.array(places) - np.mean(places, axis=0)
    return away.T @ away, away


def slopes_by_determinants(places, values):
    """Least squares as Cramer's rule writes them."""
    matrix, away = moments(places)
    cofactors = np.array([[(-1) ** (i + j) * np.linalg.det(np.delete(np.delete(matrix, i, 0), j, 1))
                           for i in range(len(matrix))] for j in range(len(matrix))])
    determinant = matrix[0] @ cofactors[:, 0]
    with np.errstate(all="ignore"):
        return cofactors @ (away.T @ values) / determinant


def scene(dimension, name, places):
    axes = len(places[0])
    random = np.random.default_rng(3)
    return {
        "title": f"{dimension}, particles {name}", "dimension": dimension, "duration": 0.02,
        "grid": {"cell": CELL, "min": [-0.25] * axes, "max": [0.75] * axes},
        "solver": {"shape": "linear", "courant": 0.1, "anti_locking": {"control": "cell", "field": "full"}},
        "materials": {"rubber": {"model": "linear_elastic", "density": 1000, "young_modulus": 1e6,
                                 "poisson_ratio": 0.3}},
        "bodies": particle_bodies(places, [SIZE] * axes, "rubber",
                                  lambda centre: random.uniform(-1e-3, 1e-3, axes).tolist()),
        "output": {"history": {"every": 0.02},
                   "frames": {"every": 0.02, "fields": ["stress"], "precision": "double"}},
    }


verification = Verification("singular-fit")
for dimension, arrangements in PLACES.items():
    for name, places in arrangements.items():
        label = f"{dimension}, {name}"
        condition = np.linalg.cond(moments(places)[0])
        slopes = slopes_by_determinants(places, np.arange(len(places)) ** 2 + 1.0)
        run = verification.run(scene(dimension, name, places))
        fallbacks, steps = run.metrics["anti_locking.fallbacks"], run.metrics["steps"]
        if name == "apart":
            verification.below(f"{label}: condition number of the moments", condition, 100)
            verification.equal(f"{label}: fall-backs counted", fallbacks, 0)
        else:
            verification.above(f"{label}: condition number of the moments", condition, 1e12)
            verification.equal(f"{label}: slopes by determinants are finite",
                               bool(np.isfinite(slopes).all()), False)
            verification.equal(f"{label}: fall-backs counted, for one a step", fallbacks, steps)
        stress = run.frame()["stress"]
        verification.equal(f"{label}: stresses are finite and not all zero",
                           bool(np.isfinite(stress).all() and (stress != 0).any()), True)
verification.finish()
