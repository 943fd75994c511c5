# SPDX-License-Identifier: Apache-2.0
"""The same scene gives the same bits for one thread and for several, for every material, in two and
three dimensions, through contact, friction, cell crossing and elimination; and twice in a row."""
from verification import FULL, Verification

SOIL = {"density": 2000, "bulk_modulus": 8.33e6, "shear_modulus": 3.85e6}
MOBILISED = {**SOIL, "friction": {"a0": 35, "a1": 9, "a3": 0.3, "a4": 10, "strain_scale": 100}}
MATERIALS = {
    "linear_elastic": {"density": 1000, "young_modulus": 5e5, "poisson_ratio": 0.3},
    "neo_hookean": {"density": 1000, "young_modulus": 5e5, "poisson_ratio": 0.3},
    "newtonian_fluid": {"density": 1000, "bulk_modulus": 2e6, "viscosity": 0.1},
    "j2": {**SOIL, "yield_stress": 2e4, "isotropic_hardening": 1e4},
    "drucker_prager_cap": {**SOIL, "friction_angle": 20, "cone_strength": 10, "flow_ratio": 0.05},
    "drucker_prager_mobilised": MOBILISED,
    "matsuoka_nakai": MOBILISED,
    "mohr_coulomb": {**SOIL, "friction_angle": 30, "dilation_angle": 5, "cohesion": 100,
                     "residual_friction_angle": 20, "softening_rate": 20},
    "tresca": {**SOIL, "cohesion": 5e3, "residual_cohesion": 2e3, "softening_rate": 20},
}


def scene(model, dimension, update):
    solid = dimension == "solid"
    deep = [0.5] if solid else []
    planes = [("bed", [0, 0, 0], [0, 1, 0], {"condition": "friction", "friction_angle": 30}),
              ("back", [0, 0, 0], [1, 0, 0], {"condition": "slip", "tension_release": True}),
              ("outlet", [6, 0, 0], [-1, 0, 0], {"condition": "eliminate"})]
    if solid:
        planes += [("low", [0, 0, 0], [0, 0, 1], {"condition": "slip"}),
                   ("high", [0, 0, 0.5], [0, 0, -1], {"condition": "stick"})]
    axes = 3 if solid else 2
    boundaries = [{"name": name, "plane": {"point": point[:axes], "normal": normal[:axes]}, **rest}
                  for name, point, normal, rest in planes]
    boundaries.append({"name": "post", "condition": "slip", "tension_release": True,
                       "box": {"min": [5, 0] + [0] * (axes - 2),
                               "max": [5.25, 0.5] + [0.25] * (axes - 2)}})
    return {
        "title": f"determinism, {model}, {dimension}, {update}",
        "dimension": dimension,
        "duration": 0.05 if update == "last" else 0.25,
        "grid": {"cell": 0.125, "min": [0] * axes, "max": [7, 3] + deep, "outside": "eliminate",
                 "outside_mass_limit": 1},
        "solver": {"stress_update": update, "courant": 0.05 if update == "last" else 0.4,
                   "anti_locking": {"control": "cell", "field": "volumetric"},
                   "stabilise": {"viscous_damping": 0.2, "local_damping": 0.05}},
        "materials": {"m": {"model": model, **MATERIALS[model]}},
        "bodies": [{"material": "m", "box": {"min": [0, 0] + [0] * (axes - 2),
                                             "max": [4.8, 1.5] + deep},
                    "particles_per_cell": [2] * axes, "velocity": [0 if update == "last" else 3, 0] + [0] * (axes - 2),
                    "initial_stress": "hydrostatic"}],
        "gravity": [1, -9.81] + [0] * (axes - 2),
        "boundaries": boundaries,
        "probes": [{"name": "front", "kind": "front", "along": [1, 0] + [0] * (axes - 2)},
                   {"name": "stress", "kind": "integral", "field": "stress"}],
        "output": {"history": {"every": 0.01}, "frames": {"every": 0.02}},
        "audits": {"energy_growth": 1},
    }


def last_frame(run):
    return "frames/" + max(path.name for path in (run.folder / "frames").glob("frame_*.hdf"))


def check(verification, model, dimension, update="modified_last"):
    one = verification.run(scene(model, dimension, update), threads=1)
    for threads in (2, 3) if FULL else (2,):
        other = verification.run(scene(model, dimension, update), threads=threads,
                                 options=("--all-threads",))
        label = f"{model}, {dimension}, {update}, 1 and {threads} threads"
        verification.equal(f"{label}: state hash", other.receipt["state_hash"],
                           one.receipt["state_hash"])
        verification.equal(f"{label}: history.bin", other.digest("history.bin"),
                           one.digest("history.bin"))
        verification.equal(f"{label}: last frame",
                           other.digest(last_frame(other)), one.digest(last_frame(one)))


verification = Verification("determinism")
for model in MATERIALS:
    check(verification, model, "plane_strain")
check(verification, "drucker_prager_cap", "solid")
check(verification, "linear_elastic", "plane_strain", "last")
verification.finish()
