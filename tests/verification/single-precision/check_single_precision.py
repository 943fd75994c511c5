# SPDX-License-Identifier: Apache-2.0
"""Single precision against double: four problems at several resolutions, what of it is refused, and
the same bits for any number of threads.

TALUS_CHART_FOLDER=FOLDER writes the figures there as single-precision.csv and .svg, for docs/."""
import copy
import csv
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess

import numpy
from single_precision_chart import draw
from verification import FULL, Verification, on_linear_shapes, shipped_scene, worker

G = 9.81


def dam_break(cell):
    """Water in a corner, with a bulk modulus that lets it keep its volume to 1e-4."""
    width, height = 0.057, 0.114
    return {
        "title": f"dam break, cell {cell:g} m", "dimension": "plane_strain", "duration": 0.16,
        "grid": {"cell": cell, "min": [0, 0], "max": [0.342, 0.171]},
        "solver": {"anti_locking": {"control": "cell"}, "stabilise": {"viscous_damping": 0.5}},
        "materials": {"water": {"model": "newtonian_fluid", "density": 997.5, "bulk_modulus": 2e7,
                                "viscosity": 1e-3}},
        "bodies": [{"material": "water", "box": {"min": [0, 0], "max": [width, height]},
                    "particles_per_cell": [3, 3], "initial_stress": "hydrostatic"}],
        "gravity": [0, -G],
        "boundaries": [
            {"name": "wall", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip"},
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "slip"}],
        "probes": [{"name": "front", "kind": "front", "along": [1, 0]},
                   {"name": "height", "kind": "height", "on": "wall"}],
        "output": {"history": {"every": 0.002}},
    }


def elastic_column(cell):
    """A column to which its weight is given at once: it swings with the period 4 H / c. The end
    is at the lowest point of the third swing, where energy has been turned over."""
    return {
        "title": f"elastic column, cell {cell:g} m", "dimension": "plane_strain", "duration": 0.0863,
        "grid": {"cell": cell, "min": [0, 0], "max": [0.4, 1.2]},
        "materials": {"rubber": {"model": "linear_elastic", "density": 1000, "young_modulus": 1e7,
                                 "poisson_ratio": 0.3}},
        "bodies": [{"material": "rubber", "box": {"min": [0, 0], "max": [0.4, 1]},
                    "particles_per_cell": [2, 2]}],
        "gravity": [0, -G],
        "boundaries": [
            {"name": "left", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip"},
            {"name": "right", "plane": {"point": [0.4, 0], "normal": [-1, 0]}, "condition": "slip"},
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "stick"}],
        "probes": [{"name": "height", "kind": "centre_of_mass", "component": "y"}],
        "output": {"history": {"every": 2e-4}},
    }


def sand_column(cell):
    """Mast 2013, sec. 7.2, with automatic steps."""
    scene = shipped_scene("mast-7.2-sand-column-a2-case2-drucker-prager")
    scene["title"] = f"sand column, cell {cell:g} m"
    scene["duration"] = 0.45
    scene["grid"]["cell"] = cell
    scene["solver"]["time_step"] = "auto"
    scene["probes"] = [{"name": "runout", "kind": "front", "along": [1, 0],
                        "measure": "centre_of_mass"},
                       {"name": "ridge", "kind": "height", "measure": "centre_of_mass"}]
    scene["output"] = {"history": {"every": 0.005}}
    return scene


def column_impact(cell):
    """Mast 2013, sec. 7.4, closed by a wall over its whole width: a problem in the plane."""
    shipped = shipped_scene("mast-7.4-column-impact")
    return {
        "title": f"impact on a wall, cell {cell:g} m", "dimension": "plane_strain", "duration": 3.5,
        "grid": {"cell": cell, "min": [0, 0], "max": [9, 12]},
        "solver": shipped["solver"], "materials": shipped["materials"],
        "bodies": [{"material": "soil", "box": {"min": [0, 0], "max": [8, 3]},
                    "particles_per_cell": [2, 2], "velocity": [1, 0],
                    "initial_stress": {"geostatic": {"k0": "auto"}}}],
        "gravity": [0, -10],
        "boundaries": [
            {"name": "bed", "plane": {"point": [0, 0], "normal": [0, 1]},
             "condition": "friction", "friction_angle": 65},
            {"name": "back", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip",
             "tension_release": True},
            {"name": "column", "plane": {"point": [9, 0], "normal": [-1, 0]},
             "condition": "slip", "tension_release": True}],
        "probes": [{"name": "height", "kind": "centre_of_mass", "component": "y"}],
        "output": {"history": {"every": 0.01}},
    }


