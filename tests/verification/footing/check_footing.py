# SPDX-License-Identifier: Apache-2.0
"""A rigid strip footing, rough and smooth, is pushed into weightless Tresca soil: the load it carries is that of
Prandtl, (2 + pi) c a unit of area."""
import math

from verification import FULL, Verification

COHESION, SHEAR, POISSON, DENSITY = 1000.0, 1e6, 0.45, 1000.0  # G/c = 1000
HALF_WIDTH, WIDTH, DEPTH = 1.0, 5.0, 3.0
PRANDTL = 2 + math.pi
YOUNG = 2 * SHEAR * (1 + POISSON)
WAVE_SPEED = math.sqrt(YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)) / DENSITY)
SPEED = 4e-6 * WAVE_SPEED  # its wave carries rho c v = 0.045 c, 0.9 % of the load
SETTLEMENT = 0.009


def scene(cells, smooth, control):
    """`cells` under half the footing; its last node carries half a cell beyond them."""
    cell = HALF_WIDTH / (cells + 0.5)
    side, top = round(WIDTH / cell) * cell, round(DEPTH / cell) * cell
    return {
        "title": f"footing, {'smooth' if smooth else 'rough'}, {cells} cells, {control}",
        "dimension": "plane_strain", "duration": SETTLEMENT / SPEED,
        "grid": {"cell": cell, "min": [0, 0], "max": [side, top + 4 * cell]},
        "solver": {"anti_locking": {"control": control, "field": "volumetric"}},
        "materials": {"clay": {"model": "tresca", "density": DENSITY, "young_modulus": YOUNG,
                               "poisson_ratio": POISSON, "cohesion": COHESION}},
        "bodies": [{"material": "clay", "box": {"min": [0, 0], "max": [side, top]},
                    "particles_per_cell": [2, 2]}],
        "boundaries": [
            {"name": "footing", "condition": "velocity", "velocity": [0, -SPEED],
             "components": ["y"] if smooth else ["x", "y"],
             "face": {"min": [0, top], "max": [cells * cell, top], "normal": [0, -1]}},
            {"name": "axis", "condition": "slip", "plane": {"point": [0, 0], "normal": [1, 0]}},
            {"name": "side", "condition": "slip",
             "plane": {"point": [side, 0], "normal": [-1, 0]}},
            {"name": "base", "condition": "stick", "plane": {"point": [0, 0], "normal": [0, 1]}}],
        "probes": [{"name": "kinetic", "kind": "energy", "part": "kinetic"},
                   {"name": "external", "kind": "energy", "part": "external"}],
        "output": {"history": {"every": SETTLEMENT / SPEED / 100}},
    }


def mean_force(run, name, begin, end):
    """Over shares of the run, in units of c times half the width."""
    force = run.reaction(name, "y")[int(100 * begin) + 1:int(100 * end) + 1]
    return math.fsum(force) / len(force) / (COHESION * HALF_WIDTH)


def load(verification, cells, smooth, control="cell"):
    """Bearing capacity over c: the mean of the last tenth."""
    built = scene(cells, smooth, control)
    run = verification.run(built)
    label = built["title"]
    capacity = mean_force(run, "footing", 0.9, 1)
    verification.relative(f"{label}: load on the base",
                          -mean_force(run, "base", 0.9, 1), capacity, 0.01)
    verification.below(f"{label}: largest kinetic energy, of the work done so far",
                       max(k / e for k, e in zip(run.probe("kinetic")[10:],
                                                 run.probe("external")[10:])), 0.01)
    if control != "none":
        verification.relative(f"{label}: load at 80 % of the way, against the last tenth",
                              mean_force(run, "footing", 0.7, 0.8), capacity, 0.02)
    return capacity


def main():
    verification = Verification("footing")
    for smooth, sizes in ((False, [4, 8, 16] if FULL else [4, 8]), (True, [4, 8] if FULL else [4])):
        word = "smooth" if smooth else "rough"
        for cells in sizes:
            capacity = load(verification, cells, smooth)
            verification.relative(f"{word}, {cells} cells: bearing capacity over c", capacity,
                                  PRANDTL, 0.05)
    locked = load(verification, 4, False, "none") / PRANDTL
    verification.above("without anti-locking, 4 cells: capacity over Prandtl's", locked, 1.15)
    verification.finish()


if __name__ == "__main__":
    main()
