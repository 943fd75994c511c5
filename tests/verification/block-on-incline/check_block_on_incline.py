# SPDX-License-Identifier: Apache-2.0
"""A block on a rough plane: it sticks below the friction angle and slides with
a = g (sin - mu cos) above it, whichever way the plane is turned."""
import math

from verification import Verification, particle_bodies, shipped_scene

G, ANGLE = 9.81, math.radians(30)
ALONG, ACROSS = G * math.sin(ANGLE), G * math.cos(ANGLE)
LENGTH, HEIGHT, CELL = 1.0, 0.4, 0.1


def scene(title, coefficient, duration, velocity=0.0, order=(0, 1), damping=0.0, start=0.25):
    """`order`: the axes along the plane and normal to it."""
    axes = max(order) + 1

    def vector(along, normal, other=0.0):
        components = [other] * axes
        components[order[0]], components[order[1]] = along, normal
        return components

    other = 0.1 if axes == 3 else 0.0
    boundaries = [{"name": "plane",
                   "plane": {"point": [0] * axes, "normal": vector(0, 1)},
                   "condition": "friction", "friction_coefficient": coefficient,
                   "tension_release": True}]
    if axes == 3:
        side = 3 - sum(order)
        for name, place, sign in (("low", 0.0, 1), ("high", other, -1)):
            boundaries.append({"name": name, "condition": "slip",
                               "plane": {"point": [place if k == side else 0 for k in range(3)],
                                         "normal": [sign if k == side else 0 for k in range(3)]}})
    return {
        "title": title,
        "dimension": "plane_strain" if axes == 2 else "solid",
        "duration": duration,
        "grid": {"cell": CELL, "min": vector(0, 0), "max": vector(3, 1, other)},
        "solver": {"time_step": 5e-4, "stabilise": {"local_damping": damping}},
        "materials": {"stone": {"model": "linear_elastic", "density": 2000,
                                "young_modulus": 1e7, "poisson_ratio": 0.25}},
        "bodies": [{"material": "stone",
                    "box": {"min": vector(start, 0), "max": vector(start + LENGTH, HEIGHT, other)},
                    "particles_per_cell": [2] * axes, "velocity": vector(velocity, 0),
                    "initial_stress": {"geostatic": {"k0": 0}}}],
        "gravity": vector(ALONG, -ACROSS),
        "boundaries": boundaries,
        "probes": [{"name": "centre", "kind": "centre_of_mass"}],
        "output": {"history": {"every": 0.0025},
                   "frames": {"every": duration, "precision": "double",
                              "fields": ["velocity", "mass"], "grid_fields": ["velocity"]}},
    }


def check_stick(verification):
    """A friction rule that looks at the velocity before the step would creep by a dt / 2."""
    ramped = scene("block that sticks", 0.9, 3.0, damping=0.2)
    ramped["solver"]["stabilise"]["force_ramp"] = 0.3
    ramped["bodies"][0].pop("initial_stress")
    run = verification.run(ramped)
    position = run.probe("centre.x")
    late = [x for t, x in zip(run.time, position) if t >= 2.5]
    verification.below("sticks: drift of the centre over the last 0.5 s [m]",
                       max(late) - min(late), 1e-12)
    verification.below("sticks: elastic displacement of the centre [m], below rho g h^2 / G",
                       abs(position[-1] - position[0]), 2000 * G * HEIGHT**2 / 4e6)
    weight = 2000 * LENGTH * HEIGHT
    verification.relative("sticks: force along the plane = component of the weight [N]",
                          run.reaction("plane", "x")[-1], weight * ALONG, 1e-9)
    verification.relative("sticks: force on the plane = component of the weight [N]",
                          run.reaction("plane", "y")[-1], -weight * ACROSS, 1e-9)


