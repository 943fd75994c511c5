# SPDX-License-Identifier: Apache-2.0
"""A column at rest between smooth walls, of a soil too weak for the k0 it is given: the lateral stress
and the forces on the walls jump to the active state. `auto` starts in it."""
import json
import math
from verification import FULL, Verification

FRICTION = 5.0  # degrees
K0 = 0.429
ACTIVE = (1 - math.sin(math.radians(FRICTION))) / (1 + math.sin(math.radians(FRICTION)))
CELL, HEIGHT, WIDTH = (0.1 if FULL else 0.2), 2.0, 1.0
DENSITY, GRAVITY = 2000.0, 10.0


def scene(k0):
    return {
        "title": f"column with k0 = {k0}", "dimension": "plane_strain", "duration": 1.0,
        "grid": {"cell": CELL, "min": [0, 0], "max": [WIDTH, 3]},
        "solver": {"stabilise": {"viscous_damping": 0.5, "local_damping": 0.3}},
        "materials": {"soil": {"model": "matsuoka_nakai", "density": DENSITY,
                               "bulk_modulus": 29.5e6, "shear_modulus": 13.6e6,
                               "friction_angle": FRICTION}},
        "bodies": [{"material": "soil", "box": {"min": [0, 0], "max": [WIDTH, HEIGHT]},
                    "particles_per_cell": [2, 2], "initial_stress": {"geostatic": {"k0": k0}}}],
        "gravity": [0, -GRAVITY],
        "boundaries": [{"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
                        "condition": "slip"},
                       {"name": "left", "plane": {"point": [0, 0], "normal": [1, 0]},
                        "condition": "slip"},
                       {"name": "right", "plane": {"point": [WIDTH, 0], "normal": [-1, 0]},
                        "condition": "slip"}],
        "output": {"history": {"every": 1e-4}, "frames": {"every": 1}},
    }


# A return at constant mean stress (no dilation) to sigma_h = Ka sigma_v, in the first step; then the
# vertical stress comes back to the weight, for which the walls have to carry Ka at least.
AT_ONCE = 3 * ACTIVE / (1 + 2 * ACTIVE) * (1 + 2 * K0) / (3 * K0)
IN_THE_END = ACTIVE / K0  # 1.957

verification = Verification("inadmissible-k0")
weight = DENSITY * GRAVITY * HEIGHT**2 / 2
run = verification.run(scene(K0))
force = run.reaction("right", "x")
verification.relative("given k0: force on the wall after the first step, over the initial one",
                      force[1] / (K0 * weight), AT_ONCE, 0.01)
verification.above("given k0: force on the wall when it has settled, over the initial one",
                   run.mean("reaction.right.force.x", 0.8) / (K0 * weight), 0.99 * IN_THE_END)
events = [json.loads(line) for line in (run.folder / "events.ndjson").read_text().splitlines()]
verification.equal("given k0: pointers of warnings",
                   [event["pointer"] for event in events if event["event"] == "warning"],
                   ["/bodies/0/initial_stress/geostatic/k0"])
run = verification.run(scene("auto"))
force = run.reaction("right", "x")
verification.relative("auto: force on the wall after the first step [N]", force[1], ACTIVE * weight,
                      0.005)
verification.below("auto: largest change of it in the whole run",
                   max(abs(value - force[1]) for value in force[1:]) / force[1], 0.01)
verification.finish()
