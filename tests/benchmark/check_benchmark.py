# SPDX-License-Identifier: Apache-2.0
"""talus-benchmark in its smallest form: that every case runs, that the bodies do strain and yield,
and that the results file and the table are complete. Speeds are not looked at."""
import csv
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

PROGRAM = os.environ["TALUS_BENCHMARK"]
PRECISION = sys.argv[1]
MASS_ERROR = {"double": 1e-12, "single": 1e-6}[PRECISION]  # what audits let pass
SOURCE = (pathlib.Path(__file__).parent / "benchmark_case.c").read_text()
SETS = {"ordering", "size", "density", "anti_locking", "domain", "small", "flow"}
# Case -> whether it must yield, out of the program's own table.
CASES = {name: yields == "true" for name, yields in
         re.findall(r'^    \{"(\w+)", [23], .*, [23], (true|false), (?:true|false)\},$', SOURCE, re.M)}
problems = []


def expect(holds, text):
    if not holds:
        problems.append(text)


def label(row):
    return " ".join(row[key] for key in ("set", "case", "body", "ordering", "anti_locking",
                                         "threads", "particles", "domain_factor"))


def numbers(row):
    words = ("set", "case", "body", "ordering", "anti_locking", "shape", "transfer")
    return {key: float(value) for key, value in row.items() if key not in words}


def check_row(row, value):
    name = label(row)
    if math.isnan(value["rate"]):
        expect(False, f"{name}: no rate")
        return
    expect(value["mass_error"] <= MASS_ERROR, f"{name}: mass error {value['mass_error']}")
    expect(0 < value["rate_low"] <= value["rate"] <= value["rate_high"] <= value["rate_best"],
           f"{name}: rates are out of order")
    expect(value["rate_wall"] > 0 and value["simulated"] > 0, f"{name}: no time has passed")
    expect(0 < value["lane_fill"] <= 1, f"{name}: lane fill {value['lane_fill']}")
    expect(0 <= value["crossings"] < 1, f"{name}: crossings {value['crossings']}")
    expect(0 < value["bytes_stored"] <= value["bytes_grid"] <= value["bytes_all"], f"{name}: bytes")
    expect(value["peak"] > 0 and value["bandwidth"] > 0, f"{name}: no ceilings")
    if row["ordering"] == "last":
        expect(value["ns_first_pass"] == value["ns_kick_nodes"] == 0, f"{name}: a first pass")
    # The stable step of `last` is so short that a few hundred particles may cross nothing in a row.
    if row["set"] == "flow" and row["ordering"] != "last":
        expect(value["crossings"] > 0, f"{name}: a flow without crossings")
    yields = CASES[row["case"]]
    expect((value["dissipation"] > 0) == (yields or "fluid" in row["case"]),
           f"{name}: dissipation {value['dissipation']}")
    if row["set"] == "ordering" and row["threads"] == "1":
        expect(value["strain"] > 1e-5, f"{name}: at rest, strain of a step {value['strain']}")
        expect(value["plastic"] > 0.3 if yields else value["plastic"] == 0,
               f"{name}: {value['plastic']} of it yields")


def check_complete(rows):
    expect({row["set"] for row in rows} == SETS, "a set is missing")
    for name in CASES:
        for ordering in ("last", "modified_last"):
            for body, which in (("compact", "ordering"), ("flow", "flow")):
                expect(any(row["case"] == name and row["ordering"] == ordering and
                           row["body"] == body and row["set"] == which for row in rows),
                       f"{name}, {ordering}, {body}: missing")


def check_crossings_of_last(rows):
    flows = [row for row in rows if row["set"] == "flow" and row["ordering"] == "last"]
    expect(sum(float(row["crossings"]) for row in flows) > 0, "no flow of `last` has crossings")


def check_stages(rows):
    """Each stage takes time in some rows of each case; in one row of some microseconds another
    program may take more than there is."""
    for case in CASES:
        for stage in ("kick_nodes", "first_pass", "update_nodes", "gather", "kinematics", "material",
                      "scatter", "energy_check"):
            expect(any(float(row["ns_" + stage]) > 0 for row in rows if row["case"] == case),
                   f"{case}: no time in {stage}")


def check_equal_physics(rows):
    """Neither threads nor an empty grid change what happens."""
    for which, key in (("ordering", "threads"), ("domain", "domain_factor")):
        for row in rows:
            same = [other for other in rows if other["set"] == row["set"] == which and
                    all(other[word] == row[word] for word in ("case", "ordering", "particles"))]
            if row["set"] != which:
                continue
            expect(len({other[key] for other in same}) == len(same), f"{label(row)}: twice")
            expect(len({other["dissipation"] for other in same}) == 1,
                   f"{label(row)}: {key} changes the dissipation")


def check_header(comments):
    for word in ("processor: ", "build: ", "instruction set: ", PRECISION + " precision", "peak, double", "peak, float",
                 "triad", "in place"):
        expect(any(word in line for line in comments), f"header: no {word}")
    for word in ("two threads", "cell anti-locking costs", "a grid of 10000 times",
                 "two threads pay from", "choosing the step", "per cell and axis cost",
                 "particles cost", "simulated seconds per second"):
        expect(any(word in line for line in comments) or
               ("thread" in word and os.cpu_count() == 1), f"no finding about: {word}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "results.csv"
        run = subprocess.run([PROGRAM, "--smoke", "--precision", PRECISION, "--csv", path], capture_output=True, text=True)
        expect(run.returncode == 0, f"exit {run.returncode}: {run.stderr[-2000:]}")
        text = path.read_text().splitlines(True) if path.exists() else []
    rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
    expect(len(CASES) == 8, f"{len(CASES)} cases in the source")
    check_header([line for line in text if line.startswith("#")])
    check_complete(rows)
    for row in rows:
        check_row(row, numbers(row))
    check_crossings_of_last(rows)
    check_stages(rows)
    check_equal_physics(rows)
    lines = [line for line in run.stdout.splitlines() if line.split(" ")[0] in SETS]
    expect(len(lines) >= 2 * len(rows), "the tables have fewer lines than the file")
    for problem in problems:
        print(problem)
    print(f"{len(rows)} rows, {len(problems)} problems")
    return 1 if problems else 0


sys.exit(main())
