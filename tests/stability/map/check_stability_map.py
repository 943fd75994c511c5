# SPDX-License-Identifier: Apache-2.0
"""Some forty entries of the stability map, found again: each within twice the resolution of the
bisection of what the map says (the same bodies, the same steps; other builds round differently)."""
import csv
import os
import pathlib
import sys

import stability_map
from verification import Verification

MAP = pathlib.Path(__file__).resolve().parents[3] / "docs" / "stability" / "stability-map.csv"
TOLERANCE = 2 * stability_map.RESOLUTION
SPREAD = 9  # every ninth method of the map, with one body each: 42 of 378


def main():
    stability_map.local_program.append(os.environ["TALUS_STABILITY_PROBE"])
    verification = Verification("stability map")
    with open(MAP, newline="") as file:
        known = {tuple(row[key] for key in stability_map.COLUMNS[:4]): row
                 for row in csv.DictReader(file)}
    entries = [entry for family in stability_map.methods() for entry in family]
    for number, (name, method) in enumerate(entries[::SPREAD]):
        body = stability_map.BODIES[number % len(stability_map.BODIES)]
        expected = float(known[name][body])
        found = stability_map.largest_courant(method, body, hint=expected)
        verification.relative(f"{', '.join(name)}, {body}", found, expected, TOLERANCE)
    verification.finish()


if __name__ == "__main__":
    sys.exit(main())
