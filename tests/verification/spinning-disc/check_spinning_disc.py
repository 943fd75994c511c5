# SPDX-License-Identifier: Apache-2.0
"""An elastic disc that spins freely for two turns: what each transfer does to its angular momentum
and energy, with each stress update, with hat functions and quadratic splines."""
import math

from verification import FULL, Verification, particle_bodies

RADIUS, CELL, DENSITY, YOUNG = 0.5, 0.1, 1000.0, 1e6
RATE = 2 * math.pi  # one turn a second; the rim moves at a tenth of the wave speed
TURNS = 3 if FULL else 2
SPACING, CENTRE = CELL / 2, (1.013, 0.987)
ORDERINGS = ("modified_last", "first", "last")


def scene(shape, transfer, update):
    half = round(RADIUS / SPACING)
    points = [(CENTRE[0] + (i + 0.5) * SPACING, CENTRE[1] + (j + 0.5) * SPACING)
              for i in range(-half, half) for j in range(-half, half)
              if math.hypot((i + 0.5) * SPACING, (j + 0.5) * SPACING) <= RADIUS]
    return {
        "title": f"spinning disc, {shape}, {transfer}, {update}",
        "dimension": "plane_strain", "duration": TURNS * 2 * math.pi / RATE,
        "grid": {"cell": CELL, "min": [0, 0], "max": [2, 2]},
        "solver": {"shape": shape, "transfer": transfer, "stress_update": update, "courant": 0.2},
        "materials": {"rubber": {"model": "linear_elastic", "density": DENSITY,
                                 "young_modulus": YOUNG, "poisson_ratio": 0.3}},
        "bodies": particle_bodies(points, [SPACING] * 2, "rubber",
                                  lambda c: [-RATE * (c[1] - CENTRE[1]), RATE * (c[0] - CENTRE[0])]),
        # What the methods gain is measured here, not refused.
        "audits": {"energy_growth": 1.0},
        "output": {"history": {"every": 0.01},
                   "frames": {"every": 0, "fields": ["velocity", "mass"], "precision": "double"}},
    }


def angular_momentum(frame):
    """About the centre, which stays where it is."""
    mass, position, velocity = frame["mass"].reshape(-1), frame["position"], frame["velocity"]
    return float((mass * ((position[:, 0] - CENTRE[0]) * velocity[:, 1]
                          - (position[:, 1] - CENTRE[1]) * velocity[:, 0])).sum())


def measure(verification, shape, transfer, update):
    """Angular momentum lost in a turn, and energy lost, both as shares."""
    run = verification.run(scene(shape, transfer, update))
    kept = angular_momentum(run.frame(-1)) / angular_momentum(run.frame(0))
    start = run.series["energy.kinetic"][0]
    lost = run.series["energy.numerical"][-1] / start
    turn = 1 - max(kept, 1e-9)**(1 / TURNS)
    print(f"  | {shape} | {transfer} | {update} | {100 * turn:.2g} % | {100 * lost:.2g} % |")
    return turn, lost


verification = Verification("spinning-disc")
for shape, transfer, updates in (("linear", "flip", ORDERINGS[:2]), ("linear", "pic", ORDERINGS[:2]),
                                 ("bspline2", "flip", ORDERINGS), ("bspline2", "pic", ORDERINGS),
                                 ("bspline2", "apic", ORDERINGS)):
    for update in updates:
        turn, lost = measure(verification, shape, transfer, update)
        name = f"{shape}, {transfer}, {update}"
        if transfer == "pic":
            verification.above(f"{name}: angular momentum lost in a turn", turn, 0.5)
            continue
        if transfer == "apic":
            verification.below(f"{name}: angular momentum lost in a turn", abs(turn), 0.02)
        else:
            verification.deviation(f"{name}: angular momentum lost in a turn", abs(turn), 0.02, 0.10)
        # `first` strains with the velocity of the start, which a rotation has left behind at the end;
        # `last` strains with waves that no particle carries, and damps them.
        if update == "modified_last" or (transfer, update) == ("apic", "last"):
            verification.below(f"{name}: energy lost or gained", abs(lost), 0.05)
        else:
            verification.deviation(f"{name}: energy lost or gained", abs(lost), 0.05, 0.25)
verification.finish()
