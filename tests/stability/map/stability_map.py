#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The largest Courant number c dt / h at which each method stays stable, found by bisection.

Every combination of shape function, transfer, stress ordering and anti-locking that Talus offers is
run on four small free bodies whose parts start with slightly different velocities, so that waves of
all lengths run through them. The step is unstable if the energy grows from the first third of the run to
the last. README.md has the bodies and how to read the map.

    stability_map.py --worker talus-worker --out FOLDER [--only TEXT] [--sample N] [--jobs N]
"""
import argparse
import concurrent.futures
import csv
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

SHAPES = ["linear", "gimp", "gimp_scaled", "cpdi", "cpdi_hybrid", "bspline2", "bspline3"]
TRANSFERS = ["flip", "pic", "apic"]
ORDERINGS = ["modified_last", "first", "last"]
ANTI_LOCKING = {
    "none": None,
    "cell volumetric": {"control": "cell", "field": "volumetric"},
    "cell full": {"control": "cell", "field": "full"},
    "cell full_constant_volume": {"control": "cell", "field": "full_constant_volume"},
    "node volumetric": {"control": "node", "field": "volumetric"},
    "hybrid full": {"control": "hybrid", "field": "full"},
}
BODIES = ["uniform", "edge", "incompressible", "solid"]
COLUMNS = ["shape", "transfer", "stress_update", "anti_locking"] + BODIES + ["limit"]

STEPS = 1500
GROWTH = 1.25  # of the energy from the first third to the last: 2e-4 a step is found
RESOLUTION = 0.02  # of the bisection, relative
LOWEST, HIGHEST = 0.01, 4.0
CELL = 0.1
DENSITY = 1000.0
YOUNG = 1e6


def wave_speed(ratio):
    """Of longitudinal waves, and in plane strain too."""
    return (YOUNG * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio)) / DENSITY) ** 0.5


def poisson_ratio(body):
    return 0.49 if body == "incompressible" else 0.3


def parts(body):
    """Boxes in cells, and what they start with. The edge body lies a thousandth of a cell over the
    grid lines: its outermost particles have just entered cells of their own."""
    if body == "solid":
        boxes = [((i, j, k), (i + 2, j + 2, k + 2))
                 for i, j, k in itertools.product((0, 2), repeat=3)]
        return boxes, numpy.zeros(3)
    shift = 0.251 if body == "edge" else 0.0
    boxes = [((i, j), (i + 2, j + 2)) for i, j in itertools.product((0, 2, 4), repeat=2)]
    return boxes, numpy.full(2, shift)


def scene(method, body, courant):
    ratio = poisson_ratio(body)
    speed = wave_speed(ratio)
    step = courant * CELL / speed
    boxes, shift = parts(body)
    axes = len(shift)
    random = numpy.random.default_rng(7)
    bodies = []
    for index, (low, high) in enumerate(boxes):
        bodies.append({
            "name": f"part{index}", "material": "solid",
            "box": {"min": list((numpy.array(low) + shift + 4) * CELL),
                    "max": list((numpy.array(high) + shift + 4) * CELL)},
            "particles_per_cell": [2] * axes,
            "velocity": list(1e-6 * speed * random.uniform(-1, 1, axes))})
    solver = {"kind": "explicit", "time_step": step, "allow_unstable": True}
    solver.update(method)
    return {"dimension": "solid" if axes == 3 else "plane_strain", "duration": STEPS * step,
            "grid": {"cell": CELL, "min": [0] * axes, "max": [(12 if axes == 2 else 10) * CELL] * axes},
            "solver": solver,
            "materials": {"solid": {"model": "linear_elastic", "density": DENSITY,
                                    "young_modulus": YOUNG, "poisson_ratio": ratio}},
            "bodies": bodies, "audits": {"energy_growth": 1e9},
            "output": {"history": {"every": STEPS / 30 * step}}}


class Refused(Exception):
    """The scene is not accepted: the text says why."""


def energies(folder):
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return [float(row["energy.kinetic"]) + float(row["energy.strain"]) for row in rows]


def is_stable(worker, method, body, courant):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.json").write_text(json.dumps(scene(method, body, courant)))
        answer = subprocess.run([worker, "run", folder / "scene.json", "--out", folder / "out"],
                                capture_output=True, text=True)
        if answer.returncode == 10:
            raise Refused(answer.stderr.strip())
        if answer.returncode == 11:
            return False
        if answer.returncode not in (0, 15):
            raise RuntimeError(f"{method} {body} {courant}: exit {answer.returncode}\n{answer.stderr}")
        found = energies(folder / "out")
    third = len(found) // 3
    return bool(numpy.isfinite(found).all()) and max(found[-third:]) <= GROWTH * max(found[:third])


def largest_courant(worker, method, body):
    """0: unstable at LOWEST already."""
    if not is_stable(worker, method, body, LOWEST):
        return 0.0
    low, high = LOWEST, HIGHEST
    if is_stable(worker, method, body, high):
        return high
    while high > (1 + RESOLUTION) * low:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if is_stable(worker, method, body, middle) else (low, middle)
    return low


def methods():
    for shape, transfer, ordering, locking in itertools.product(SHAPES, TRANSFERS, ORDERINGS,
                                                                ANTI_LOCKING):
        method = {"shape": shape, "transfer": transfer, "stress_update": ordering}
        if ANTI_LOCKING[locking] is not None:
            method["anti_locking"] = ANTI_LOCKING[locking]
        yield (shape, transfer, ordering, locking), method


def row_of(worker, name, method):
    try:
        found = [largest_courant(worker, method, body) for body in BODIES]
    except Refused as refusal:
        return list(name) + ["refused"] * (len(BODIES) + 1), str(refusal)
    return list(name) + [f"{value:.3f}" for value in found] + [f"{min(found):.3f}"], None


def chosen(arguments):
    wanted = [entry for entry in methods() if arguments.only in " ".join(entry[0])]
    if arguments.sample is not None and arguments.sample < len(wanted):
        step = len(wanted) / arguments.sample
        wanted = [wanted[int(index * step)] for index in range(arguments.sample)]
    return wanted


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--worker", default=os.environ.get("TALUS_WORKER", "talus-worker"))
    parser.add_argument("--out", type=pathlib.Path, required=True, help="writes stability-map.csv here")
    parser.add_argument("--only", default="", help="methods whose name holds this text")
    parser.add_argument("--sample", type=int, help="so many methods, spread evenly")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    wanted = chosen(arguments)
    arguments.out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool, \
            open(arguments.out / "stability-map.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        found = pool.map(lambda entry: row_of(arguments.worker, *entry), wanted)
        for number, (row, refusal) in enumerate(found, 1):
            writer.writerow(row)
            file.flush()
            print(f"{number}/{len(wanted)}", *row, refusal or "", flush=True, file=sys.stderr)


if __name__ == "__main__":
    main()
