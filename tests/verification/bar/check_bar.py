# SPDX-License-Identifier: Apache-2.0
"""Longitudinal vibration of an elastic bar, one end held, in its first mode: the period is 4 L / c,
and its error falls with the square of the cell."""
import math

from verification import FULL, Verification, particle_bodies

LENGTH, DENSITY, YOUNG, POISSON = 1.0, 1000.0, 1e6, 0.3
TIP_SPEED = 1e-3  # amplitude over length about 2e-5, so that finite strain changes nothing


def modulus(dimension, poisson):
    """In `line` the strain is uniaxial; the slender bar of `solid` has nu = 0."""
    return YOUNG * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))


def scene(dimension, cells, poisson, periods, update="modified_last"):
    axes = {"line": 1, "solid": 3}[dimension]
    cell, spacing = LENGTH / cells, LENGTH / cells / 2
    speed = math.sqrt(modulus(dimension, poisson) / DENSITY)
    across = [(k + 0.5) * spacing for k in range(2)] if axes == 3 else [0.0]
    points = [[(i + 0.5) * spacing] + ([y, z] if axes == 3 else [])
              for i in range(2 * cells) for y in across for z in across[:len(across)]]
    if axes == 1:
        points = [[(i + 0.5) * spacing] for i in range(2 * cells)]
    bodies = particle_bodies(
        points, [spacing] * axes, "metal",
        lambda c: [TIP_SPEED * math.sin(math.pi * c[0] / (2 * LENGTH))] + [0.0] * (axes - 1))
    return {
        "title": f"bar, {dimension}, {cells} cells, {update}",
        "dimension": dimension,
        "duration": periods * 4 * LENGTH / speed,
        "grid": {"cell": cell, "min": [0] * axes, "max": [LENGTH + cell] + [cell] * (axes - 1)},
        "solver": {"stress_update": update},
        "materials": {"metal": {"model": "linear_elastic", "density": DENSITY,
                                "young_modulus": YOUNG, "poisson_ratio": poisson}},
        "bodies": bodies,
        "boundaries": [{"name": "clamp", "condition": "stick",
                        "plane": {"point": [0] * axes, "normal": [1] + [0] * (axes - 1)}}],
        "probes": [{"name": "mean", "kind": "centre_of_mass", "component": "x"}],
        "output": {"history": {"every": 4 * LENGTH / speed / 200}},
    }


def period(run):
    """Fit of a cos + b sin to the mean displacement: the frequency of least residual."""
    import numpy
    time = numpy.array(run.time)
    value = numpy.array(run.probe("mean"))
    value = value - value[0]
    guess = 4 * LENGTH / math.sqrt(run.wave_speed_squared)

    def residual(candidate):
        phase = 2 * math.pi * time / candidate
        base = numpy.stack([numpy.cos(phase), numpy.sin(phase), numpy.ones_like(time)], axis=1)
        return numpy.linalg.norm(value - base @ numpy.linalg.lstsq(base, value, rcond=None)[0])

    low, high = 0.9 * guess, 1.1 * guess
    golden = (math.sqrt(5) - 1) / 2
    for _ in range(60):
        a, b = high - golden * (high - low), low + golden * (high - low)
        if residual(a) < residual(b):
            high = b
        else:
            low = a
    return (low + high) / 2


def check(verification, dimension, cells, poisson, periods=4, update="modified_last"):
    run = verification.run(scene(dimension, cells, poisson, periods, update))
    run.wave_speed_squared = modulus(dimension, poisson) / DENSITY
    exact = 4 * LENGTH / math.sqrt(run.wave_speed_squared)
    return period(run) / exact - 1, run


verification = Verification("bar")
resolutions = [5, 10, 20, 40, 80, 160] if FULL else [5, 10, 20, 40]
errors = []
for cells in resolutions:
    error, run = check(verification, "line", cells, POISSON)
    errors.append(abs(error))
    print(f"  {cells} cells: period off by {error:.3e}")
verification.below(f"one dimension, {resolutions[2]} cells: error of the period", errors[2], 0.01)
order = math.log(errors[0] / errors[3]) / math.log(resolutions[3] / resolutions[0])
verification.above("one dimension: order of convergence of the period, 5 to 40 cells", order, 1.8)
for update in ("first", "last"):
    coarse, fine = (abs(check(verification, "line", cells, POISSON, update=update)[0])
                    for cells in (5, 40))
    verification.below(f"one dimension, 40 cells, {update}: error of the period", fine, 0.0025)
    verification.above(f"one dimension, {update}: order of convergence of the period, 5 to 40 cells",
                       math.log(coarse / fine) / math.log(8), 1.8)
error, run = check(verification, "solid", 10, 0.0)
verification.below("three dimensions, 10 cells, nu = 0: error of the period", abs(error), 0.01)
line_error, _ = check(verification, "line", 10, 0.0)
verification.below("three dimensions against one, 10 cells, nu = 0", abs(error - line_error), 1e-4)
verification.below("three dimensions: energy that the method lost in four periods, relative",
                   abs(run.metrics["energy_numerical"]), 0.1)
verification.finish()