def period(run):
    """Frequency of least residual of a cos + b sin + c in the height of the centre of mass."""
    time, value = numpy.array(run.time), numpy.array(run.probe("height"))
    low, high = 0.031, 0.038  # 4 H / c = 0.0345 s

    def residual(candidate):
        phase = 2 * math.pi * time / candidate
        base = numpy.stack([numpy.cos(phase), numpy.sin(phase), numpy.ones_like(time)], axis=1)
        return numpy.linalg.norm(value - base @ numpy.linalg.lstsq(base, value, rcond=None)[0])

    golden = (math.sqrt(5) - 1) / 2
    for _ in range(60):
        a, b = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, b) if residual(a) < residual(b) else (a, high)
    return (low + high) / 2


def last(series):
    return lambda run: run.series[series][-1]


def peak(boundary):
    return lambda run: run.metrics[f"reaction.{boundary}.peak"]


def steady(series, begin):
    return lambda run: run.mean(series, begin)


# Problem: scene, cells from coarse to fine (the last in the full form only), the curve of the chart,
# figures as (name, reading, tolerance of single against double, relative), and whether it scatters.
# Tolerances: what is smooth, some hundred roundings (1e-5). The front of water and of sand is a few
# particles, of which one crosses into a cell a step earlier or later: 1e-3 and 1e-2. Peaks are single
# steps: 2e-2. A flow of soil amplifies every difference: in double precision too it ends elsewhere if
# gravity differs by one rounding of a float. What scatters is held against the span of three such runs.
PROBLEMS = {
    "dam break": (dam_break, (0.0114, 0.0057, 0.00285), "probe.front", (
        ("front", last("probe.front"), 1e-3), ("height at the wall", last("probe.height"), 1e-3)), False),
    "elastic column": (elastic_column, (0.1, 0.05, 0.025), "probe.height", (
        ("period", period, 1e-5), ("peak force on the floor", peak("floor"), 1e-4)), False),
    "sand column": (sand_column, (0.01, 0.005, 0.0025), "probe.runout", (
        ("run-out", last("probe.runout"), 1e-2), ("ridge", last("probe.ridge"), 1e-2)), True),
    "impact on a wall": (column_impact, (0.5, 0.25, 0.125), "probe.height", (
        ("peak force", peak("column"), 2e-2),
        ("steady force", steady("reaction.column.force.x", 2.5), 2e-2)), True),
}


def in_single(scene):
    single = copy.deepcopy(scene)
    single.setdefault("solver", {})["precision"] = "single"
    single["title"] += ", single precision"
    return single


def disturbed(scene, share):
    other = copy.deepcopy(scene)
    other["gravity"] = [component * (1 + share) for component in scene["gravity"]]
    other["title"] += f", gravity {share:+.1e}"
    return other


def check_audits(verification, problem, run):
    verification.equal(f"{problem}: precision of the receipt", run.receipt["precision"], "single")
    verification.below(f"{problem}: mass error of the audit", run.metrics["mass_error"], 1e-6)
    verification.below(f"{problem}: momentum error of the audit", run.metrics["momentum_error"], 1e-4)


def check_problem(verification, problem):
    """Rows for the table: [problem, figure, cell, double, single, error, change with half the cell,
    spread of double]; and the curve of the error over time at the finest cell: (time over duration,
    error)."""
    make, cells, curve, figures, scatters = PROBLEMS[problem]
    rows, runs = [], []
    for cell in cells if FULL else cells[:2]:
        both = [verification.run(scene) for scene in (make(cell), in_single(make(cell)))]
        check_audits(verification, f"{problem}, cell {cell:g}", both[1])
        others = [verification.run(disturbed(make(cell), share))
                  for share in ((2**-24, -2**-24) if scatters else ())]
        for name, read, tolerance in figures:
            double, single = (read(run) for run in both)
            doubles = [double] + [read(run) for run in others]
            nearest = min(max(single, min(doubles)), max(doubles))
            verification.relative(f"{problem}, cell {cell:g}: {name}, single against double", single,
                                  nearest, tolerance)
            spread = max(doubles) / min(doubles) - 1 if scatters else math.nan
            rows.append([problem, name, cell, double, single, abs(single / double - 1), math.nan,
                         spread])
        runs.append(both)
    for row, finer in zip(rows, rows[len(figures):]):
        row[6] = abs(row[3] / finer[3] - 1)
    double, single = (numpy.array(run.series[curve]) for run in runs[-1])
    error = numpy.maximum.accumulate(numpy.abs(single - double)) / numpy.abs(double).max()
    return rows, list(zip(numpy.array(runs[-1][0].time) / runs[-1][0].time[-1], error))


def answer_of_check(verification, scene):
    path = verification.new_folder() / "scene.json"
    path.write_text(json.dumps(on_linear_shapes(scene)))
    ended = subprocess.run([worker(), "check", str(path), "--json"],
                           capture_output=True, text=True)
    return ended.returncode, json.loads(ended.stdout)


