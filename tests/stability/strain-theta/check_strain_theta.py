# SPDX-License-Identifier: Apache-2.0
"""An elastic bar that strains with a velocity before the end of the step: every wave grows.

The clamps keep the velocities of the particles: those that stop them take energy from random waves."""
import math
import random

import numpy as np
from verification import Verification, particle_bodies

CELLS, CELL, YOUNG, DENSITY, COURANT = 20, 0.05, 1e6, 1000.0, 0.3
SPEED = math.sqrt(YOUNG / DENSITY)
STEP = COURANT * CELL / SPEED
STEPS = 4000


def scene(update, theta, noise, steps, pressure=None, first_mode=False):
    """Without pressure one end is held and the other free; under pressure both are held, and the
    energy of the pressure lets the waves grow unseen by the check of the energy."""
    source, length = random.Random(2), CELLS * CELL
    centres = [[(k + 0.5) * CELL / 2] for k in range(2 * CELLS)]
    bodies = particle_bodies(
        centres, [CELL / 2], "metal",
        lambda c: [noise * (math.sin(math.pi * c[0] / (2 * length)) if first_mode
                            else source.uniform(-1, 1))])
    walls = [{"name": "clamp", "plane": {"point": [0], "normal": [1]}, "condition": "stick", "wall": "keep"}]
    if pressure is not None:
        for body in bodies:
            body["initial_stress"] = [-pressure, 0, 0, 0, 0, 0]
        walls.append({"name": "end", "plane": {"point": [length], "normal": [-1]},
                      "condition": "stick", "wall": "keep"})
    return {
        "title": f"bar, {update}, strain_theta = {theta:g}", "dimension": "line",
        "duration": steps * STEP, "grid": {"cell": CELL, "min": [0], "max": [length + 2 * CELL]},
        "solver": {"stress_update": update, "strain": "small", "time_step": STEP,
                   "allow_unstable": True,
                   **({} if update == "first" else {"strain_theta": theta})},
        "materials": {"metal": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": 0}},
        "bodies": bodies, "boundaries": walls,
        # Kinetic and strain energy are a part of a step apart, so that their sum oscillates.
        "audits": {"energy_growth": 0.2},
        "output": {"frames": {"every": 0}, "history": {"every": STEP}},
    }


def expected_rate(theta):
    """Largest growth of the energy per step: 1 + (s - theta) (w dt)^2 over the waves of the mesh,
    with s = 1 - 3/4 sin^2(k h / 2) for two particles at 1/4 and 3/4 of every cell and
    (w dt)^2 = 4 C^2 sin^2(k h / 2) of hat functions and a lumped mass."""
    sine = np.linspace(0, 1, 10001)**2
    return np.max(1 + (1 - 0.75 * sine - theta) * 4 * COURANT**2 * sine)


def energy(run):
    return np.array(run.series["energy.kinetic"]) + np.array(run.series["energy.strain"])


verification = Verification("strain-theta")
for theta in (0.0, 0.5):
    run = verification.run(scene("last", theta, 1e-12, STEPS, pressure=1e4), expected_exit=11)
    kinetic = np.array(run.series["energy.kinetic"])
    verification.above(f"last, strain_theta {theta:g}: kinetic energy grows", np.max(kinetic) / kinetic[0],
                       1e15)
    # Of the many waves the fastest has outgrown the others after a dozen decades.
    late = np.flatnonzero((kinetic > 1e10 * kinetic[0]) & (kinetic < 1e15 * kinetic[0]))
    rate = np.polyfit(late, np.log(kinetic[late]), 1)[0]
    verification.relative(f"last, strain_theta {theta:g}: logarithm of the growth per step", rate,
                          math.log(expected_rate(theta)), 0.1)
    # The run ends by the check of its energy; without that check it would have gone on.
    verification.above(f"last, strain_theta {theta:g}: decades of growth in {STEPS} steps at that rate",
                       rate * STEPS / math.log(10), 40)
run = verification.run(scene("last", 1.0, 1e-4, STEPS))
verification.between("last, strain_theta 1: energy left of random waves",
                     energy(run)[-1] / energy(run)[0], 0.2, 0.8)
run = verification.run(scene("last", 1.0, 1e-4, STEPS, first_mode=True))
verification.relative("last, strain_theta 1: energy left of the first mode",
                      energy(run)[-1], energy(run)[0], 0.012)
for update in ("modified_last", "first"):
    run = verification.run(scene(update, 1.0, 1e-4, STEPS))
    verification.relative(f"{update}: energy of random waves, mean of the last 200 steps",
                          np.mean(energy(run)[-200:]), energy(run)[0], 0.08)
verification.finish()
