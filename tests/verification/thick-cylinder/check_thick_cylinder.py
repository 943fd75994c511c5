# SPDX-License-Identifier: Apache-2.0
"""A thick-walled cylinder under internal pressure, as a body of revolution whose faces lie on grid
lines, and as a quarter in plane strain whose round faces lie where they will: Lame's solution."""
import math

import numpy

from verification import FULL, Verification

INNER, OUTER, YOUNG, POISSON, DENSITY = 1.0, 2.0, 1e6, 0.3, 1000.0
PRESSURE = 1e-4 * YOUNG  # displacements of 2e-4 m: finite strain changes them by 1e-4
A = PRESSURE * INNER**2 / (OUTER**2 - INNER**2)
B = A * OUTER**2


def displacement(radius):
    """Radial displacement in plane strain."""
    return (1 + POISSON) / YOUNG * ((1 - 2 * POISSON) * A * radius + B / radius)


def common(cell):
    return {
        "duration": 2.2,
        "materials": {"steel": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": POISSON}},
        "output": {"history": {"every": 0.05}, "frames": {"every": 2.2, "precision": "double",
                                                          "fields": ["displacement", "stress"]}},
        "title": f"thick cylinder, cell {cell:g}",
    }


def load(face, kind):
    """Grows over 2 s, seven periods of the cylinder, with two smooth derivatives: what is left
    swinging is 60 / (2 pi 7)^3, less than a thousandth."""
    shares = [k / 80 for k in range(81)]
    table = [[2 * t, PRESSURE * t**3 * (10 - 15 * t + 6 * t * t)] for t in shares]
    return [{"face": face, "kind": kind, "pressure": table}]


def revolved(cell, kind):
    return dict(
        common(cell), dimension="axisymmetric",
        grid={"cell": cell, "min": [0, 0], "max": [OUTER + 2 * cell, 2 * cell]},
        bodies=[{"material": "steel", "particles_per_cell": 2,
                 "box": {"min": [INNER, 0], "max": [OUTER, 2 * cell]},
                 "traction": load("x_min", kind)}],
        boundaries=[{"condition": "slip", "plane": {"point": [0, 0], "normal": [0, 1]}},
                    {"condition": "slip", "plane": {"point": [0, 2 * cell], "normal": [0, -1]}}])


def quarter(cell, kind, sides=64):
    """Counterclockwise: along the x axis, the outer arc, down the y axis, the inner arc."""
    angles = [math.pi / 2 * k / sides for k in range(sides + 1)]
    vertices = [[OUTER * math.cos(a), OUTER * math.sin(a)] for a in angles]
    vertices += [[INNER * math.cos(a), INNER * math.sin(a)] for a in reversed(angles)]
    return dict(
        common(cell), dimension="plane_strain",
        grid={"cell": cell, "min": [0, 0], "max": [OUTER + 2 * cell] * 2},
        bodies=[{"material": "steel", "particles_per_cell": 2, "polygon": {"vertices": vertices},
                 "traction": load(f"side_{sides + 1}_to_{2 * sides}", kind)}],
        boundaries=[{"condition": "slip", "plane": {"point": [0, 0], "normal": [1, 0]}},
                    {"condition": "slip", "plane": {"point": [0, 0], "normal": [0, 1]}}])


def errors(run, is_quarter):
    """Root mean squares over the particles: displacement, of the largest; hoop stress away from the
    faces, of the mean."""
    frame = run.frame()
    moved = frame["displacement"]
    place = frame["position"] - moved
    stress = frame["stress"]
    if is_quarter:
        radius = numpy.hypot(place[:, 0], place[:, 1])
        cosine, sine = place[:, 0] / radius, place[:, 1] / radius
        radial = moved[:, 0] * cosine + moved[:, 1] * sine
        hoop = (stress[:, 0] * sine**2 + stress[:, 1] * cosine**2
                - 2 * stress[:, 3] * sine * cosine)
    else:
        radius, radial, hoop = place[:, 0], moved[:, 0], stress[:, 2]
    error = numpy.sqrt(numpy.mean((radial - displacement(radius))**2)) / displacement(INNER)
    inside = (radius > 1.2) & (radius < 1.8)
    exact = A + B / radius[inside]**2
    return error, numpy.sqrt(numpy.mean((hoop[inside] - exact)**2)) / numpy.mean(exact)


def check(verification, shape, cells, tolerances):
    is_quarter = shape is quarter
    name = "quarter in plane strain" if is_quarter else "body of revolution"
    found = []
    for cell in cells:
        run = verification.run(shape(cell, "normal"))
        found.append(errors(run, is_quarter))
        print(f"  {name}, cell {cell:g}: displacement {found[-1][0]:.3e}, "
              f"hoop stress {found[-1][1]:.3e}, kinetic/strain energy "
              f"{run.series['energy.kinetic'][-1] / run.series['energy.strain'][-1]:.1e}")
    verification.below(f"{name}, {1 / cells[0]:.0f} cells: displacement", found[0][0],
                       tolerances[0])
    verification.below(f"{name}, {1 / cells[0]:.0f} cells: hoop stress inside", found[0][1],
                       tolerances[1])
    order = math.log(found[0][0] / found[-1][0]) / math.log(cells[0] / cells[-1])
    verification.above(f"{name}: order of convergence of the displacement", order, tolerances[2])
    return found


verification = Verification("thick-cylinder")
check(verification, revolved, [0.1, 0.05, 0.025] if FULL else [0.1, 0.05], (0.02, 0.02, 0.8))
first = check(verification, quarter, [0.1, 0.05, 0.025] if FULL else [0.1, 0.05],
              (0.05, 0.05, 0.7))
dead = errors(verification.run(quarter(0.1, "dead")), True)
verification.below("quarter: a dead pressure does the same at small strain",
                   abs(dead[0] - first[0][0]), 1e-3)
verification.finish()
