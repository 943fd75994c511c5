# SPDX-License-Identifier: Apache-2.0
"""Observed order of convergence of every shape function and transfer on two manufactured solutions
through whose motion particles cross cells; README.md has the solutions and what to expect."""
import json
import math
import subprocess

import manufactured
from verification import FULL, Verification, worker

CELLS = {"axis-aligned": (8, 16, 32, 64) if FULL else (8, 16, 32),
         "vortex": (24, 48, 96) if FULL else (24, 48)}
# Second order is what hat functions and splines have in space. It is asked of the functions that
# follow the deformation, or are smooth enough that crossings do not show at these sizes; the others
# saturate, and must converge at all. Linear functions must not: that is why the others exist.
LEAST_ORDER = {"cpdi": 1.8, "bspline3": 1.8, "gimp_scaled": 1.5, "bspline2": 1.0, "gimp": 1.0,
               "cpdi_hybrid": 1.0}


def words(key):
    """The choices of a key of `solver` that this build offers."""
    described = json.loads(subprocess.run([worker(), "describe", "--json"], capture_output=True,
                                          text=True, check=True).stdout)
    return next(field["choices"] for field in described["solver"] if field["key"] == key)


def errors(problem, method):
    found = []
    for cells in CELLS[problem]:
        try:
            found.append(manufactured.solve(problem, cells, method)["rms"])
        except manufactured.Unstable:
            found.append(math.inf)
    return found


def order(problem, found, first=0, last=-1):
    cells = CELLS[problem]
    if not math.isfinite(found[last]) or not math.isfinite(found[first]):
        return -math.inf
    return math.log(found[first] / found[last]) / math.log(cells[last] / cells[first])


def check(verification, problem, shape, transfer):
    method = {"shape": shape, "transfer": transfer}
    if shape == "linear" and transfer == "apic":
        method["allow_unstable"] = True
    try:
        found = errors(problem, method)
    except manufactured.Refused as refusal:
        print(f"  {problem}, {shape}, {transfer}: refused, {str(refusal).strip()[:120]}")
        return
    listed = ", ".join(f"{value:.3g}" for value in found)
    label = f"{problem}, {shape}, {transfer} ({listed})"
    reached = order(problem, found, 0, 2) if problem == "axis-aligned" else order(problem, found, 0, 1)
    if problem == "axis-aligned" and transfer == "flip" and shape in LEAST_ORDER:
        verification.above(f"{label}: order", reached, LEAST_ORDER[shape])
    elif problem == "axis-aligned" and transfer == "flip" and shape == "linear":
        verification.below(f"{label}: order", reached, 0.5)
    else:
        verification.note(f"{label}: order", reached, "reported")


def main():
    verification = Verification("manufactured")
    for problem in CELLS:
        for shape in words("shape"):
            for transfer in words("transfer"):
                check(verification, problem, shape, transfer)
    verification.finish()


if __name__ == "__main__":
    main()
