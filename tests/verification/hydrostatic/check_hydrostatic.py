# SPDX-License-Identifier: Apache-2.0
"""Water at rest in a tank: pressure grows linearly with depth, walls and floor carry it."""
import numpy

from verification import FULL, Verification

RHO, G, WIDTH, DEPTH = 997.5, 9.81, 2.0, 2.0


def scene(title, control, start, cell):
    stabilise = {"viscous_damping": 0.5}
    if start == "none":
        stabilise.update({"force_ramp": 0.4, "local_damping": 0.2})
    return {
        "title": title,
        "dimension": "plane_strain",
        "duration": 1.0 if start == "none" else 0.3,
        "grid": {"cell": cell, "min": [0, 0], "max": [WIDTH, DEPTH + 0.5]},
        "solver": {"anti_locking": {"control": control, "field": "volumetric"},
                   "stabilise": stabilise},
        "materials": {"water": {"model": "newtonian_fluid", "density": RHO,
                                "bulk_modulus": 2e9 if FULL else 2e7, "viscosity": 0.001}},
        "bodies": [{"material": "water", "box": {"min": [0, 0], "max": [WIDTH, DEPTH]},
                    "particles_per_cell": [4, 4], "initial_stress": start}],
        "gravity": [0, -G],
        "boundaries": [
            {"name": "left", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip"},
            {"name": "right", "plane": {"point": [WIDTH, 0], "normal": [-1, 0]},
             "condition": "slip"},
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "slip"}],
        "output": {"history": {"every": 0.01},
                   "frames": {"every": 10, "fields": ["mean_stress", "velocity"],
                              "precision": "double"}},
    }


def check(verification, title, control, start, cell):
    run = verification.run(scene(title, control, start, cell))
    frame = run.frame(-1)
    pressure = -frame["mean_stress"].reshape(-1)
    row = numpy.floor(frame["position"][:, 1] / cell).astype(int)
    base = RHO * G * DEPTH
    # With cell-based anti-locking the pressure of a cell is that of its middle.
    error = [abs(pressure[row == k].mean() - RHO * G * (DEPTH - (k + 0.5) * cell)) / base
             for k in range(round(DEPTH / cell))]
    begin = 0.8 if start == "none" else 0.1
    verification.below(f"{title}: largest error of a row's mean pressure over base pressure",
                       max(error), 0.01)
    scatter = max(pressure[row == k].std() for k in range(round(DEPTH / cell))) / base
    verification.below(f"{title}: largest scatter within a row over base pressure", scatter, 0.01)
    verification.relative(f"{title}: force on the wall against rho g H^2 / 2 [N/m]",
                          run.mean("reaction.right.force.x", begin), base * DEPTH / 2, 0.005)
    verification.relative(f"{title}: force on the floor against the weight [N/m]",
                          run.mean("reaction.floor.force.y", begin), -base * WIDTH, 0.005)


verification = Verification("hydrostatic")
check(verification, "initial stress hydrostatic", "cell", "hydrostatic", 0.25)
check(verification, "settled from no stress", "cell", "none", 0.25)
if FULL:
    check(verification, "settled from no stress, finer", "cell", "none", 0.125)
verification.finish()
