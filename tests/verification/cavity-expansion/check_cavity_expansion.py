# SPDX-License-Identifier: Apache-2.0
"""A long cylindrical cavity in Tresca soil is widened: pressure against radius, in closed form, and
the limit pressure c (1 + ln(G/c)) that it tends to."""
import math

from verification import FULL, Verification

COHESION, SHEAR, POISSON, DENSITY = 1000.0, 50e3, 0.49, 1000.0  # G/c = 50
INNER, OUTER, GROWTH = 1.0, 20.0, 0.5
YOUNG = 2 * SHEAR * (1 + POISSON)
WAVE_SPEED = math.sqrt(YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)) / DENSITY)
SPEED = 1e-4 * WAVE_SPEED  # at which the cavity is meant to grow
LIMIT = 1 + math.log(SHEAR / COHESION)  # Gibson and Anderson 1961


def dilogarithm(x):
    return math.fsum(x ** k / k ** 2 for k in range(1, 200))


def pressure(radius):
    """Incompressible Hencky-elastic, perfectly plastic, over c. A ring that was at r0 is at r with
    r^2 = r0^2 + radius^2 - INNER^2 =: r0^2 + A; it yields at ln(r/r0) = c/(2 G)."""
    area = radius ** 2 - INNER ** 2
    share = 1 - math.exp(-COHESION / SHEAR)  # A / r^2 at the edge of the plastic zone
    free = area / (OUTER ** 2 + area)
    stiffness = SHEAR / COHESION
    if area < share * radius ** 2:
        return stiffness * (dilogarithm(area / radius ** 2) - dilogarithm(free))
    return math.log(area / share / radius ** 2) \
        + stiffness * (dilogarithm(share) - dilogarithm(free))


def scene(cells):
    """`cells` in the radius of the cavity at the start; the pressure is that of a radius that grows
    at a constant speed."""
    cell = INNER / cells
    duration = GROWTH / SPEED
    steps = [INNER + GROWTH * k / 200 for k in range(201)]
    table = [[(a - INNER) / SPEED, COHESION * pressure(a)] for a in steps]
    return {
        "title": f"cavity expansion, {cells} cells",
        "dimension": "axisymmetric", "duration": duration,
        "grid": {"cell": cell, "min": [0, 0], "max": [OUTER + 2, cell]},
        "solver": {"anti_locking": {"control": "cell", "field": "volumetric"}},
        "materials": {"clay": {"model": "tresca", "density": DENSITY, "young_modulus": YOUNG,
                               "poisson_ratio": POISSON, "cohesion": COHESION}},
        "bodies": [{"material": "clay", "box": {"min": [INNER, 0], "max": [OUTER, cell]},
                    "particles_per_cell": [2, 2],
                    "traction": [{"face": "x_min", "pressure": table, "kind": "normal"}]}],
        "boundaries": [
            {"name": "below", "condition": "slip", "plane": {"point": [0, 0], "normal": [0, 1]}},
            {"name": "above", "condition": "slip",
             "plane": {"point": [0, cell], "normal": [0, -1]}}],
        "probes": [{"name": "edge", "kind": "point", "at": [INNER + cell / 4, cell / 4],
                    "field": "displacement", "component": "x"},
                   {"name": "kinetic", "kind": "energy", "part": "kinetic"},
                   {"name": "external", "kind": "energy", "part": "external"}],
        "output": {"history": {"every": duration / 400}},
        "audits": {"energy_growth": 1},
    }


def radii(run, cells):
    """Of the cavity, out of the ring of the innermost particles: no ring changes its area."""
    start = INNER + INNER / cells / 4
    return [math.sqrt(INNER ** 2 + (start + u) ** 2 - start ** 2) for u in run.probe("edge")]


def errors(run, cells):
    """Closed form at the radius reached over the pressure applied, less 1, from 20 % of the way."""
    found = zip(run.time[1:], radii(run, cells)[1:])
    return [pressure(a) / pressure(INNER + SPEED * t) - 1 for t, a in found][80:]


def main():
    verification = Verification("cavity expansion")
    worst = {}
    for cells in [5, 10, 20] if FULL else [5, 10]:
        run = verification.run(scene(cells))
        wrong = errors(run, cells)
        worst[cells] = max(map(abs, wrong))
        label = f"{cells} cells in the cavity's radius"
        tenth = wrong[-40:]
        ended = LIMIT - pressure(INNER + GROWTH) * math.fsum(tenth) / len(tenth)
        verification.relative(f"{label}: limit pressure over c", ended, LIMIT, 0.05)
        verification.below(f"{label}: kinetic energy at the end, of the work",
                           run.probe("kinetic")[-1] / run.probe("external")[-1], 0.01)
        if cells > 5:
            verification.below(f"{label}: pressure along the way, largest error", worst[cells],
                               0.05)
            verification.below(f"{label}: the same over that of half as many cells",
                               worst[cells] / worst[cells // 2], 1)
    verification.finish()


if __name__ == "__main__":
    main()
