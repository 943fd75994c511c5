# SPDX-License-Identifier: Apache-2.0
"""One cell between walls that move: every node is prescribed, so the deformation is known to the last
step, and the stress of each model in closed form."""
import math

import numpy

from verification import Verification

SIZE, STEP, STEPS = 0.5, 1e-3, 400
BULK, SHEAR, DENSITY = 5e6, 3e6, 2000.0
TOLERANCE = 1e-9  # round-off of some hundred steps of strains of 1e-4
ELASTIC = {"density": DENSITY, "bulk_modulus": BULK, "shear_modulus": SHEAR}


def scene(material, rates):
    """`rates`: velocity over distance of the walls at the far sides [1/s]."""
    boundaries = [
        {"name": f"{name}-near", "condition": "slip", "plane": {"point": [0, 0], "normal": normal}}
        for name, normal in (("x", [1, 0]), ("y", [0, 1]))]
    boundaries += [
        {"name": f"{name}-far", "condition": "velocity", "stays": True, "components": [name],
         "velocity": [rate * SIZE] * 2, "plane": {"point": [SIZE, SIZE], "normal": normal}}
        for name, rate, normal in zip("xy", rates, ([-1, 0], [0, -1]))]
    return {
        "title": f"one element, {material['model']}",
        "dimension": "plane_strain", "duration": STEP * STEPS,
        "grid": {"cell": SIZE, "min": [0, 0], "max": [2 * SIZE, 2 * SIZE]},
        "solver": {"time_step": STEP, "allow_unstable": True},
        "materials": {"m": material},
        "bodies": [{"material": "m", "box": {"min": [0, 0], "max": [SIZE, SIZE]},
                    "particles_per_cell": [2, 2]}],
        "boundaries": boundaries,
        "output": {"history": {"every": STEP * STEPS},
                   "frames": {"every": STEP * STEPS, "precision": "double", "fields": ["stress"]}},
        "audits": {"energy_growth": 1},
    }


def strains(rates):
    """Hencky strains of the whole way, x, y, z."""
    return numpy.array([STEPS * math.log(1 + STEP * rate) for rate in rates] + [0.0])


def neo_hookean(strain):
    square = numpy.exp(2 * (strain - strain.mean()))
    return BULK * strain.sum() + SHEAR * (square - square.mean())


def tait(strain):
    volume = math.exp(strain.sum())
    return -volume * BULK / 7 * (volume ** -7 - 1) * numpy.ones(3)


def tresca(cohesion):
    """Stretched along x about as much as compressed along y: the plane s_x - s_y = 2 c, whose flow
    leaves the deviator along z to elasticity."""
    def stress(strain):
        across = -2 * SHEAR * strain.sum() / 3
        return BULK * strain.sum() + numpy.array([cohesion - across / 2, -cohesion - across / 2,
                                                  across])

    return stress


def mohr_coulomb(friction, dilation, cohesion):
    """Compressed along y between fixed sides: both planes of the edge s1 = s2 flow by u/2, which
    leaves the elastic strains -m u/2, e + u, -m u/2."""
    k, m = ((1 + math.sin(a)) / (1 - math.sin(a)) for a in map(math.radians, (friction, dilation)))
    lame = BULK - 2 / 3 * SHEAR

    def stress(strain):
        e = strain[1]

        def at(u):
            elastic = numpy.array([-m * u / 2, e + u, -m * u / 2])
            return lame * elastic.sum() + 2 * SHEAR * elastic

        excess = [k * at(u)[0] - at(u)[1] - 2 * cohesion * math.sqrt(k) for u in (0.0, 1.0)]
        return at(excess[0] / (excess[0] - excess[1]))

    return stress


SQUEEZE, OEDOMETER = (0.1, -0.1), (0.0, -0.1)
CASES = [
    ("neo_hookean", {}, (0.3, -0.6), neo_hookean),
    ("newtonian_fluid", {"equation_of_state": "tait"}, OEDOMETER, tait),
    ("tresca", {"cohesion": 2e4}, SQUEEZE, tresca(2e4)),
    ("tresca", {"cohesion": 2e4, "residual_cohesion": 5e3, "softening_rate": 1e3}, SQUEEZE,
     tresca(5e3)),
    ("mohr_coulomb", {"friction_angle": 20, "cohesion": 1e3}, OEDOMETER, mohr_coulomb(20, 0, 1e3)),
    ("mohr_coulomb", {"friction_angle": 20, "dilation_angle": 20, "cohesion": 1e3}, OEDOMETER,
     mohr_coulomb(20, 20, 1e3)),
    ("mohr_coulomb", {"friction_angle": 20, "dilation_angle": 5, "cohesion": 1e3,
                      "residual_friction_angle": 10, "residual_cohesion": 0,
                      "softening_rate": 2e3}, OEDOMETER, mohr_coulomb(10, 5, 0)),
]


def main():
    verification = Verification("one element")
    for model, parameters, rates, closed_form in CASES:
        elastic = ELASTIC
        if model == "newtonian_fluid":
            elastic = {"density": DENSITY, "bulk_modulus": BULK}
        run = verification.run(scene({"model": model, **elastic, **parameters}, rates))
        strain = strains(rates)
        expected = closed_form(strain) / math.exp(strain.sum())
        stress = run.frame()["stress"]
        error = max(numpy.abs(stress[:, :3] - expected).max(), numpy.abs(stress[:, 3:]).max())
        verification.below(f"{model} {parameters}: stress, of the largest",
                           error / numpy.abs(expected).max(), TOLERANCE)
    verification.finish()


if __name__ == "__main__":
    main()
