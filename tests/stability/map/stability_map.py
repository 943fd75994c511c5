#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The largest Courant number c dt / h at which each method stays stable, found by bisection.

Every combination of shape function, transfer, stress ordering and anti-locking that Talus offers is
run on five small free bodies whose parts start with slightly different velocities, so that waves of
all lengths run through them. The step is unstable if the energy grows from the first third of the run to
the last. README.md has the bodies and how to read the map.

    stability_map.py [--probe PROGRAM] --out FOLDER [--only TEXT] [--sample N] [--jobs N]
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
import threading

import numpy

SHAPES = ["linear", "gimp", "gimp_scaled", "cpdi", "cpdi_hybrid", "bspline2", "bspline3", "quadratic"]
HALVES_CELLS = ["quadratic"]  # the solver's cells are half as wide as those of the scene
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
BODIES = ["uniform", "edge", "incompressible", "solid", "fluid"]  # the last two in 3D
COLUMNS = ["shape", "transfer", "stress_update", "anti_locking"] + BODIES + ["limit"]

STEPS = 1500
GROWTH = 1.25  # of the energy from the first third to the last: 2e-4 a step is found
RESOLUTION = 0.03  # of the bisection, relative
HINT = 1.1
LOWEST, HIGHEST = 0.01, 4.0
REFUSED = "refused"  # in place of a Courant number: the scene is not accepted
CELL = 0.1
DENSITY = 1000.0
STIFFNESS = 1e6


def material(body):
    if body == "fluid":
        return {"model": "newtonian_fluid", "density": DENSITY, "bulk_modulus": STIFFNESS}
    return {"model": "linear_elastic", "density": DENSITY, "young_modulus": STIFFNESS,
            "poisson_ratio": 0.49 if body == "incompressible" else 0.3}


def wave_speed(body):
    """Of longitudinal waves, which plane strain does not change."""
    made = material(body)
    ratio = made.get("poisson_ratio", 0)
    return (STIFFNESS * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio)) / DENSITY) ** 0.5


def parts(body):
    """Boxes in cells, and what they start with. The edge body lies a thousandth of a cell over the
    grid lines: its outermost particles have just entered cells of their own."""
    if body in ("solid", "fluid"):
        boxes = [((i, j, k), (i + 2, j + 2, k + 2))
                 for i, j, k in itertools.product((0, 2), repeat=3)]
        return boxes, numpy.zeros(3)
    shift = 0.251 if body == "edge" else 0.0
    boxes = [((i, j), (i + 2, j + 2)) for i, j in itertools.product((0, 2, 4), repeat=2)]
    return boxes, numpy.full(2, shift)


def scene(method, body, courant):
    speed = wave_speed(body)
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
            "materials": {"solid": material(body)},
            "bodies": bodies, "audits": {"energy_growth": 1e9},
            "output": {"history": {"every": STEPS / 30 * step}}}


local = threading.local()
local_program = []


class Refused(Exception):
    """The scene is not accepted: the text says why."""


def ask(scene):
    """Runs a scene in the probe of this thread."""
    if not hasattr(local, "probe"):
        local.probe = subprocess.Popen([local_program[0]], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, text=True)
    local.probe.stdin.write(json.dumps(scene) + "\n")
    local.probe.stdin.flush()
    return json.loads(local.probe.stdout.readline())


def is_stable(method, body, courant):
    answer = ask(scene(method, body, courant))
    if "refused" in answer:
        raise Refused(answer["refused"])
    if "unstable" in answer or None in answer["energies"]:
        return False
    found = answer["energies"]
    third = len(found) // 3
    return max(found[-third:]) <= GROWTH * max(found[:third])


def largest_courant(method, body, hint=None):
    """0: unstable at LOWEST already. `hint`: a value that may be near."""
    def stable(courant):
        return is_stable(method, body, courant)

    low, high = LOWEST, HIGHEST
    if hint and hint / HINT > LOWEST and stable(hint / HINT) and not stable(hint * HINT):
        low, high = hint / HINT, hint * HINT
    elif not stable(low):
        return 0.0
    elif stable(high):
        return high
    while high > (1 + RESOLUTION) * low:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low


def methods():
    """Families of methods that differ in anti-locking only, whose limits lie near each other."""
    for shape, transfer, ordering in itertools.product(SHAPES, TRANSFERS, ORDERINGS):
        family = []
        for locking, keys in ANTI_LOCKING.items():
            method = {"shape": shape, "transfer": transfer, "stress_update": ordering}
            if keys is not None:
                method["anti_locking"] = keys
            family.append(((shape, transfer, ordering, locking), method))
        yield family


def rows_of(family):
    hints = {}
    rows = []
    for name, method in family:
        found = []
        reasons = set()
        for body in BODIES:
            try:
                hints[body] = largest_courant(method, body, hints.get(body))
                found.append(f"{hints[body]:.3f}")
            except Refused as refusal:
                found.append(REFUSED)
                reasons.add(str(refusal))
        for reason in reasons:
            print(*name, reason, file=sys.stderr)
        taken = [value for value in found if value != REFUSED]
        rows.append(list(name) + found + [min(taken, key=float, default=REFUSED)])
    return rows


