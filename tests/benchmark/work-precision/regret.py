#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which shape is the default: what each costs where another would have been better, from the CSV.

    regret.py [work-precision.csv] [--floor ERROR]

Methods are the shapes alone: flip, modified_last, no anti-locking. The regret of a shape in a problem
is its error over the least error of any shape at equal processor time, the geometric mean over the
times that all candidates span (error log-log between resolutions); the default is the candidate whose
worst regret is least. A candidate has come to its end in every run of every problem, and its cheapest
takes no longer than the dearest of every other shape that has: else there is no equal time. --floor
counts errors below ERROR as ERROR, to see whether digits that no scene needs decide.
"""
import argparse
import csv
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
TABLE = ROOT / "docs" / "work-precision" / "work-precision.csv"
TIMES = 50


def read(path):
    """({problem: {shape: [(log seconds, log error)] by seconds}}, shapes that failed or were refused)."""
    runs, failed = {}, {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if "," in row["method"]:
                continue
            if not row["error"]:
                failed.setdefault(row["method"], {})[row["problem"]] = row["remark"]
                continue
            runs.setdefault(row["problem"], {}).setdefault(row["method"], []).append(
                (math.log(float(row["seconds"])), math.log(float(row["error"]))))
    for methods in runs.values():
        for points in methods.values():
            points.sort()
    return runs, failed


def too_dear(runs, shapes):
    """{shape: problem} of the shapes whose cheapest run begins where another's dearest has ended."""
    found = {}
    for problem, methods in runs.items():
        ends = min(methods[shape][-1][0] for shape in shapes)
        found.update({shape: problem for shape in shapes if methods[shape][0][0] > ends})
    return found


def error_at(points, time):
    """Log error by lines between the runs; None outside of them."""
    for (before, low), (after, high) in zip(points, points[1:]):
        if before <= time <= after:
            return low + (high - low) * (time - before) / max(after - before, 1e-12)
    return None


def regrets(methods, candidates, floor):
    """{shape: regret} of one problem, and the span of times [s] it is of."""
    first = max(methods[shape][0][0] for shape in candidates)
    last = min(methods[shape][-1][0] for shape in candidates)
    found = {shape: 0.0 for shape in candidates}
    for k in range(TIMES):
        time = first + (last - first) * k / (TIMES - 1)
        errors = {shape: error_at(points, time) for shape, points in methods.items()}
        errors = {shape: max(error, floor) for shape, error in errors.items() if error is not None}
        best = min(errors.values())
        for shape in candidates:
            found[shape] += (errors[shape] - best) / TIMES
    return {shape: math.exp(value) for shape, value in found.items()}, math.exp(first), math.exp(last)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path, nargs="?", default=TABLE)
    parser.add_argument("--floor", type=float, default=0.0)
    arguments = parser.parse_args()
    runs, failed = read(arguments.table)
    shapes = sorted(set().union(*runs.values()))
    candidates = [shape for shape in shapes if shape not in failed]
    for shape in sorted(failed):
        print(f"{shape}: no candidate, fails in {', '.join(failed[shape])}")
    dear = too_dear(runs, candidates)
    for shape, problem in sorted(dear.items()):
        print(f"{shape}: no candidate, its cheapest run takes longer than others' dearest in {problem}")
    candidates = [shape for shape in candidates if shape not in dear]
    floor = math.log(arguments.floor) if arguments.floor > 0 else -math.inf
    worst = {shape: 0.0 for shape in candidates}
    print(f"{'problem':28}{'times [s]':>14} " + "".join(f"{shape:>13}" for shape in candidates))
    for problem, methods in runs.items():
        found, first, last = regrets(methods, candidates, floor)
        span = f"{first:.2g} to {last:.2g}"
        print(f"{problem:28}{span:>14} " + "".join(f"{found[s]:13.2f}" for s in candidates))
        worst = {shape: max(worst[shape], found[shape]) for shape in candidates}
    print(f"{'worst':43}" + "".join(f"{worst[shape]:13.2f}" for shape in candidates))
    print(f"least worst regret: {min(worst, key=worst.get)}")


if __name__ == "__main__":
    main()
