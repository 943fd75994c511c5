# SPDX-License-Identifier: Apache-2.0
"""Some fifty entries of the stability map, and with TALUS_FULL=1 all of them, found again: each within
twice the resolution of the bisection of what the map says (the same bodies, the same steps; other
builds round differently), or refused as the map says."""
import concurrent.futures
import csv
import os
import pathlib
import sys

import stability_map
from verification import FULL, Verification

MAP = pathlib.Path(__file__).resolve().parents[3] / "docs" / "stability" / "stability-map.csv"
TOLERANCE = 2 * stability_map.RESOLUTION
SPREAD = 9  # every ninth method of the map, with one body each: 48 of 432


def entries():
    """(name, method, bodies)"""
    every = [entry for family in stability_map.methods() for entry in family]
    if FULL:
        return [(name, method, stability_map.BODIES) for name, method in every]
    return [(name, method, [stability_map.BODIES[number % len(stability_map.BODIES)]])
            for number, (name, method) in enumerate(every[::SPREAD])]


def search(entry, known):
    """[(body, found or REFUSED)]"""
    name, method, bodies = entry
    found = []
    for body in bodies:
        expected = known[name][body]
        hint = None if expected == stability_map.REFUSED else float(expected)
        try:
            found.append((body, stability_map.largest_courant(method, body, hint=hint)))
        except stability_map.Refused:
            found.append((body, stability_map.REFUSED))
    return found


def main():
    stability_map.local_program.append(os.environ["TALUS_STABILITY_PROBE"])
    verification = Verification("stability map")
    with open(MAP, newline="") as file:
        known = {tuple(row[key] for key in stability_map.COLUMNS[:4]): row
                 for row in csv.DictReader(file)}
    wanted = entries()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() if FULL else 1) as pool:
        results = pool.map(lambda entry: search(entry, known), wanted)
        for (name, _, _), result in zip(wanted, results):
            for body, found in result:
                label, expected = f"{', '.join(name)}, {body}", known[name][body]
                if stability_map.REFUSED in (expected, found):
                    verification.equal(label, found, expected)
                else:
                    verification.relative(label, found, float(expected), TOLERANCE)
    verification.finish()


if __name__ == "__main__":
    sys.exit(main())