def check_refusals(verification):
    """What must not run: found by `check`, and by `run` before it makes anything."""
    settling = elastic_column(0.1)
    settling["materials"]["rubber"]["young_modulus"] = 2e11
    settling["duration"] = 1e-3
    ramp = elastic_column(0.1)
    ramp["solver"] = {"stabilise": {"force_ramp": 1000}}
    creep = elastic_column(0.1)
    creep["gravity"] = [0, 0]
    creep["bodies"][0]["velocity"] = [0, 1e-6]
    noise = dam_break(0.0114)
    noise["materials"]["water"]["bulk_modulus"] = 2e13
    noise["duration"] = 60
    for name, scene in (("steel that settles", settling), ("gravity that grows slowly", ramp),
                        ("creep", creep), ("noise", noise)):
        code, answer = answer_of_check(verification, scene)
        verification.equal(f"{name}, double: check", code, 0)
        code, answer = answer_of_check(verification, in_single(scene))
        found = [(error["pointer"], error["code"]) for error in answer["errors"]]
        verification.equal(f"{name}, single: check", found, [("/solver/precision", "precision")])
        folder = verification.new_folder()
        verification.run(in_single(scene), expected_exit=10, folder=folder)
        verification.equal(f"{name}, single: files of a run", list(folder.iterdir()), [])
    stiff = dam_break(0.0114)
    stiff["materials"]["water"]["bulk_modulus"] = 2e9
    stiff["duration"] = 1
    code, answer = answer_of_check(verification, in_single(stiff))
    verification.equal("stiff water, single: check", code, 0)
    verification.equal("stiff water, single: warnings",
                       [warning["code"] for warning in answer["warnings"]], ["precision"])


def check_threads(verification):
    for problem in ("dam break", "impact on a wall"):
        make, cells = PROBLEMS[problem][:2]
        scene = in_single(make(cells[0]))
        one, two = (verification.run(scene, threads=threads, options=("--all-threads",))
                    for threads in (1, 2))
        verification.equal(f"{problem}, single: state hash of 1 and 2 threads",
                           two.receipt["state_hash"], one.receipt["state_hash"])
        verification.equal(f"{problem}, single: history.bin of 1 and 2 threads",
                           two.digest("history.bin"), one.digest("history.bin"))


def check_resume(verification):
    """Interrupted and resumed: the bits of a run that was not; from a checkpoint of the other
    precision: refused."""
    scene = in_single(column_impact(0.25))
    whole = verification.run(scene)
    folders = []
    for wanted in (scene, column_impact(0.25)):
        folder = verification.new_folder()
        folders.append(folder)
        verification.interrupt(wanted, folder, signal.SIGTERM,
                               lambda place: (place / "history.bin").exists() and
                               (place / "history.bin").stat().st_size > 20000)
        verification.above("checkpoint of an interrupted run [bytes]",
                           (folder / "checkpoint.h5").stat().st_size, 0)
    other = verification.new_folder()
    shutil.copytree(folders[0], other, dirs_exist_ok=True)
    resumed = verification.run(scene, folder=folders[0], options=("--resume",))
    verification.equal("resumed in single precision: state hash", resumed.receipt["state_hash"],
                       whole.receipt["state_hash"])
    shutil.copy(folders[1] / "checkpoint.h5", other / "checkpoint.h5")
    path = other.parent / (other.name + ".json")
    path.write_text(json.dumps(on_linear_shapes(scene)))
    ended = subprocess.run(verification.command(path, other, 1, "--resume"), capture_output=True,
                           text=True)
    last = json.loads((other / "events.ndjson").read_text().splitlines()[-1])
    verification.equal("a checkpoint of the other precision: exit code and last event",
                       (ended.returncode, last["event"]), (10, "failed"))
    verification.equal("a checkpoint of the other precision: the reason names the scene",
                       "scene" in last["detail"], True)


def write_figures(rows, curves):
    folder = pathlib.Path(os.environ["TALUS_CHART_FOLDER"])
    with open(folder / "single-precision.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["problem", "figure", "cell", "double", "single", "error of single",
                         "change with half the cell", "spread of double"])
        for row in rows:
            writer.writerow(row[:2] + [f"{value:.8g}" for value in row[2:5]] +
                            ["" if math.isnan(value) else f"{value:.2e}" for value in row[5:]])
    (folder / "single-precision.svg").write_text(draw(rows, curves))


verification = Verification("single-precision")
table, over_time = [], {}
for problem in PROBLEMS:
    rows, over_time[problem] = check_problem(verification, problem)
    table += rows
if os.environ.get("TALUS_CHART_FOLDER"):
    write_figures(table, over_time)
check_refusals(verification)
check_threads(verification)
check_resume(verification)
verification.finish()
