# SPDX-License-Identifier: Apache-2.0
"""The problems of the charts of accuracy against cost: each a scene per resolution and method, and an
error against something that no method has computed."""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verification" / "manufactured"))
import manufactured

ROOT = pathlib.Path(__file__).resolve().parents[3]


def takes(problem, label):
    """Whether a method is compared on a problem."""
    return "," not in label or not getattr(problem, "shapes_only", False)


class Refused(Exception):
    """The method is not for this problem."""


class Failed(Exception):
    """The run came to no end, or to none that counts."""


def last_line(text):
    lines = text.strip().splitlines()
    return lines[-1][:160] if lines else ""


def run_scene(scene):
    """(history columns, metrics) of a scene."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.json").write_text(json.dumps(scene))
        answer = subprocess.run([os.environ["TALUS_WORKER"], "run", folder / "scene.json", "--out",
                                 folder / "out", "--threads", "1", "--quiet"],
                                capture_output=True, text=True)
        if answer.returncode == 10:
            raise Refused(last_line(answer.stderr))
        if answer.returncode != 0:
            raise Failed(f"exit code {answer.returncode}: {last_line(answer.stderr)}")
        with open(folder / "out" / "history.csv", newline="") as file:
            rows = list(csv.reader(file))
        columns = {key: [float(row[k]) for row in rows[1:]] for k, key in enumerate(rows[0])}
        metrics = json.loads((folder / "out" / "receipt.json").read_text())["metrics"]
    return columns, metrics


def outcome(error, scene, metrics):
    """Processor time without that of a run of hardly a step: start-up says nothing of a method."""
    short = dict(scene, duration=1e-6 * scene["duration"])
    short["output"] = {"history": {"every": short["duration"]}}
    short["audits"] = {"energy_growth": 1}  # of next to no energy
    _, start = run_scene(short)
    return {"error": error, "particle_steps": metrics["particles"] * metrics["steps"],
            "seconds": max(1e-3, metrics["cpu_seconds"] - start["cpu_seconds"])}


class Manufactured:
    """Largest root mean square miss of the particles' places over the run, by the amplitude."""

    def __init__(self, problem, resolutions):
        self.name, self.problem, self.resolutions = f"manufactured {problem}", problem, resolutions
        self.error = "root mean square miss / amplitude"

    def solve(self, cells, method):
        try:
            found = manufactured.solve(self.problem, cells, method)
        except manufactured.Refused as refusal:
            raise Refused(last_line(str(refusal))) from refusal
        except manufactured.Unstable as failure:
            raise Failed(last_line(str(failure))) from failure
        return {"error": found["rms"], "particle_steps": found["particle_steps"],
                "seconds": found["seconds"]}


class Spatial:
    """A problem in two dimensions, or in three with the same answer: of shapes alone, and without
    the finest resolution, for the time that CPDI takes there."""

    def __init__(self, axes=2):
        self.axes = axes
        if axes == 3:
            self.name += " 3D"
            self.resolutions = self.resolutions[:-1]
            self.shapes_only = True

    def vector(self, x, y, z):
        return [x, y, z][:self.axes]


class Cantilever(Spatial):
    """A clamped beam, ten times as long as high, in its first mode, over one period: distance of the
    tip's path from the one of Timoshenko's theory (mast-6.2). In three dimensions with a square
    section."""

    name, error = "cantilever", "tip path, root mean square / amplitude"
    resolutions = (1, 2, 3, 4)  # cells over the height
    LENGTH, HEIGHT, SPEED = 10.0, 1.0, 0.1
    PERIOD = 0.122801  # Timoshenko, shear factor 5/6

    def scene(self, cells, method):
        cell = self.HEIGHT / cells
        middle = self.HEIGHT / 2
        return {"title": f"{self.name}, {cells} cells",
                "dimension": "solid" if self.axes == 3 else "plane_stress",
                "duration": self.PERIOD,
                "grid": {"cell": cell, "min": self.vector(0, -1, -1),
                         "max": self.vector(11, 2, 2)},
                "solver": dict({"strain": "small"}, **method),
                "materials": {"metal": {"model": "linear_elastic", "density": 2710,
                                        "bulk_modulus": 70.28e9, "shear_modulus": 26.23e9}},
                "bodies": [{"name": "beam", "material": "metal",
                            "box": {"min": self.vector(0, 0, 0),
                                    "max": self.vector(self.LENGTH, self.HEIGHT, self.HEIGHT)},
                            "particles_per_cell": self.vector(2, 2, 2),
                            "velocity": {"beam_mode": {
                                "mode": 1, "from": self.vector(0, middle, middle),
                                "to": self.vector(self.LENGTH, middle, middle),
                                "tip": self.vector(0, self.SPEED, 0)}}}],
                "boundaries": [{"name": "clamp", "condition": "stick",
                                "plane": {"point": self.vector(0, 0, 0),
                                          "normal": self.vector(1, 0, 0)}}],
                "probes": [{"name": "beam", "kind": "centre_of_mass", "component": "y"}],
                "output": {"history": {"every": self.PERIOD / 200}}}

    def solve(self, cells, method):
        scene = self.scene(cells, method)
        columns, metrics = run_scene(scene)
        time, found = columns["time"], columns["probe.beam"]
        omega = 2 * math.pi / self.PERIOD
        # The mean of the first mode over the length is s1 / z1 of its tip.
        amplitude = self.SPEED / omega * 0.7340955 / 1.8751041
        square = [(y - found[0] - amplitude * math.sin(omega * t)) ** 2
                  for t, y in zip(time, found)]
        return outcome(math.sqrt(sum(square) / len(square)) / amplitude, scene, metrics)


