# SPDX-License-Identifier: Apache-2.0
"""A rubber cylinder lands on a smooth floor: as a body of revolution, and as a quarter in 3D."""
import math

from verification import FULL, Verification

RADIUS, HEIGHT, GAP, SPEED, END = 0.5, 0.5, 0.05, 3.0, 0.12
CELL = 0.05 if FULL else 0.1
DENSITY = 1000.0


def common(dimension, axes):
    floor = {"name": "floor", "condition": "slip",
             "plane": {"point": [0] * axes, "normal": [0, 1, 0][:axes]}}
    return {
        "title": f"cylinder on a floor, {dimension}", "dimension": dimension, "duration": END,
        "grid": {"cell": CELL, "min": [0] * axes, "max": [1.0, 1.5, 1.0][:axes]},
        "materials": {"rubber": {"model": "linear_elastic", "density": DENSITY,
                                 "young_modulus": 1e6, "poisson_ratio": 0.3}},
        "boundaries": [floor],
        "probes": [{"name": "mass", "kind": "mass"},
                   {"name": "top", "kind": "front", "along": [0, 1, 0][:axes]},
                   {"name": "middle", "kind": "centre_of_mass", "component": "y"}],
        "output": {"history": {"every": 1e-3}, "frames": {"every": END, "fields": ["velocity"]}},
    }


def revolved():
    scene = common("axisymmetric", 2)
    scene["bodies"] = [{"name": "body", "material": "rubber", "particles_per_cell": 2,
                        "box": {"min": [0, GAP], "max": [RADIUS, GAP + HEIGHT]},
                        "velocity": [0, -SPEED]}]
    return scene


def quarter():
    scene = common("solid", 3)
    scene["bodies"] = [{"name": "body", "material": "rubber", "particles_per_cell": 2,
                        "cylinder": {"from": [0, GAP, 0], "to": [0, GAP + HEIGHT, 0],
                                     "radius": RADIUS},
                        "clip": {"min": [0, None, 0], "max": [None, None, None]},
                        "velocity": [0, -SPEED, 0]}]
    for name, normal in (("x", [1, 0, 0]), ("z", [0, 0, 1])):
        scene["boundaries"].append({"name": "mirror_" + name, "condition": "slip",
                                    "plane": {"point": [0, 0, 0], "normal": normal}})
    return scene


def largest_gap(first, second, name):
    """Up to the lowest point of the first, over its way down."""
    values = first.series[name]
    lowest = values.index(min(values))
    return max(abs(a - b) for a, b in zip(values[:lowest + 1], second.series[name])) \
        / (values[0] - values[lowest])


verification = Verification("revolution")
twin, run = verification.run(quarter()), verification.run(revolved())
mass = DENSITY * math.pi * RADIUS**2 * HEIGHT
verification.relative("mass [kg]", run.probe("mass")[0], mass, 1e-12)
verification.relative("mass of four quarters [kg]", 4 * twin.probe("mass")[0], mass, 1e-9)
verification.below("momentum error", run.metrics["momentum_error"], 1e-12)
verification.below("energy gained", run.metrics["energy_error"], 0.01)
verification.below("height of the centre of mass on its way down, difference over the way",
                   largest_gap(run, twin, "probe.middle"), 0.03)
verification.relative("impulse on the floor [N s]", run.impulse("floor", "y"),
                      4 * twin.impulse("floor", "y"), 0.03)
verification.relative("lowest top [m]", min(run.probe("top")), min(twin.probe("top")), 0.02)
stored, stored_twin = (max(each.series["energy.strain"]) for each in (run, twin))
verification.relative("largest strain energy [J]", stored, 4 * stored_twin, 0.03)
verification.finish()
