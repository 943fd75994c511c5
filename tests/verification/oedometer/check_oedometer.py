# SPDX-License-Identifier: Apache-2.0
"""A column that is squeezed to 45 % of its height without lateral strain: the load against the
logarithmic strain, pushed by a wall and by a traction, with smooth shape functions and with linear
ones, which fail."""
import math

import numpy

from verification import FULL, Verification

HEIGHT, YOUNG, DENSITY = 1.0, 1e5, 1000.0
CELLS = 16 if FULL else 8
CELL = HEIGHT / CELLS
SPEED = math.sqrt(YOUNG / DENSITY)  # of waves: 10 m/s; a period of the column is 0.4 s
STRAIN = 0.8  # logarithmic, at the end
DURATION = 40.0 if FULL else 20.0


def hencky(strain):
    """Pressure over E: Kirchhoff's stress of Hencky's law is E ln(stretch), Cauchy's that over the
    stretch; the area does not change."""
    return strain * math.exp(strain)


def smooth(t):
    return t**3 * (10 - 15 * t + 6 * t * t)


def scene(dimension, shape, top, title, traction=None):
    axes = {"line": 1, "plane_strain": 2}[dimension]
    width = [2 * CELL] if axes == 2 else []
    walls = [{"name": "base", "condition": "slip",
              "plane": {"point": [0] * axes, "normal": [0] * (axes - 1) + [1]}}]
    if axes == 2:
        walls += [{"condition": "slip", "plane": {"point": [0, 0], "normal": [1, 0]}},
                  {"condition": "slip", "plane": {"point": [2 * CELL, 0], "normal": [-1, 0]}}]
    body = {"material": "hencky", "particles_per_cell": 4,
            "box": {"min": [0] * axes, "max": width + [HEIGHT]}}
    if traction:
        body["traction"] = traction
    return {
        "title": f"oedometer, {dimension}, {shape}, {title}",
        "dimension": dimension,
        "duration": DURATION,
        "solver": {"shape": shape},
        "grid": {"cell": CELL, "min": [0] * axes, "max": width + [HEIGHT + 2 * CELL]},
        "materials": {"hencky": {"model": "linear_elastic", "density": DENSITY,
                                 "young_modulus": YOUNG, "poisson_ratio": 0.0}},
        "bodies": [body],
        "boundaries": walls + top,
        "output": {"history": {"every": DURATION / 200},
                   "frames": {"every": DURATION / 40, "precision": "double",
                              "fields": ["displacement", "stress"]}},
    }


def frames(run, axis):
    """Per frame: time, logarithmic strain of the lower half of the column and its Cauchy stress."""
    found = []
    for index in range(1, 41):
        frame = run.frame(index)
        start = frame["position"][:, axis] - frame["displacement"][:, axis]
        lower = (start > 0.1 * HEIGHT) & (start < 0.5 * HEIGHT)
        stretch = 1 + numpy.polyfit(start[lower], frame["displacement"][lower, axis], 1)[0]
        found.append((frame["time"], -math.log(stretch),
                      -numpy.mean(frame["stress"][lower, axis])))
    return found


def check_driven(verification, dimension, shape):
    """The top wall moves down; the base tells the load, the particles the strain. The wall acts on
    the grid line nearest to it: it hops, and the column swings after every hop."""
    axes = {"line": 1, "plane_strain": 2}[dimension]
    end = HEIGHT * (1 - math.exp(-STRAIN))
    times = [DURATION * k / 400 for k in range(401)]
    speed = [-end / DURATION * 30 * (t / DURATION)**2 * (1 - t / DURATION)**2 for t in times]
    top = [{"name": "top", "condition": "velocity",
            "plane": {"point": [0] * (axes - 1) + [HEIGHT], "normal": [0] * (axes - 1) + [-1]},
            "velocity": [0] * (axes - 1) + [[list(p) for p in zip(times, speed)]],
            "components": ["xy"[axes - 1]]}]
    run = verification.run(scene(dimension, shape, top, "driven by a wall"))
    series = f"reaction.base.force.{'xy'[axes - 1]}"
    area = 2 * CELL if axes == 2 else 1.0
    squares, behind = [], 0.0
    for when, strain, _ in frames(run, axes - 1):
        if strain < 0.05 or when > 0.97 * DURATION:
            continue
        # over a period of the column, to see the load and not what swings
        load = -run.mean(series, when - 0.02 * DURATION, when + 0.02 * DURATION) / area
        squares.append((load / YOUNG / hencky(strain) - 1)**2)
        behind = max(behind, abs(HEIGHT * math.exp(-strain)
                                 - (HEIGHT - end * smooth(when / DURATION))))
    verification.below(f"{dimension}, {shape}, driven: load against strain, root mean square",
                       math.sqrt(numpy.mean(squares)), 0.03)
    verification.below(f"{dimension}, {shape}, driven: column against wall, in cells",
                       behind / CELL, 1.0)


def judge(verification, quantity, worst):
    verification.below(f"{quantity}, up to 0.5", worst[0], 0.01)
    verification.below(f"{quantity}, 0.5 to {STRAIN}", worst[1], 0.03)


def loaded(verification, dimension, shape, kind):
    """Largest errors below and above a strain of 0.5: of the stress against the load, and of the
    load against the strain."""
    axes = {"line": 1, "plane_strain": 2}[dimension]
    full = hencky(STRAIN) * YOUNG
    # pieces much shorter than a period of the column: their corners must not make it swing
    table = [[DURATION * k / 400, full * smooth(k / 400)] for k in range(401)]
    face = "xy"[axes - 1] + "_max"
    run = verification.run(scene(dimension, shape, [], f"{kind} load",
                                 [{"face": face, "kind": kind, "pressure": table}]))
    stress_error, load_error = [0.0, 0.0], [0.0, 0.0]
    for when, strain, stress in frames(run, axes - 1):
        load = numpy.interp(when, *zip(*table))
        if strain < 0.05:
            continue
        part = int(load > hencky(0.5) * YOUNG)
        stress_error[part] = max(stress_error[part], abs(stress / load - 1))
        load_error[part] = max(load_error[part], abs(load / YOUNG / hencky(strain) - 1))
    return stress_error, load_error


def check_loaded(verification, dimension, shape, kind):
    stress_error, load_error = loaded(verification, dimension, shape, kind)
    name = f"{dimension}, {shape}, {kind} load"
    verification.below(f"{name}: stress in the lower half against the load", max(stress_error),
                       0.03)
    judge(verification, f"{name}: load against strain", load_error)


verification = Verification("oedometer")
check_driven(verification, "line", "cpdi")
check_driven(verification, "plane_strain", "bspline2")
for shape in ["gimp", "gimp_scaled", "cpdi", "bspline2", "bspline3"] if FULL else ["cpdi"]:
    check_loaded(verification, "line", shape, "dead")
check_loaded(verification, "plane_strain", "bspline2", "normal")
_, load_error = loaded(verification, "line", "linear", "dead")
verification.above("line, linear: load against strain, 0.5 and more: linear functions fail",
                   load_error[1], 0.1)
verification.finish()
