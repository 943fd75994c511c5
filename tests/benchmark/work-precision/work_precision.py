#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Accuracy against cost: every method at every resolution of every problem, as a CSV and as charts.

    work_precision.py --programs build/release/bin --out docs/work-precision [--only TEXT] [--short]
    work_precision.py --draw --out docs/work-precision      only the charts, from the CSV

--short takes the two coarsest resolutions, to see that everything runs.
"""
import argparse
import csv
import os
import pathlib
import sys

COLUMNS = ["problem", "method", "resolution", "error", "particle_steps", "seconds", "remark"]


def measure(arguments):
    os.environ["TALUS_WORKER"] = str(arguments.programs / "talus-worker")
    os.environ["TALUS_MANUFACTURED"] = str(arguments.programs / "talus-manufactured")
    from methods import METHODS
    from problems import PROBLEMS, Failed, Refused, takes
    arguments.out.mkdir(parents=True, exist_ok=True)
    with open(arguments.out / "work-precision.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for problem in PROBLEMS:
            for label, method in METHODS.items():
                if arguments.only not in f"{problem.name}: {label}" or not takes(problem, label):
                    continue
                for resolution in problem.resolutions[:2 if arguments.short else None]:
                    row = [problem.name, label, resolution]
                    try:
                        found = problem.solve(resolution, method)
                        row += [f"{found['error']:.6g}", f"{found['particle_steps']:.6g}",
                                f"{found['seconds']:.4g}", ""]
                    except Refused as refusal:
                        row += ["", "", "", f"refused: {refusal}"]
                    except Failed as failure:
                        row += ["", "", "", f"failed: {failure}".rstrip()]
                    writer.writerow(row)
                    file.flush()
                    print(*row, file=sys.stderr, flush=True)
                    if row[-1].startswith("refused"):
                        break


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--only", default="", help="'PROBLEM: METHOD' must hold this text")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--draw", action="store_true", help="draw the charts only")
    arguments = parser.parse_args()
    if not arguments.draw:
        measure(arguments)
    if arguments.draw or not arguments.short:
        from charts import draw_all
        draw_all(arguments.out)


if __name__ == "__main__":
    main()
