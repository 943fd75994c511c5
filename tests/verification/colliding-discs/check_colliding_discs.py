# SPDX-License-Identifier: Apache-2.0
"""Two discs that run into each other, elastic (they bounce off) and Tresca (they stick)."""
import math

import numpy

from verification import Verification

SPEED, RADIUS, DENSITY, COHESION = 0.1, 0.2, 1000.0, 5.0
END = {"linear_elastic": 3.0, "tresca": 5.0}
UPDATES = {"linear": "modified_last", "gimp_scaled": "first"}  # the latter is the source's method
MEETING = (0.4 * math.sqrt(2) - 2 * RADIUS) / (2 * SPEED * math.sqrt(2))  # 0.586 s


def scene(model, shape, cell):
    material = {"model": model, "density": DENSITY, "young_modulus": 1000, "poisson_ratio": 0.3}
    if model == "tresca":
        material["cohesion"] = COHESION

    def disc(name, centre, speed):
        return {"name": name, "material": "m", "sphere": {"centre": [centre] * 2, "radius": RADIUS},
                "particles_per_cell": [2, 2], "velocity": [speed] * 2}

    return {
        "title": f"colliding discs, {model}, {shape}, cell {cell:g}",
        "dimension": "plane_strain", "duration": END[model],
        "grid": {"cell": cell, "min": [-1, -1], "max": [2, 2]},
        "solver": {"time_step": 0.02 * cell, "shape": shape,
                   "stress_update": UPDATES[shape]},
        "materials": {"m": material},
        "bodies": [disc("a", 0.3, SPEED), disc("b", 0.7, -SPEED)],
        "probes": [{"name": "kinetic", "kind": "energy", "part": "kinetic"},
                   {"name": "strain", "kind": "energy", "part": "strain"},
                   {"name": "dissipated", "kind": "energy", "part": "dissipated"},
                   {"name": "a", "kind": "centre_of_mass", "body": "a", "component": "x"},
                   {"name": "b", "kind": "centre_of_mass", "body": "b", "component": "x"},
                   {"name": "mass", "kind": "mass"}],
        "output": {"history": {"every": 0.01},
                   "frames": {"every": END[model], "precision": "double",
                              "fields": ["velocity", "stress", "density", "mass", "id"]}},
        "audits": {"energy_growth": 1},
    }


def time_of_contact(run):
    """When 1 % of the kinetic energy has gone."""
    kinetic = run.probe("kinetic")
    return next(t for t, value in zip(run.time, kinetic) if value < 0.99 * kinetic[0])


def by_id(frame, name):
    values = numpy.empty((frame["id"].max() + 1, 2))
    values[frame["id"]] = frame[name][:, :2]
    return values


def asymmetry(start, end):
    """Largest distance of a particle from the place x -> 1 - x of the one that was its image at the
    start, and of its velocity from the opposite one."""
    place = start["position"][:, :2]
    order = [numpy.lexsort(numpy.round(p, 7).T) for p in (place, 1.0 - place)]
    one, other = (start["id"][k] for k in order)
    position, velocity = by_id(end, "position"), by_id(end, "velocity")
    return max(numpy.abs(position[one] + position[other] - 1.0).max(),
               numpy.abs(velocity[one] + velocity[other]).max() / SPEED)


def relative_yield(frame):
    """(s1 - s3)/(2 c) of each particle, of the Kirchhoff stress J sigma that yields."""
    xx, yy, zz, xy = (frame["stress"][:, k] for k in range(4))
    mean, radius = (xx + yy) / 2, numpy.hypot((xx - yy) / 2, xy)
    high, low = numpy.maximum(mean + radius, zz), numpy.minimum(mean - radius, zz)
    return DENSITY / frame["density"] * (high - low) / (2 * COHESION)


def check(verification, model, shape, cell):
    run = verification.run(scene(model, shape, cell))
    label = f"{model}, {shape}, cell {cell:g}"
    frame = run.frame()
    kinetic, strain = run.probe("kinetic"), run.probe("strain")
    mass, velocity = frame["mass"][:, None], frame["velocity"][:, :2]
    verification.relative(f"{label}: mass of both [kg/m]", run.probe("mass")[-1],
                          2 * math.pi * RADIUS ** 2 * DENSITY, 1e-12)
    verification.relative(f"{label}: kinetic energy at the start [J/m]", kinetic[0], 2.51327, 1e-5)
    verification.below(f"{label}: momentum at the end, over that of one disc",
                       numpy.abs((mass * velocity).sum(axis=0)).max()
                       / (frame["mass"].sum() / 2 * SPEED), 1e-12)
    early = MEETING - cell / (2 * SPEED)  # a cell's diagonal apart
    verification.between(f"{label}: 1 % of the kinetic energy gone at [s]", time_of_contact(run),
                         early, MEETING + 0.04)
    before = [k + s for t, k, s in zip(run.time, kinetic, strain) if t <= early]
    verification.relative(f"{label}: kinetic and strain energy before contact", before[-1],
                          before[0], 0.05)
    verification.below(f"{label}: from point symmetry, in domains and speeds", asymmetry(run.frame(0), frame),
                       1e-10)
    apart = numpy.diff([b - a for a, b in zip(run.probe("a"), run.probe("b"))]) / 0.01
    if model == "tresca":
        verification.below(f"{label}: relative speed at the end, of that at the start",
                           abs(apart[-10:].mean()) / (2 * SPEED), 0.05)
        verification.below(f"{label}: fastest separation, of the speed at the start",
                           apart.max() / (2 * SPEED), 0.05)
        verification.below(f"{label}: largest relative yield", relative_yield(frame).max(),
                           1.0001)
        verification.above(f"{label}: energy dissipated, of that at the start",
                           run.probe("dissipated")[-1] / kinetic[0], 0.8)
    else:
        late = run.time.index(min(run.time, key=lambda t: abs(t - 2.5)))
        verification.above(f"{label}: kinetic energy at 2.5 s, of that at the start",
                           kinetic[late] / kinetic[0], 0.8)
    return run


def main():
    verification = Verification("colliding discs")
    for shape in UPDATES:
        for cell in (0.05, 0.025):
            for model in ("linear_elastic", "tresca"):
                check(verification, model, shape, cell)
    verification.finish()


if __name__ == "__main__":
    main()
