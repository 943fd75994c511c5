# SPDX-License-Identifier: Apache-2.0
"""Deviators averaged over nodes damp what vibrates: a cantilever with the full field of anti-locking
over nodes. Fits over cells keep it. With the deviator over cells and the trace over nodes (`hybrid`;
Mast 2013, sec. 4.3.3) the energy stays too, but not the motion: it is no cure for an elastic solid."""
import math

import numpy

import beam_theory
from bending import Bending
from verification import Verification

MODULI = (70.28e9, 26.23e9)
CELL = 0.5
beam = beam_theory.Beam(*MODULI)


def kept(verification, control, periods):
    """Share of kinetic and strain energy that is left after so many periods."""
    period = 2 * math.pi / beam.timoshenko
    run = verification.run(beam_theory.scene(f"deviators over {control}", "plane_stress", MODULI,
                                             CELL, 2e-5 * CELL, periods * period, "full", 8,
                                             control))
    energy = numpy.array(run.series["energy.kinetic"]) + numpy.array(run.series["energy.strain"])
    return float(energy[-1] / energy[0])


def swing_back(verification, control):
    """How far the tip goes to the other side in the second half of a period, over how far it went in
    the first half."""
    period = 2 * math.pi / beam.timoshenko
    run = verification.run(beam_theory.scene(f"swing with {control}", "plane_stress", MODULI, CELL,
                                             2e-5 * CELL, period, "full", 48, control))
    record = beam_theory.Motion(run)
    tip, first = record.tip()[0], record.time < period / 2
    out = tip[first][numpy.argmax(abs(tip[first]))]
    return float((-tip[~first] / out).max())


def motion(verification, control):
    return Bending(verification, f"motion with {control}", "plane_stress", MODULI, CELL,
                   {"control": control, "field": "full"})


verification = Verification("averaged-deviator")
# Half a period is enough; an amplitude that falls by 20 % takes 36 % of the energy.
verification.below("node: energy left after half a period", kept(verification, "node", 0.5), 0.64)
verification.below("node: swing back in the second half of a period, over the first",
                   swing_back(verification, "node"), 0.8)
verification.above("cell: the same", swing_back(verification, "cell"), 0.95)
for control in ("cell", "hybrid"):
    verification.above(f"{control}: energy left after a period", kept(verification, control, 1.0),
                       0.95)
# Two cells over the depth: four times the tolerances that hold in cells of half the size.
whole = motion(verification, "cell")
verification.absolute("cell: amplitude over that of beam theory", whole.amplitude, 1.0, 0.12)
verification.absolute("cell: period over that of Timoshenko's beam", whole.period, 1.0, 0.08)
# The failure of means over nodes is 20 % of the amplitude within a period: hybrid has it as well.
worn = motion(verification, "hybrid")
verification.above("hybrid: |amplitude over that of beam theory - 1|", abs(worn.amplitude - 1), 0.2)
verification.above("hybrid: |period over that of Timoshenko's beam - 1|", abs(worn.period - 1), 0.2)
verification.finish()
