# SPDX-License-Identifier: Apache-2.0
"""A column that is squeezed to 45 % of its height without lateral strain: the load against the
logarithmic strain, pushed by a wall and by a traction."""
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


def scene(dimension, top, title, traction=None):
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
        "title": f"oedometer, {dimension}, {title}",
        "dimension": dimension,
        "duration": DURATION,
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


def check_driven(verification, dimension):
    """The top wall moves down; the base tells the load, over an interval of the history."""
    axes = {"line": 1, "plane_strain": 2}[dimension]
    end = HEIGHT * (1 - math.exp(-STRAIN))
    times = [DURATION * k / 100 for k in range(101)]
    speed = [-end / DURATION * 30 * (t / DURATION)**2 * (1 - t / DURATION)**2 for t in times]
    top = [{"name": "top", "condition": "velocity",
            "plane": {"point": [0] * (axes - 1) + [HEIGHT], "normal": [0] * (axes - 1) + [-1]},
            "velocity": [0] * (axes - 1) + [[list(p) for p in zip(times, speed)]],
            "components": ["xy"[axes - 1]]}]
    run = verification.run(scene(dimension, top, "driven by a wall"))
    component = "xy"[axes - 1]
    area = 2 * CELL if axes == 2 else 1.0
    worst = 0.0
    for when in numpy.linspace(0.3, 0.95, 14) * DURATION:
        strain = -math.log(1 - end / HEIGHT * smooth(when / DURATION))
        force = -run.mean(f"reaction.base.force.{component}", when - 0.02 * DURATION,
                          when + 0.02 * DURATION) / (area * YOUNG)
        if 0.05 < strain:
            worst = max(worst, abs(force / hencky(strain) - 1))
    verification.below(f"{dimension}, driven: load against strain, up to {STRAIN}", worst, 0.03)


def check_loaded(verification, dimension, kind):
    axes = {"line": 1, "plane_strain": 2}[dimension]
    full = hencky(STRAIN) * YOUNG
    table = [[DURATION * k / 100, full * smooth(k / 100)] for k in range(101)]
    face = "xy"[axes - 1] + "_max"
    run = verification.run(scene(dimension, [], f"{kind} load",
                                 [{"face": face, "kind": kind, "pressure": table}]))
    worst_load, worst_strain = 0.0, 0.0
    for when, strain, stress in frames(run, axes - 1):
        load = numpy.interp(when, *zip(*table))
        if strain < 0.05:
            continue
        worst_load = max(worst_load, abs(stress / load - 1))
        worst_strain = max(worst_strain, abs(load / YOUNG / hencky(strain) - 1))
    verification.below(f"{dimension}, {kind} load: stress in the lower half", worst_load, 0.03)
    verification.below(f"{dimension}, {kind} load: load against strain", worst_strain, 0.03)


verification = Verification("oedometer")
check_driven(verification, "line")
check_driven(verification, "plane_strain")
check_loaded(verification, "line", "dead")
check_loaded(verification, "plane_strain", "normal")
verification.finish()
