# SPDX-License-Identifier: Apache-2.0
"""Quadratic elements over a cell that is half full: the lumped mass of a corner is negative, and it
would move against its forces."""
import re

from verification import Verification, log_tail

CELL = 0.1


def lower_corner(xi):
    return xi * (xi - 1) / 2


def scene(shape):
    return {
        "title": f"half a cell, {shape}", "dimension": "line", "duration": 0.01,
        "grid": {"cell": CELL, "min": [0], "max": [1]}, "solver": {"shape": shape},
        "materials": {"steel": {"model": "linear_elastic", "density": 1000, "young_modulus": 1e6,
                                "poisson_ratio": 0}},
        "bodies": [{"material": "steel", "box": {"min": [3.5 * CELL], "max": [4 * CELL]},
                    "count": [2], "velocity": [1.0]}],
    }


verification = Verification("negative-lumped-mass")
# The upper half of the element -1 < xi < 1 is full: particles at xi = 1/4 and 3/4.
share = (lower_corner(0.25) + lower_corner(0.75)) / 2
verification.relative("share of the corner in the mass of the cell", share, -0.094, 0.005)

run = verification.run(scene("quadratic"), expected_exit=10)
messages = log_tail(run.folder)
found = re.search(r"node at \(0\.3, 0, 0\) has (\S+) times the mass of the lightest particle",
                  messages)
verification.equal("refused, with the node and its mass", found is not None, True)
verification.equal("refused, with another shape to take", '"bspline2"' in messages, True)
if found:
    # Three digits are written, of two particles of the same mass.
    verification.relative("mass that the message gives, over that of the cell",
                          float(found.group(1)) / 2, share, 0.005)
for shape in ("bspline2", "bspline3"):
    verification.equal(f"{shape}: runs", verification.run(scene(shape)).metrics["steps"] > 0, True)
verification.finish()
