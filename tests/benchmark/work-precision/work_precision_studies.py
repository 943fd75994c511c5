#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The problems of the charts that are scenes, as study files for the service.

    work_precision_studies.py FOLDER           writes work-precision-PROBLEM.json for each
    work_precision_studies.py FOLDER --check   fails where a file is not what would be written

A study asks for its error from a reference in the scene, so each problem's error is put as one:
README.md of the folder of studies says what it is, and by what factor it differs from the chart's.
"""
import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "studies"))
import study_file
from methods import METHODS
from problems import ROOT, Cantilever, Column, DamBreak


def cantilever_reference(problem, scene):
    """Of the volume integral of the displacement: zero in the mean, as the chart's deviation is."""
    omega = 2 * math.pi / problem.PERIOD
    amplitude = problem.SPEED / omega * 0.7340955 / 1.8751041 * problem.LENGTH * problem.HEIGHT
    times = [problem.PERIOD * k / 200 for k in range(201)]
    scene["probes"] = [{"name": "beam", "kind": "integral", "field": "displacement", "component": "y"}]
    scene["references"] = [{"probe": "beam", "curve": [
        [float(f"{t:.9g}"), float(f"{amplitude * math.sin(omega * t):.6g}")] for t in times]}]
    return "error.beam"


def column_reference(problem, scene):
    """Of the height of the centre of mass at rest."""
    scene["references"] = [{"probe": "centre",
                            "value": float(f"{problem.HEIGHT / 2 - problem.settlement():.9g}")}]
    return "error.centre"


def dam_reference(problem, scene):
    del problem, scene
    return "error.front"


PROBLEMS = {"cantilever": (Cantilever(), cantilever_reference),
            "dam-break": (DamBreak(), dam_reference),
            "column-at-rest": (Column(), column_reference)}


def differences(base, other, pointer=""):
    """JSON Pointer -> value for what differs; both have the same keys."""
    if isinstance(base, dict) and isinstance(other, dict) and base.keys() == other.keys():
        pairs = base.keys()
    elif isinstance(base, list) and isinstance(other, list) and len(base) == len(other):
        pairs = range(len(base))
    else:
        return {} if base == other else {pointer: other}
    found = {}
    for key in pairs:
        found.update(differences(base[key], other[key], f"{pointer}/{key}"))
    return found


def refused_methods(problem):
    """What the chart's table says: a study takes no row that Talus refuses."""
    with open(ROOT / "docs" / "work-precision" / "work-precision.csv", newline="") as file:
        return {row["method"] for row in csv.DictReader(file)
                if row["problem"] == problem.name and row["remark"].startswith("refused")}


def study(name, problem, refer):
    """`solver` is set whole by the variants: what a problem adds to every method is in each."""
    def scene(cells, method):
        made = problem.scene(cells, method)
        made.pop("title", None)
        return made

    base = scene(problem.resolutions[0], {})
    resolutions = []
    for cells in problem.resolutions:
        set_keys = differences(base, scene(cells, {})) or {"/grid/cell": base["grid"]["cell"]}
        resolutions.append({"label": f"{cells} cells", "set": set_keys})
    variants = [{"label": label, "set": {"/solver": scene(problem.resolutions[0], method)["solver"]}}
                for label, method in METHODS.items() if label not in refused_methods(problem)]
    base["title"] = f"accuracy against cost: {name}"
    error = refer(problem, base)
    return {"name": f"work-precision {name}", "scene": base,
            "design": {"work_precision": {"variants": variants, "resolutions": resolutions,
                                          "error": error, "cost": "particle_steps"}},
            "metrics": [error, "particle_steps", "cpu_seconds"]}


def main():
    folder, check = pathlib.Path(sys.argv[1]), "--check" in sys.argv[2:]
    study_file.write_or_check(folder, {f"work-precision-{name}.json": study(name, problem, refer)
                                       for name, (problem, refer) in PROBLEMS.items()}, check)


if __name__ == "__main__":
    main()
