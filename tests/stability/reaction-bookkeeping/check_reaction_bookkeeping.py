# SPDX-License-Identifier: Apache-2.0
"""An elastic block that hits a wall: what is recorded as the impulse on the wall is the momentum that
the block lost only if velocities and reaction come from the same rule."""
import numpy as np
from small_mpm import SmallMpm
from verification import FULL, Verification

CELL, DENSITY, YOUNG, POISSON = 0.1, 1000.0, 1e6, 0.2
STEP, DURATION = 5e-4, (0.2 if FULL else 0.1)
LOW, HIGH = (0.0, 0.4), (0.4, 0.8)  # at the wall at x = 0
SPEED = 1.0


def mixed_rule(velocity, force, mass, step):
    """The velocity at the wall is taken away at once, but only the force is recorded."""
    after = velocity + step * force / np.maximum(mass, 1e-300)[:, None]
    after[:, 0] = 0.0
    return after, np.array([-(force[:, 0] * step).sum(), 0.0])


def consistent_rule(velocity, force, mass, step):
    after, recorded = mixed_rule(velocity, force, mass, step)
    recorded[0] -= (mass * velocity[:, 0]).sum()
    return after, recorded


def hold(velocity):
    velocity[:, 0] = 0.0
    return velocity


def small_program(rule):
    """Impulse recorded, and change of momentum."""
    mpm = SmallMpm(CELL, 20, 12, DENSITY, YOUNG, POISSON, (0, 0))
    mpm.fill(LOW, HIGH, 2, (-SPEED, 0))
    mpm.rules = [(np.array([mpm.node(0, row) for row in range(13)]), rule, hold)]
    before = mpm.momentum[0]
    for _ in range(round(DURATION / STEP)):
        mpm.step(STEP)
    return mpm.recorded[0], mpm.momentum[0] - before


def talus_scene(wall):
    return {
        "title": f"block against a wall that {wall}s", "dimension": "plane_strain",
        "duration": DURATION, "grid": {"cell": CELL, "min": [0, 0], "max": [2, 1.2]},
        "solver": {"time_step": STEP, "strain": "small"},
        "materials": {"rubber": {"model": "linear_elastic", "density": DENSITY,
                                 "young_modulus": YOUNG, "poisson_ratio": POISSON}},
        "bodies": [{"material": "rubber", "box": {"min": LOW, "max": HIGH},
                    "particles_per_cell": [2, 2], "velocity": [-SPEED, 0]}],
        "boundaries": [{"name": "wall", "plane": {"point": [0, 0], "normal": [1, 0]},
                        "condition": "slip", "wall": wall}],
        "output": {"history": {"every": 0.003},
                   "frames": {"every": 1, "fields": ["velocity", "mass"], "precision": "double"}},
    }


def momentum(frame):
    return float((frame["mass"].reshape(-1) * frame["velocity"][:, 0]).sum())


verification = Verification("reaction-bookkeeping")
recorded, change = small_program(mixed_rule)
verification.above("mixed rules: impulse that is not recorded, over the change of momentum",
                   abs(recorded - change) / abs(change), 0.01)
recorded, change = small_program(consistent_rule)
verification.relative("one rule, in the same small program: impulse recorded [N s]", recorded, change,
                      1e-9)
for wall in ("stop", "keep"):
    run = verification.run(talus_scene(wall))
    change = momentum(run.frame(-1)) - momentum(run.frame(0))
    verification.relative(f"Talus, wall {wall}: impulse recorded [N s]", -run.impulse("wall", "x"),
                          change, 1e-9)
verification.finish()
