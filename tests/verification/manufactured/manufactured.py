# SPDX-License-Identifier: Apache-2.0
"""Scenes of the manufactured solutions, and how to run them: for the check and for the charts of
accuracy against cost."""
import json
import os
import pathlib
import subprocess
import tempfile

MATERIALS = {
    "axis-aligned": {"model": "linear_elastic", "density": 1000.0, "young_modulus": 1e7,
                     "poisson_ratio": 0.3},
    "vortex": {"model": "linear_elastic", "density": 1000.0, "young_modulus": 1000.0,
               "poisson_ratio": 0.3},
}
DURATIONS = {"axis-aligned": 0.02, "vortex": 2.0}


def program():
    return os.environ["TALUS_MANUFACTURED"]


def square(cells, per_cell):
    """The unit square between smooth walls, with room for functions that reach beyond."""
    walls = [("left", [0, 0], [1, 0]), ("right", [1, 0], [-1, 0]),
             ("bottom", [0, 0], [0, 1]), ("top", [0, 1], [0, -1])]
    cell = 1 / cells
    return {"grid": {"cell": cell, "min": [0, 0], "max": [1, 1]},
            "bodies": [{"name": "square", "material": "solid",
                        "box": {"min": [0, 0], "max": [1, 1]},
                        "particles_per_cell": [per_cell, per_cell]}],
            "boundaries": [{"name": name, "plane": {"point": point, "normal": normal},
                            "condition": "slip"} for name, point, normal in walls]}


def disc(cells, per_cell):
    """A disc whose ring between the radii 0.75 and 1.25 turns; cells: over a width of 3 m."""
    return {"grid": {"cell": 3 / cells, "min": [-1.5, -1.5], "max": [1.5, 1.5]},
            "bodies": [{"name": "disc", "material": "solid",
                        "sphere": {"centre": [0, 0], "radius": 1.4},
                        "particles_per_cell": [per_cell, per_cell]}]}


GEOMETRY = {"axis-aligned": square, "vortex": disc}


def scene(problem, cells, method, per_cell=2):
    made = GEOMETRY[problem](cells, per_cell)
    made.update({"title": f"manufactured solution {problem}, {cells} cells",
                 "dimension": "plane_strain", "duration": DURATIONS[problem],
                 "solver": {"kind": "explicit", "shape": "linear", **method},
                 "materials": {"solid": MATERIALS[problem]},
                 "output": {"history": {"every": DURATIONS[problem]}}})
    return made


class Refused(Exception):
    pass


class Unstable(Exception):
    pass


def solve(problem, cells, method, per_cell=2):
    """{"rms", "largest", "particles", "particle_steps", "seconds"}; errors relative to the largest
    displacement, the largest of 20 instants."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.json"
        path.write_text(json.dumps(scene(problem, cells, method, per_cell)))
        answer = subprocess.run([program(), problem, path], capture_output=True, text=True)
    if answer.returncode == 10:
        raise Refused(answer.stderr)
    if answer.returncode == 11:
        raise Unstable(answer.stderr)
    if answer.returncode != 0:
        raise RuntimeError(answer.stderr)
    return json.loads(answer.stdout)
