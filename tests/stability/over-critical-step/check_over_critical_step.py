# SPDX-License-Identifier: Apache-2.0
"""Sand at rest, stepped beyond the limit of its method: rounding-size noise grows by orders of
magnitude in a few steps. The step that Mast 2013 prints for the sand column (sec. 7.2.1) is one."""
import random

from verification import Verification, particle_bodies

CELL, PER_CELL, CELLS = 0.005, 4, 4
BULK, SHEAR, DENSITY = 29.5e6, 13.6e6, 2200.0
STEPS = 50


def scene(update, time_step):
    """A block between walls under uniform pressure, which is at rest to the last bit; its energy lets
    the noise grow unseen by the check of the energy."""
    source, size, side = random.Random(1), CELL / PER_CELL, CELLS * CELL
    centres = [[(i + 0.5) * size, (j + 0.5) * size]
               for i in range(CELLS * PER_CELL) for j in range(CELLS * PER_CELL)]
    bodies = particle_bodies(centres, [size, size], "sand",
                             lambda c: [source.uniform(-1e-9, 1e-9) for _ in range(2)])
    for body in bodies:
        body["initial_stress"] = [-1e3, -1e3, -1e3, 0, 0, 0]
    walls = [("left", [0, 0], [1, 0]), ("right", [side, 0], [-1, 0]), ("floor", [0, 0], [0, 1]),
             ("lid", [0, side], [0, -1])]
    return {
        "title": f"sand at rest, {update}, dt = {time_step:g} s",
        "dimension": "plane_strain", "duration": STEPS * time_step,
        "grid": {"cell": CELL, "min": [0, 0], "max": [side, side]},
        "solver": {"stress_update": update, "time_step": time_step, "allow_unstable": True},
        "materials": {"sand": {"model": "linear_elastic", "density": DENSITY,
                               "bulk_modulus": BULK, "shear_modulus": SHEAR}},
        "bodies": bodies,
        "boundaries": [{"name": name, "plane": {"point": point, "normal": normal},
                        "condition": "slip"} for name, point, normal in walls],
        "output": {"frames": {"every": 0}, "history": {"every": time_step}},
    }


def growth(verification, update, time_step, expected_exit=0):
    """Of the kinetic energy: largest over the first, and last over the last but one."""
    run = verification.run(scene(update, time_step), expected_exit=expected_exit)
    kinetic = run.series["energy.kinetic"]
    return max(kinetic) / kinetic[0], kinetic[-1] / kinetic[-2]


verification = Verification("over-critical-step")
# Of all waves of a large body the one that grows fastest does so by 7.6 and 2.5 a step; a block of four
# cells has four standing waves an axis, of which none need be that one.
FASTEST = {"last": 7.6, "modified_last": 2.5, "first": 2.5}
for update, time_step in (("last", 5e-5), ("modified_last", 6e-5), ("first", 6e-5)):
    whole, per_step = growth(verification, update, time_step, expected_exit=11)
    verification.above(f"{update}, dt = {time_step:g} s: kinetic energy grows within 50 steps", whole,
                       1e6)
    verification.between(f"{update}, dt = {time_step:g} s: growth in the last step", per_step,
                         FASTEST[update] ** 2 / 2, FASTEST[update] ** 2)
for update in ("modified_last", "first"):
    verification.below(f"{update}, dt = 5e-05 s, the printed step: the same",
                       growth(verification, update, 5e-5)[0], 100)
for update in ("last", "modified_last", "first"):
    verification.below(f"{update}, dt = 1e-05 s: the same", growth(verification, update, 1e-5)[0],
                       1.5)
verification.finish()