def travel_error(run, along, across, coefficient, velocity, step):
    """Largest distance between the centre and the exact motion of the scheme, in which velocity
    comes first: v0 t + a (t^2 + t dt) / 2, less mu times what the centre has moved off the plane
    (Coulomb friction is mu times the normal impulse, and the normal impulse lifts the centre)."""
    acceleration = ALONG - coefficient * ACROSS
    worst = 0.0
    for k, time in enumerate(run.time):
        expected = (velocity * time + acceleration * (time**2 + time * step) / 2
                    - coefficient * (across[k] - across[0]))
        worst = max(worst, abs(along[k] - along[0] - expected))
    return worst


def check_slide(verification, order):
    names = "xyz"
    duration, velocity, coefficient = 0.04, 1.0, 0.3
    label = f"slides along {names[order[0]]} on a plane normal to {names[order[1]]}"
    run = verification.run(scene(f"block that {label}", coefficient, duration, velocity, order))
    along = run.probe("centre." + names[order[0]])
    across = run.probe("centre." + names[order[1]])
    friction = run.impulse("plane", names[order[0]])
    normal = run.impulse("plane", names[order[1]])
    verification.relative(f"{label}: friction over normal impulse", -friction / normal,
                          coefficient, 1e-9)
    acceleration = ALONG - coefficient * ACROSS
    error = travel_error(run, along, across, coefficient, velocity, 5e-4)
    verification.below(f"{label}: error of the acceleration, relative",
                       error / (acceleration * duration**2 / 2), 1e-6)


def check_far(verification):
    """The shipped scene: from rest, over a dozen cells."""
    shipped = shipped_scene("block-on-rough-plane")
    run = verification.run(shipped)
    exact = (ALONG - 0.3 * ACROSS) / 2
    verification.relative("slides far from rest: travel over a t^2 / 2",
                          run.probe("position")[-1] - run.probe("position")[0], exact, 0.01)


def oblique_scene(coefficient, duration, velocity, spacing):
    tangent = (math.cos(ANGLE), -math.sin(ANGLE))
    normal = (math.sin(ANGLE), math.cos(ANGLE))
    corner = (0.31, 1.87)
    points = [[corner[k] + (i + 0.5) * spacing * tangent[k] + (j + 0.5) * spacing * normal[k]
               for k in range(2)]
              for j in range(round(HEIGHT / spacing)) for i in range(round(LENGTH / spacing))]
    return {
        "title": "block that slides down an oblique plane",
        "dimension": "plane_strain",
        "duration": duration,
        "grid": {"cell": CELL, "min": [0, 0], "max": [3, 3]},
        "solver": {"time_step": 5e-4, "stabilise": {"viscous_damping": 0.5}},
        "materials": {"stone": {"model": "linear_elastic", "density": 2000,
                                "young_modulus": 1e6, "poisson_ratio": 0.25}},
        "bodies": particle_bodies(points, [spacing] * 2, "stone",
                                  lambda _: [velocity * c for c in tangent]),
        "gravity": [0, -G],
        "boundaries": [{"name": "plane", "plane": {"point": list(corner), "normal": list(normal)},
                        "condition": "friction", "friction_coefficient": coefficient,
                        "tension_release": True}],
        "probes": [{"name": "centre", "kind": "centre_of_mass"}],
        "output": {"history": {"every": 0.005}},
    }


def check_oblique(verification):
    duration, velocity, coefficient = (0.8, 1.0, 0.3)
    run = verification.run(oblique_scene(coefficient, duration, velocity, 0.05))
    tangent = (math.cos(ANGLE), -math.sin(ANGLE))
    travel = sum((run.probe("centre." + name)[-1] - run.probe("centre." + name)[0]) * part
                 for name, part in zip("xy", tangent))
    acceleration = 2 * (travel - velocity * duration) / duration**2
    verification.relative("slides down an oblique plane: acceleration [m/s^2]", acceleration,
                          ALONG - coefficient * ACROSS, 0.02)


verification = Verification("block-on-incline")
check_stick(verification)
for order in ((0, 1), (1, 0), (0, 2), (2, 1)):
    check_slide(verification, order)
check_far(verification)
check_oblique(verification)
verification.finish()
