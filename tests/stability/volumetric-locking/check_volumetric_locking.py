# SPDX-License-Identifier: Apache-2.0
"""A nearly incompressible beam (nu = 0.49, plane strain) without anti-locking is too stiff: short
period and small amplitude (Mast 2013, sec. 6.2.1)."""
from bending import Bending
from verification import FULL, Verification

MODULI = (1170e9, 23.5e9)
CELL = 0.25  # four over the depth
FIELDS = ("full_constant_volume", "volumetric")


def bend(cell, field=None):
    anti_locking = {"control": "cell", "field": field} if field else None
    return Bending(verification, f"nu = 0.49, {field or 'no anti-locking'}, cells of {cell}",
                   "plane_strain", MODULI, cell, anti_locking)


verification = Verification("volumetric-locking")
plain = bend(CELL)
verification.below("none: period over that of Timoshenko's beam", plain.period, 0.9)
verification.below("none: amplitude over that of beam theory", plain.amplitude, 0.9)
for cell in ((CELL, CELL / 2) if FULL else (CELL,)):
    for field in FIELDS:
        cured = bend(cell, field)
        verification.absolute(f"cell, {field}, cells of {cell}: period", cured.period, 1.0, 0.03)
        verification.absolute(f"cell, {field}, cells of {cell}: amplitude", cured.amplitude, 1.0, 0.05)
if FULL:
    # What is too stiff goes with the square of the cells: a quarter of it is left, give or take half.
    finer = bend(CELL / 2)
    verification.between("none, cells half as wide: what the period is too short by, over that before",
                         (1 - finer.period) / (1 - plain.period), 0.125, 0.5)
verification.finish()
