#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Adds up the rows that checks wrote to TALUS_VERIFICATION_TABLE: one row a problem.

    verification_totals.py FILE
"""
import pathlib
import sys

from verification import PROCESSOR_TIME


def totals(lines):
    """problem -> [comparisons, known misses, failed, processor seconds], in the order of the file"""
    found = {}
    for line in lines:
        cells = [cell.strip() for cell in line.strip().strip("|").split(" | ")]
        if len(cells) != 6 or cells[0] in ("problem", "---"):
            continue
        problem, quantity, _, value, _, verdict = cells
        counts = found.setdefault(problem, [0, 0, 0, 0.0])
        if quantity == PROCESSOR_TIME:
            counts[3] += float(value)
        else:
            counts[0] += verdict != "note"
            counts[1] += verdict == "misses"
            counts[2] += verdict == "FAILED"
    return found


def main():
    found = totals(pathlib.Path(sys.argv[1]).read_text().splitlines())
    found["all"] = [sum(column) for column in zip(*found.values())]
    print("| problem | comparisons | known misses | failed | processor minutes |\n"
          "| --- | --- | --- | --- | --- |")
    for problem, (comparisons, missed, failed, seconds) in found.items():
        print(f"| {problem} | {comparisons} | {missed} | {failed} | {seconds / 60:.1f} |")


if __name__ == "__main__":
    main()