class DamBreak:
    """Front and height of a collapsing water column against the experiment (Martin and Moyce 1952), at
    a hundredth of the water's stiffness. The experiment itself is known to some 5 %."""

    name, error = "dam break", "front and height, root mean square relative"
    resolutions = (3, 4, 5, 6)  # cells over the width

    def __init__(self):
        path = ROOT / "clients" / "scenes" / "mast-6.1.1-dam-break-a2.json"
        self.shipped = json.loads(path.read_text())

    def scene(self, cells, method):
        scene = json.loads(json.dumps(self.shipped))
        cell = 0.057 / cells
        scene["grid"]["cell"] = cell
        scene["solver"] = dict({"stabilise": {"viscous_damping": 0.5}}, **method)
        scene["materials"]["water"]["bulk_modulus"] = 2e7
        scene["bodies"][0].pop("count")
        scene["bodies"][0]["particles_per_cell"] = [3, 3]
        scene["output"] = {"history": scene["output"]["history"]}
        return scene

    def solve(self, cells, method):
        scene = self.scene(cells, method)
        _, metrics = run_scene(scene)
        square = metrics["error.front"] ** 2 + metrics["error.height"] ** 2
        return outcome(math.sqrt(square / 2), scene, metrics)


class Column(Spatial):
    """An elastic column that settles by its own weight to 6 % less height, damped, until it rests: mean
    height against the exact one. Equilibrium in the first state asks for P = -rho g (H - Y) whatever
    the law; with the Hencky law ln J / J = P / M, Y from 0 to H."""

    name, error = "column at rest", "settlement of the centre of mass, relative"
    resolutions = (8, 16, 24, 32)  # cells over the height
    HEIGHT, DENSITY, MODULUS, GRAVITY = 1.0, 1000.0, 1e5, 10.0

    def stretch(self, pressure):
        """J with ln J / J = pressure / M, by Newton's iteration."""
        j = 1.0
        for _ in range(50):
            residual = math.log(j) / j - pressure / self.MODULUS
            j -= residual / ((1 - math.log(j)) / (j * j))
        return j

    def settlement(self, count=4000):
        """Of the centre of mass: the mean over Y of the integral of 1 - J from 0 to Y."""
        step = self.HEIGHT / count
        below, mean = 0.0, 0.0
        for k in range(count):
            height = (k + 0.5) * step
            shrunk = (1 - self.stretch(-self.DENSITY * self.GRAVITY * (self.HEIGHT - height))) * step
            mean += (below + shrunk / 2) * step / self.HEIGHT
            below += shrunk
        return mean

    def scene(self, cells, method):
        cell = self.HEIGHT / cells
        speed = math.sqrt(self.MODULUS / self.DENSITY)
        period = 4 * self.HEIGHT / speed
        method = json.loads(json.dumps(method))
        method.setdefault("stabilise", {}).update({"local_damping": 0.3, "force_ramp": 2 * period})
        wide = 2 * cell
        far = [wide, 0, wide]
        walls = [("floor", [0, 0, 0], [0, 1, 0]), ("left", [0, 0, 0], [1, 0, 0]),
                 ("right", far, [-1, 0, 0]), ("back", [0, 0, 0], [0, 0, 1]),
                 ("front", far, [0, 0, -1])][:2 * self.axes - 1]
        return {"title": f"{self.name}, {cells} cells",
                "dimension": "solid" if self.axes == 3 else "plane_strain",
                "duration": 12 * period,
                "grid": {"cell": cell, "min": self.vector(0, 0, 0),
                         "max": self.vector(wide, self.HEIGHT + 2 * cell, wide)},
                "solver": method,
                "materials": {"soil": {"model": "linear_elastic", "density": self.DENSITY,
                                       "young_modulus": self.MODULUS, "poisson_ratio": 0.0}},
                "bodies": [{"name": "column", "material": "soil",
                            "box": {"min": self.vector(0, 0, 0),
                                    "max": self.vector(wide, self.HEIGHT, wide)},
                            "particles_per_cell": self.vector(2, 2, 2)}],
                "gravity": self.vector(0, -self.GRAVITY, 0),
                "boundaries": [{"name": name, "plane": {"point": self.vector(*point),
                                                        "normal": self.vector(*normal)},
                                "condition": "slip"} for name, point, normal in walls],
                "probes": [{"name": "centre", "kind": "centre_of_mass", "component": "y"}],
                "output": {"history": {"every": period / 4}}}

    def solve(self, cells, method):
        scene = self.scene(cells, method)
        columns, metrics = run_scene(scene)
        centre = columns["probe.centre"]
        exact = self.settlement()
        late = centre[-8:]  # two periods
        return outcome(abs(centre[0] - sum(late) / len(late) - exact) / exact,
                       scene, metrics)


PROBLEMS = [Cantilever(), Manufactured("axis-aligned", (8, 16, 24, 32)),
            Manufactured("vortex", (24, 32, 40, 48)), DamBreak(), Column(),
            Cantilever(3), Column(3)]
