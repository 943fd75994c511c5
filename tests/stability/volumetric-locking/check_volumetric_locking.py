# SPDX-License-Identifier: Apache-2.0
"""A nearly incompressible beam (nu = 0.49, plane strain) without anti-locking is too stiff: short
period and small amplitude (Mast 2013, sec. 6.2.1)."""
from bending import Bending
from verification import FULL, Verification

MODULI = (1170e9, 23.5e9)
CELL = 0.125 if FULL else 0.25

verification = Verification("volumetric-locking")
plain = Bending(verification, "nu = 0.49, no anti-locking", "plane_strain", MODULI, CELL)
verification.below("none: period over that of Timoshenko's beam", plain.period, 0.9)
verification.below("none: amplitude over that of beam theory", plain.amplitude, 0.9)
for field in ("full_constant_volume", "volumetric"):
    cured = Bending(verification, f"nu = 0.49, {field}", "plane_strain", MODULI, CELL,
                    {"control": "cell", "field": field})
    verification.absolute(f"cell, {field}: period", cured.period, 1.0, 0.03)
    verification.absolute(f"cell, {field}: amplitude", cured.amplitude, 1.0, 0.05)
verification.finish()
