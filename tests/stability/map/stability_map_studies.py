#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The stability map as study files for the service: one a body (two where quadratic elements are
taken), a bisection of the step for each method.

    stability_map_studies.py FOLDER [--check]

The bodies are those of the map in units where waves run one cell a second, so that the step is the
Courant number. A probe stands for the map's comparison of energies: in a stable run the total energy
stays below twice the one at the start (near the limit it swings that far), in an unstable one it
grows without bound or the run is ended.
"""
import argparse
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "studies"))
import stability_map
import study_file

WAVE_SPEED = stability_map.CELL  # [m/s]
ENERGY_LIMIT = 4.0  # of the energy at the start
LOW, HIGH, TOLERANCE = 0.02, 4.0, 0.02


def material(body):
    modulus = stability_map.DENSITY * WAVE_SPEED ** 2  # of longitudinal waves
    if body == "fluid":
        return {"model": "newtonian_fluid", "density": stability_map.DENSITY, "bulk_modulus": round(modulus, 9)}
    ratio = 0.49 if body == "incompressible" else 0.3
    young = modulus * (1 + ratio) * (1 - 2 * ratio) / (1 - ratio)
    return {"model": "linear_elastic", "density": stability_map.DENSITY,
            "young_modulus": float(f"{young:.9g}"), "poisson_ratio": ratio}


def scene(body):
    """With its energy at the start [J, or J/m in the plane]."""
    made = stability_map.scene({}, body, 1.0)
    energy = 0.0
    for part in made["bodies"]:
        size = [high - low for low, high in zip(part["box"]["min"], part["box"]["max"])]
        part["box"] = {key: [round(float(x), 9) for x in corner] for key, corner in part["box"].items()}
        part["velocity"] = [float(f"{v * WAVE_SPEED / stability_map.wave_speed(body):.9g}")
                            for v in part["velocity"]]
        energy += 0.5 * stability_map.DENSITY * math.prod(size) * sum(v * v for v in part["velocity"])
    made.update(title=f"a free {body} body of parts that start with different velocities",
                duration=float(stability_map.STEPS), materials={"solid": material(body)},
                solver={"time_step": 1.0, "allow_unstable": True},
                probes=[{"name": "total", "kind": "energy", "part": "total"}],
                output={"history": {"every": stability_map.STEPS / 30}})
    made["grid"] = {"cell": stability_map.CELL, "min": made["grid"]["min"],
                    "max": [round(x, 9) for x in made["grid"]["max"]]}
    return made, energy


def study(name, body, shapes, transfers, anti_locking):
    base, energy = scene(body)
    locking = [{"label": label, "value": stability_map.ANTI_LOCKING[label] or {"control": "none"}}
               for label in anti_locking]
    return {"name": f"stability map: {name}", "scene": base,
            "design": {"bisect": {
                "for_each": {"parameters": {"shape": shapes, "transfer": transfers,
                                            "stress_update": stability_map.ORDERINGS,
                                            "anti_locking": locking},
                             "set": {f"/solver/{key}": key for key in stability_map.COLUMNS[:4]}},
                "parameter": "/solver/time_step", "low": LOW, "high": HIGH, "tolerance": TOLERANCE,
                "condition": f"probe.total.max < {ENERGY_LIMIT * energy:.6g}"}},
            "metrics": ["probe.total.max", "steps"]}


def studies():
    """Quadratic elements have studies of their own: they are refused beside the edge of cells, with
    anti-locking, and with slopes."""
    whole = [shape for shape in stability_map.SHAPES if shape not in stability_map.HALVES_CELLS]
    made = {body: study(body, body, whole, stability_map.TRANSFERS, list(stability_map.ANTI_LOCKING))
            for body in stability_map.BODIES}
    for shape in stability_map.HALVES_CELLS:
        for body in stability_map.BODIES:
            if body != "edge":
                made[f"{shape}-{body}"] = study(f"{shape}, {body}", body, [shape], ["flip", "pic"],
                                                ["none"])
    return {f"stability-map-{name}.json": made[name] for name in made}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--check", action="store_true", help="fails where a file would be another")
    arguments = parser.parse_args()
    study_file.write_or_check(arguments.folder, studies(), arguments.check)


if __name__ == "__main__":
    main()
