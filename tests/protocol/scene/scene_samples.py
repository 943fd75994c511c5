# SPDX-License-Identifier: Apache-2.0
"""Scenes for tests, and talus-worker helper as a conversation."""
import copy
import json
import subprocess

BLOCK = {
    "dimension": "plane_strain",
    "duration": 1.0,
    "grid": {"cell": 0.5, "min": [0, 0], "max": [20, 10]},
    "materials": {
        "soil": {"model": "drucker_prager_cap", "density": 2000, "bulk_modulus": 8.33e6,
                 "shear_modulus": 3.85e6, "friction_angle": 30, "cone_strength": 10}},
    "gravity": [0, -9.81],
    "bodies": [{"name": "heap", "material": "soil", "box": {"min": [0, 0], "max": [4, 2]},
                "particles_per_cell": [2, 2], "initial_stress": {"geostatic": {"k0": "auto"}}}],
    "boundaries": [
        {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "friction",
         "friction_angle": 30},
        {"name": "pile", "box": {"min": [8, 0], "max": [10, 6]}, "condition": "slip",
         "tension_release": True, "faces": {"y_max": {"condition": "stick"}}}],
    "probes": [
        {"name": "runout", "kind": "front", "along": [1, 0], "on": "floor"},
        {"name": "load", "kind": "reaction", "boundary": "pile", "face": "x_min",
         "component": "x", "mean_from": 0.5},
        {"name": "tip", "kind": "point", "at": [4, 0], "field": "stress",
         "within": {"min": [None, 0]}}],
    "references": [{"probe": "runout", "curve": [[0, 4], [1, 6]]},
                   {"name": "again", "probe": "runout", "value": 5}],
    "output": {"frames": {"every": 0.1, "fields": ["velocity"], "grid_fields": ["reaction"]}},
}

BALL = {
    "title": "a ball on a plate",
    "dimension": "solid",
    "duration": 0.5,
    "grid": {"cell": [0.5, 0.5, 0.5], "min": [0, 0, 0], "max": [10, 10, 10],
             "outside": "eliminate"},
    "solver": {"time_step": 1e-4, "strain": "small", "stress_update": "last",
               "stabilise": {"local_damping": 0.1, "force_ramp": 0.1}},
    "materials": {"rubber": {"model": "linear_elastic", "density": 1000, "young_modulus": 1e6,
                             "poisson_ratio": 0.3}},
    "bodies": [{"material": "rubber", "sphere": {"centre": [5, 5, 5], "radius": 1},
                "clip": {"min": [5, None, None]}, "spacing": 0.25, "velocity": [0, -1, 0],
                "initial_stress": [-1, -1, -1, 0, 0, 0]}],
    "boundaries": [
        {"face": {"min": [2, 0, 2], "max": [8, 0, 8], "normal": [0, 1, 0]}, "condition": "stick",
         "tension_release": 5},
        {"face": {"point": [5, 0, 9], "normal": [0, 1, 0], "size": [1, 2]},
         "condition": "eliminate"}],
    "audits": {"energy_growth": 0.02},
}

WATER = {
    "dimension": "plane_strain",
    "duration": 0.2,
    "grid": {"cell": 0.01, "min": [0, 0], "max": [0.3, 0.14]},
    "solver": {"anti_locking": {"control": "cell", "field": "volumetric"}},
    "materials": {"water": {"model": "newtonian_fluid", "density": 1000, "bulk_modulus": 2e6,
                            "viscosity": 0.001, "no_tension": True}},
    "gravity": [0, -9.81],
    "bodies": [{"material": "water", "box": {"min": [0, 0], "max": [0.06, 0.12]},
                "count": [12, 24], "initial_stress": {"hydrostatic": {"surface": 0.12}}}],
    "boundaries": [{"plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "slip"}],
}

SAND = {
    "dimension": "plane_strain",
    "duration": 0.6,
    "grid": {"cell": 0.005, "min": [0, 0], "max": [0.4, 0.15]},
    "materials": {
        "sand": {"model": "matsuoka_nakai", "density": 2200, "bulk_modulus": 29.5e6,
                 "shear_modulus": 13.6e6, "dilation_angle": 0,
                 "friction": {"a0": 35, "a1": 9, "a3": 0.30, "a4": 10, "strain_scale": 100}}},
    "gravity": [0, -9.81],
    "bodies": [{"material": "sand", "box": {"min": [0, 0], "max": [0.05, 0.10]},
                "particles_per_cell": [4, 4], "initial_stress": {"geostatic": {"k0": 0.43}}}],
}

SCENES = {"block": BLOCK, "ball": BALL, "water": WATER, "sand": SAND}


def changed(scene, keys, value=None, remove=False):
    """A copy of a scene with one value set or removed; keys: list of keys and indices."""
    result = copy.deepcopy(scene)
    place = result
    for key in keys[:-1]:
        place = place[key]
    if remove:
        del place[keys[-1]]
    else:
        place[keys[-1]] = value
    return result


class Helper:
    """One talus-worker helper process."""

    def __init__(self, worker):
        self.process = subprocess.Popen([worker, "helper"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE)

    def ask_text(self, line):
        self.process.stdin.write(line + b"\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def ask(self, **question):
        return self.ask_text(json.dumps(question).encode())

    def close(self):
        """Exit code after the end of the input."""
        self.process.stdin.close()
        self.process.stdout.close()
        return self.process.wait(timeout=10)