def chosen(arguments):
    families = [[entry for entry in family if arguments.only in " ".join(entry[0])]
                for family in methods()]
    families = [family for family in families if family]
    if arguments.sample is None:
        return families
    # Each family gives one method, another one every time.
    step = max(1, len(families) // arguments.sample)
    return [[family[index % len(family)]] for index, family in enumerate(families[::step])]


CONTROLS = ["none", "cell", "node", "hybrid"]


def limit_of(rows):
    """Of methods that differ in the field of anti-locking only; see solver/explicit/courant_limit.c."""
    smallest = []
    for row in rows:
        inner = min(float(row[body]) for body in BODIES if body != "edge")
        edge = 0.0 if row["edge"] == REFUSED else float(row["edge"])
        smallest.append(min(inner, edge) if edge > inner / 2 else inner)
    return min(smallest)


def write_table(folder, path):
    """The map as the table that the solver is compiled with."""
    with open(folder / "stability-map.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["limit"] != REFUSED]
    families = {}
    for row in rows:
        family = families.setdefault((row["shape"], row["transfer"], row["stress_update"]), {})
        family.setdefault(row["anti_locking"].split()[0], []).append(row)
    with open(path, "w") as file:
        file.write("/* SPDX-License-Identifier: Apache-2.0 */\n"
                   "/* Written by tests/stability/map/stability_map.py --table: do not edit.\n"
                   " * COURANT_LIMIT(shape, transfer, ordering, anti-locking none, cell, node, "
                   "hybrid),\n * c dt over the width of the solver's cells */\n")
        for (shape, transfer, ordering), family in families.items():
            plain = limit_of(family["none"])
            scale = 2 if shape in HALVES_CELLS else 1
            found = [scale * (limit_of(family[name]) if name in family else plain)
                     for name in CONTROLS]
            file.write(f"COURANT_LIMIT({shape}, {transfer}, {ordering.upper()}, "
                       + ", ".join(f"{value:.3f}" for value in found) + ")\n")


def draw(folder):
    """One row a shape, transfer and ordering, one column an anti-locking and body."""
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "talus"
    matplotlib.rcParams["svg.fonttype"] = "none"
    import matplotlib.pyplot as plt
    with open(folder / "stability-map.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    names = list(dict.fromkeys((r["shape"], r["transfer"], r["stress_update"]) for r in rows))
    columns = [(locking, body) for locking in ANTI_LOCKING for body in BODIES]
    values = numpy.full((len(names), len(columns)), numpy.nan)
    for row in rows:
        for body in BODIES:
            if row[body] != REFUSED:
                values[names.index((row["shape"], row["transfer"], row["stress_update"])),
                       columns.index((row["anti_locking"], body))] = float(row[body])
    figure, axis = plt.subplots(figsize=(13, 0.22 * len(names) + 2))
    axis.set_facecolor("lightgrey")  # what is refused
    picture = axis.imshow(values, aspect="auto", cmap="viridis", vmin=0, vmax=2)
    axis.set_yticks(range(len(names)), [", ".join(name) for name in names], fontsize=7)
    axis.set_xticks(range(len(columns)), [f"{locking}: {body}" for locking, body in columns],
                    fontsize=7, rotation=90)
    for (y, x), value in numpy.ndenumerate(values):
        if numpy.isfinite(value):
            axis.text(x, y, f"{value:.2f}", ha="center", va="center", fontsize=5,
                      color="white" if value < 1.2 else "black")
    figure.colorbar(picture, label="largest stable Courant number c dt / h (grey: refused)")
    figure.tight_layout()
    path = folder / "stability-map.svg"
    figure.savefig(path, metadata={"Date": None})
    path.write_text("".join(f"{line.rstrip()}\n" for line in path.read_text().splitlines()))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--probe", default="build/release/bin/talus-stability-probe")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="writes stability-map.csv here")
    parser.add_argument("--only", default="", help="methods whose name holds this text")
    parser.add_argument("--sample", type=int, help="about so many methods, spread evenly")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--draw", action="store_true", help="only draws the map in --out")
    parser.add_argument("--table", type=pathlib.Path,
                        help="only writes this file out of the map in --out")
    arguments = parser.parse_args()
    if arguments.draw:
        draw(arguments.out)
        return
    if arguments.table is not None:
        write_table(arguments.out, arguments.table)
        return
    local_program.append(arguments.probe)
    wanted = chosen(arguments)
    arguments.out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool, \
            open(arguments.out / "stability-map.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        found = pool.map(rows_of, wanted)
        for number, rows in enumerate(found, 1):
            writer.writerows(rows)
            file.flush()
            for row in rows:
                print(f"{number}/{len(wanted)}", *row, flush=True, file=sys.stderr)


if __name__ == "__main__":
    main()
