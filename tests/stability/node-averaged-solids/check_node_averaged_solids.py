# SPDX-License-Identifier: Apache-2.0
"""Means over nodes, taken again in every step, carry strain through an elastic beam until it holds no
more: its amplitude is wrong by more than 20 % within one period (Mast 2013, sec. 4.4.2, warns of the
deviatoric part). Fits over cells do not: doing them twice changes nothing."""
from bending import Bending
from verification import FULL, Verification

MODULI = (70.28e9, 26.23e9)
CELL = 0.125 if FULL else 0.25

verification = Verification("node-averaged-solids")
for control, field in (("node", "full_constant_volume"), ("node", "volumetric"), ("hybrid", "full")):
    worn = Bending(verification, f"{control}, {field}", "plane_stress", MODULI, CELL,
                   {"control": control, "field": field})
    verification.above(f"{control}, {field}: |amplitude over that of beam theory - 1|",
                       abs(worn.amplitude - 1), 0.2)
whole = Bending(verification, "cell, full", "plane_stress", MODULI, CELL,
                {"control": "cell", "field": "full"})
verification.absolute("cell, full: amplitude over that of beam theory", whole.amplitude, 1.0, 0.03)
verification.absolute("cell, full: period over that of Timoshenko's beam", whole.period, 1.0, 0.02)
verification.finish()
