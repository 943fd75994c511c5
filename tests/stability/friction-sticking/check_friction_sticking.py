# SPDX-License-Identifier: Apache-2.0
"""A block on a rough slope that is too flat for it to slide: with the friction rule as printed it
creeps, with Talus' rule it stands."""
import h5py
import numpy as np
from small_mpm import SmallMpm
from verification import FULL, Verification

CELL, DENSITY, YOUNG, POISSON = 0.1, 1000.0, 1e6, 0.2
GRAVITY, SLOPE, FRICTION = 10.0, 0.2, 0.8  # tan of the slope; the limit is four times what is needed
STEP, DURATION = 5e-4, (2.0 if FULL else 0.5)
LOW, HIGH = (0.4, 0.0), (1.2, 0.2)
PUSH = GRAVITY * SLOPE / np.sqrt(1 + SLOPE**2)
WEIGHT = GRAVITY / np.sqrt(1 + SLOPE**2)


def printed_rule(velocity, force, mass, step):
    """Andersen and Andersen 2012, eq. 53-55: friction against the velocity at the start of the step,
    or, if that would turn the motion round, the force that stops that velocity."""
    after = velocity + step * force / np.maximum(mass, 1e-300)[:, None]
    push = np.maximum(0.0, -(force[:, 1] + mass * velocity[:, 1] / step))
    after[:, 1] = 0.0
    free = after[:, 0]
    full = free - step * FRICTION * push / np.maximum(mass, 1e-300) * np.sign(velocity[:, 0])
    after[:, 0] = np.where(free * full > 0, full, 0.0)
    return after, np.zeros(2)


def floor_only(velocity):
    velocity[:, 1] = 0.0
    return velocity


def creep_of_the_printed_rule():
    """Speed between the means over the second and the last quarter: the block vibrates."""
    mpm = SmallMpm(CELL, 20, 4, DENSITY, YOUNG, POISSON, (PUSH, -WEIGHT))
    mpm.fill(LOW, HIGH, 2)
    mpm.stress[:, 1] = -DENSITY * WEIGHT * (HIGH[1] - mpm.position[:, 1])
    mpm.stress[:, 0] = POISSON / (1 - POISSON) * mpm.stress[:, 1]
    mpm.rules = [(np.array([mpm.node(column, 0) for column in range(21)]), printed_rule, floor_only)]
    places = []
    for _ in range(round(DURATION / STEP)):
        mpm.step(STEP)
        places.append(mpm.position[:, 0].mean())
    quarter = len(places) // 4
    return (np.mean(places[-quarter:]) - np.mean(places[quarter:2 * quarter])) / (DURATION / 2)


def talus_scene():
    return {
        "title": "block on a slope below the angle of friction", "dimension": "plane_strain",
        "duration": DURATION, "grid": {"cell": CELL, "min": [0, 0], "max": [2, 0.4]},
        "solver": {"time_step": STEP, "strain": "small"},
        "materials": {"stone": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": POISSON}},
        "bodies": [{"material": "stone", "box": {"min": LOW, "max": HIGH},
                    "particles_per_cell": [2, 2],
                    "initial_stress": {"geostatic": {"k0": "elastic"}}}],
        "gravity": [PUSH, -WEIGHT],
        "boundaries": [{"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
                        "condition": "friction", "friction_coefficient": FRICTION}],
        "probes": [{"name": "place", "kind": "centre_of_mass", "component": "x"}],
        "output": {"history": {"every": DURATION / 200},
                   "frames": {"every": DURATION / 50, "grid_fields": ["velocity"],
                              "precision": "double"}},
    }


def fastest_floor_node(run):
    """Away from the ends of the block, which its own rocking may lift."""
    speeds = []
    for path in sorted((run.folder / "frames").glob("grid_*.hdf"))[1:]:
        with h5py.File(path) as file:
            place, velocity = file["VTKHDF/Points"][...], file["VTKHDF/PointData/velocity"][...]
        under = ((place[:, 1] == 0) & (place[:, 0] > LOW[0] + 1.5 * CELL)
                 & (place[:, 0] < HIGH[0] - 1.5 * CELL))
        speeds.append(np.abs(velocity[under]).max())
    return max(speeds)


verification = Verification("friction-sticking")
creep = PUSH * STEP / 2
verification.above("printed rule: creep, over a dt / 2", creep_of_the_printed_rule() / creep, 0.5)
run = verification.run(talus_scene())
quarters = [run.mean("probe.place", k * DURATION / 4, (k + 1) * DURATION / 4) for k in range(4)]
verification.below("Talus: drift, over a dt / 2",
                   abs(quarters[3] - quarters[1]) / (DURATION / 2) / creep, 0.05)
verification.equal("Talus: largest speed of a node under the block [m/s]", fastest_floor_node(run),
                   0.0)
verification.finish()
