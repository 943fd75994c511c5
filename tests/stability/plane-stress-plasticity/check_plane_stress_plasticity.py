# SPDX-License-Identifier: Apache-2.0
"""Plane stress with plastic flow: the elastic strain across the plane does not keep sigma_zz at zero,
so scenes that ask for it are refused."""
import json
import subprocess

from verification import Verification, worker

YOUNG, POISSON, YIELD = 70e9, 0.3, 2e8
METAL = {"model": "j2", "density": 2700, "young_modulus": YOUNG, "poisson_ratio": POISSON,
         "yield_stress": YIELD}
SOIL = {"density": 2000, "young_modulus": 1e7, "poisson_ratio": 0.3, "friction_angle": 30}
REFUSED = {"j2": METAL,
           "drucker_prager": {**SOIL, "model": "drucker_prager"},
           "mohr_coulomb": {**SOIL, "model": "mohr_coulomb"},
           "newtonian_fluid": {"model": "newtonian_fluid", "density": 1000, "bulk_modulus": 1e7}}
# Three times the strain at yield, along x only.
STRETCH = 3 * YIELD * (1 - POISSON ** 2) / YOUNG


def scene(material):
    return {
        "title": "sheet", "dimension": "plane_stress", "duration": 1e-4,
        "grid": {"cell": 0.1, "min": [0, 0], "max": [2, 2]},
        "materials": {"sheet": material},
        "bodies": [{"material": "sheet", "box": {"min": [0.5, 0.5], "max": [1.5, 1.0]},
                    "particles_per_cell": [2, 2], "velocity": [1, 0]}],
    }


def check(verification, material):
    """Exit code and mistakes of `talus-worker check`."""
    path = verification.new_folder() / "scene.json"
    path.write_text(json.dumps(scene(material)))
    ended = subprocess.run([worker(), "check", "--json", str(path)], capture_output=True, text=True)
    return ended.returncode, json.loads(ended.stdout).get("errors", [])


def stretch(verification, segment):
    return verification.point({"material": METAL, "path": [{**segment, "steps": 300}]})[-1]


verification = Verification("plane-stress-plasticity")
elastic = stretch(verification, {"strain": {"xx": 0.3 * STRETCH,
                                            "zz": -POISSON / (1 - POISSON) * 0.3 * STRETCH}})
verification.below("elastic sheet: sigma_zz over sigma_xx",
                   abs(elastic["stress"][2] / elastic["stress"][0]), 1e-12)
naive = stretch(verification, {"strain": {"xx": STRETCH,
                                          "zz": -POISSON / (1 - POISSON) * STRETCH}})
verification.above("J2 with the elastic strain across: sigma_zz over the yield stress",
                   abs(naive["stress"][2]) / YIELD, 0.1)
iterated = stretch(verification, {"strain": {"xx": STRETCH}, "stress": {"zz": 0}})
verification.below("J2 with sigma_zz = 0 by iteration: sigma_zz over the yield stress",
                   abs(iterated["stress"][2]) / YIELD, 1e-6)
for model, material in REFUSED.items():
    code, errors = check(verification, material)
    verification.equal(f"{model}: exit code of check", code, 10)
    verification.equal(f"{model}: mistake", [(error["pointer"], error["code"]) for error in errors],
                       [("/materials/sheet/model", "contradiction")])
code, errors = check(verification, {key: METAL[key] for key in METAL if key != "yield_stress"}
                     | {"model": "linear_elastic"})
verification.equal("linear_elastic: exit code of check", (code, errors), (0, []))
verification.finish()
