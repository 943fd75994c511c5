# SPDX-License-Identifier: Apache-2.0
"""A dam that breaks onto a vertical wall (Mast 2013, sec. 6.1.2): static forces at the start, the time
of contact, the momentum balance, and the level of the wave that has come back."""
import math

from barrier_scene import CELL, DENSITY, GRAVITY, HEIGHT, LENGTH, TANK, scene
from verification import FULL, Verification

STATIC = DENSITY * GRAVITY * HEIGHT**2 / 2  # 19 571 N/m
CONTACT = 1.26 * math.sqrt(HEIGHT / GRAVITY)  # travel of one height: Martin and Moyce, rescaled


def momentum(frame):
    return float((frame["mass"].reshape(-1) * frame["velocity"][:, 0]).sum())


def contact(run):
    """When the front would touch the barrier: the grid feels it one cell early, so the front is
    followed to there and goes on at the speed that it has."""
    front = run.probe("front")
    near = next(k for k, x in enumerate(front) if x >= TANK - CELL)
    back = near - 20
    speed = (front[near] - front[back]) / (run.time[near] - run.time[back])
    return run.time[near] + (TANK - front[near]) / speed


def check_start(verification):
    """Forces of the first step, in which everything still stands."""
    run = verification.run(scene("cell", duration=2e-3, every=1e-7))
    verification.relative("force on the left wall in the first step [N/m]",
                          run.reaction("lower", "x")[1] + run.reaction("upper", "x")[1], -STATIC,
                          0.005)
    verification.relative("force on the floor in the first step [N/m]", run.reaction("floor", "y")[1],
                          -DENSITY * GRAVITY * LENGTH * HEIGHT, 0.005)
    verification.equal("force on the barrier in the first step [N/m]",
                       run.reaction("barrier", "x")[1], 0.0)
    return run.reaction("lower", "x")[1]


def check_wave(verification, lower, control):
    run = verification.run(scene(control))
    if FULL and control == "hybrid":
        verification.deviation(f"{control}: contact earlier than {CONTACT:.3f} s, relative",
                               1 - contact(run) / CONTACT, 0.15, 0.18)
    else:
        verification.relative(f"{control}: time of contact [s]", contact(run), CONTACT, 0.15)
    touched = next(t for t, f in zip(run.time, run.reaction("barrier", "x")) if f != 0)
    verification.above(f"{control}: first force on the barrier [s], against Ritter's front", touched,
                       (TANK - LENGTH - CELL) / (2 * math.sqrt(GRAVITY * HEIGHT)))
    verification.relative(f"{control}: force on the lower half of the left wall about t = 0.4 s, over "
                          "the first", run.mean("reaction.lower.force.x", 0.35, 0.45) / lower, 1.0, 0.10)
    verification.relative(f"{control}: mean level of the right third at t = 2 s [m]",
                          run.mean("probe.level", 1.9), HEIGHT, 0.25)
    pushed = -math.fsum(run.impulse(name, "x") for name in ("lower", "upper", "barrier"))
    verification.below(f"{control}: impulses of the walls against the momentum at the end, over the "
                       "barrier's", abs(momentum(run.frame(-1)) - pushed) / run.impulse("barrier", "x"), 1e-10)
    return run


def check_alike(verification, hybrid, cell):
    """The source finds the kinematics of both nearly identical: fronts, until one has touched."""
    until = min(contact(hybrid), contact(cell))
    apart = [abs(hybrid.value_at("probe.front", when) - x)
             for when, x in zip(cell.time, cell.probe("front")) if when < until]
    verification.below("hybrid against cell: largest distance of the fronts until contact, in cells",
                       max(apart) / CELL, 0.5)


def check_locking(verification, wave):
    run = verification.run(scene("none", duration=0.5, stiff=True))
    way = [r.value_at("probe.front", 0.4) - LENGTH for r in (run, wave)]
    verification.below("without anti-locking: way of the front at t = 0.4 s, over that with it",
                       way[0] / way[1], 0.8)


def check_rest(verification):
    """The same water after it has come to rest. At the walls and at the surface half a cell is not
    full, of a level of five cells: that is the tolerance."""
    level = LENGTH * HEIGHT / TANK
    run = verification.run(scene("cell", duration=0.5, every=0.01, settle=6.0, stiff=False))
    for name in ("level", "depth"):
        verification.relative(f"at rest: {name} of the water [m]", run.mean("probe." + name, 0), level,
                              0.5 * CELL / level)
    forces = {name: run.mean(f"reaction.{name}.force.x", 0) for name in ("lower", "upper", "barrier")}
    for wall, force in (("left wall", -forces["lower"] - forces["upper"]),
                        ("barrier", forces["barrier"])):
        verification.relative(f"at rest: force on the {wall} [N/m]", force,
                              DENSITY * GRAVITY * level**2 / 2, 2 * 0.5 * CELL / level)
    verification.relative("at rest: force on the floor [N/m]", run.mean("reaction.floor.force.y", 0),
                          -DENSITY * GRAVITY * LENGTH * HEIGHT, 0.005)


verification = Verification("mast-6.1.2-barrier")
lower = check_start(verification)
wave = check_wave(verification, lower, "cell")
check_alike(verification, check_wave(verification, lower, "hybrid"), wave)
check_locking(verification, wave)
check_rest(verification)
verification.finish()
