# SPDX-License-Identifier: Apache-2.0
"""Collapse of a block of soil with little cohesion: initial stresses, run-out, weight, relative yield,
noise of raw against smoothed stress, energy."""
import math

import numpy as np
from verification import FULL, Verification

WIDTH, HEIGHT = 5.0, 10.0  # half of the block
CELL = WIDTH / 22.5 if FULL else WIDTH / 15
DENSITY, GRAVITY = 1000.0, 9.8
COHESION, FRICTION = 1e3, math.radians(40)
REST = 1 - math.sin(FRICTION)  # K0
WEIGHT = DENSITY * GRAVITY * WIDTH * HEIGHT
MOVING, END = 1.15, 5.0  # the time of the source's picture; all has come to rest by 3.5 s
# A stress at the apex has neither shear nor strength left: relative yield is 0 / 0 there.
LEAST_STRENGTH = 1e-6 * COHESION


def scene():
    return {
        "title": "collapse of a block of soil with cohesion", "dimension": "plane_strain",
        "duration": END,
        "grid": {"cell": CELL, "min": [0, 0], "max": [25, 12]},
        "solver": {"shape": "gimp_scaled", "stress_update": "first"},
        "materials": {"soil": {"model": "mohr_coulomb", "density": DENSITY, "young_modulus": 20e6,
                               "poisson_ratio": 0.25, "cohesion": COHESION,
                               "friction_angle": 40, "dilation_angle": 0}},
        "bodies": [{"material": "soil", "box": {"min": [0, 0], "max": [WIDTH, HEIGHT]},
                    "count": [round(2 * WIDTH / CELL), round(2 * HEIGHT / CELL)],
                    "initial_stress": {"geostatic": {"k0": REST}}}],
        "gravity": [0, -GRAVITY],
        "boundaries": [
            {"name": "axis", "plane": {"point": [0, 0], "normal": [1, 0]}, "condition": "slip"},
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
             "condition": "friction", "friction_coefficient": 0.6}],
        "probes": [{"name": "front", "kind": "front", "along": [1, 0]}],
        "output": {"history": {"every": 0.01},
                   "frames": {"every": MOVING, "precision": "double",
                              "fields": ["stress", "density", "mass"]}},
    }


def relative_yield(frame):
    """Shear stress over strength of every particle, from the Kirchhoff stress J sigma that yields
    (nan at the apex), and how far shear exceeds strength, over the cohesion."""
    xx, yy, zz, xy = (frame["stress"][:, k] * DENSITY / frame["density"] for k in range(4))
    centre, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    high, low = np.maximum(centre + radius, zz), np.minimum(centre - radius, zz)
    shear = (high - low) / 2
    strength = COHESION * math.cos(FRICTION) - (high + low) / 2 * math.sin(FRICTION)
    share = np.full(len(shear), np.nan)
    np.divide(shear, strength, out=share, where=strength > LEAST_STRENGTH)
    return share, ((shear - strength) / COHESION).max()


def smoothed(frame, values):
    """To the nodes, weighted by mass, and back (Andersen and Andersen 2012, eq. 57-58), hat functions."""
    place = frame["position"][:, :2] / CELL
    base = np.floor(place).astype(int)
    part = place - base
    columns = base[:, 1].max() + 2
    mass = np.zeros((base[:, 0].max() + 2) * columns)
    moment = np.zeros_like(mass)
    corners = []
    for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
        weight = np.prod(np.where(corner, part, 1 - part), axis=1)
        node = (base[:, 0] + corner[0]) * columns + base[:, 1] + corner[1]
        np.add.at(mass, node, weight * frame["mass"])
        np.add.at(moment, node, weight * frame["mass"] * values)
        corners.append((node, weight))
    return sum(weight * moment[node] / mass[node] for node, weight in corners)


def roughness(frame, values):
    """Mean difference to the eight nearest particles, over the mean of the size."""
    place = frame["position"][:, :2]
    total = 0.0
    for begin in range(0, len(place), 500):
        some = slice(begin, begin + 500)
        distance = ((place[some, None] - place[None]) ** 2).sum(axis=-1)
        near = np.argpartition(distance, 8, axis=1)[:, :9]  # itself is one of the nine
        total += np.abs(values[near] - values[some, None]).sum() / 8
    return total / len(values) / np.abs(values).mean()


def check_start(verification, frame):
    depth = HEIGHT - frame["position"][:, 1]
    yy = -DENSITY * GRAVITY * depth
    for name, component, stress in (("xx", 0, REST * yy), ("yy", 1, yy), ("zz", 2, REST * yy)):
        verification.below(f"start: sigma_{name} against rho g d and K0, largest error over rho g H",
                           np.abs(frame["stress"][:, component] - stress).max()
                           / (DENSITY * GRAVITY * HEIGHT), 1e-9)
    verification.below("start: largest relative yield (elastic until the side is free)",
                       np.nanmax(relative_yield(frame)[0]), 1.0)


def check_frame(verification, frame, label):
    share, excess = relative_yield(frame)
    verification.between(f"{label}: largest relative yield, raw", np.nanmax(share), 0.0, 1.0001)
    verification.below(f"{label}: shear beyond the strength, over c, apex included", excess, 1e-4)
    verification.note(f"{label}: particles at the apex, share", np.isnan(share).mean(),
                      "without stress, relative yield is 0 / 0")
    raw = frame["stress"][:, 1]
    verification.above(f"{label}: roughness of sigma_yy, raw over smoothed",
                       roughness(frame, raw) / roughness(frame, smoothed(frame, raw)), 5.0)


def check_base(verification, frame):
    """Smoothed stress in the lowest row of cells: under the ridge, and over the block's first width."""
    x, y = frame["position"][:, 0], frame["position"][:, 1]
    stress = smoothed(frame, frame["stress"][:, 1])
    ridge, core = x < WIDTH / 5, x < WIDTH
    verification.note("at rest: smoothed -sigma_yy under the ridge, over rho g h",
                      -stress[ridge & (y < CELL)].mean() / (DENSITY * GRAVITY * y[ridge].max()),
                      "the load passes outward (see README)")
    verification.note("at rest: smoothed -sigma_yy over the first width, over the weight above",
                      -stress[core & (y < CELL)].mean() * WIDTH
                      / (GRAVITY * frame["mass"][core].sum()), "shear on the flank is left out")


verification = Verification("andersen-soil-column")
run = verification.run(scene())
check_start(verification, run.frame(0))
check_frame(verification, run.frame(1), f"at {MOVING:g} s")
check_frame(verification, run.frame(-1), "at rest")
check_base(verification, run.frame(-1))
verification.between("run-out, (front - half width) / half width",
                     run.probe("front")[-1] / WIDTH - 1, 1.2, 3.0)
verification.relative("force on the floor at rest [N/m]",
                      run.mean("reaction.floor.force.y", END - 1), -WEIGHT, 0.02)
total = np.array(run.series["energy.total"])
drop = run.series["energy.potential"][0] - run.series["energy.potential"][-1]
verification.below("total energy above its lowest so far, largest, over what fell",
                   (total - np.minimum.accumulate(total)).max() / drop, 1e-4)
lost = np.array(run.series["energy.numerical"])
verification.above("energy that the method lost, least at any time, over what fell",
                   lost.min() / drop, -1e-4)
verification.below("energy that the method lost, largest at any time, over what fell",
                   lost.max() / drop, 0.05)
verification.finish()
