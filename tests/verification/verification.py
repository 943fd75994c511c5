# SPDX-License-Identifier: Apache-2.0
"""What all verification checks share: running scenes and points, reading results, judging figures.

A check states each tolerance in its call before the figure is known; every comparison is printed,
and one that fails makes the check fail. TALUS_FULL=1 asks for the full form of a problem.
TALUS_VERIFICATION_TABLE=FILE appends every comparison to FILE as a row of a Markdown table.
"""
import csv
import hashlib
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

FULL = os.environ.get("TALUS_FULL") == "1"
PROCESSOR_TIME = "processor time [s]"
SHIPPED_SCENES = pathlib.Path(__file__).resolve().parents[2] / "clients" / "scenes"


def worker():
    return os.environ["TALUS_WORKER"]


def shipped_scene(name):
    return json.loads((SHIPPED_SCENES / (name + ".json")).read_text())


def log_tail(folder):
    log = pathlib.Path(folder) / "log.txt"
    return log.read_text()[-2000:] if log.exists() else ""


def on_linear_shapes(scene):
    """A check rests on the functions that it names, or else on linear ones: never on the default of
    scenes, which the charts choose."""
    return dict(scene, solver={"shape": "linear", **scene.get("solver", {})})


class Run:
    """The results of one scene in a folder of its own."""

    def __init__(self, folder, exit_code, messages):
        self.folder = pathlib.Path(folder)
        self.exit_code = exit_code
        self.messages = messages
        receipt = self.folder / "receipt.json"
        self.receipt = json.loads(receipt.read_text()) if receipt.exists() else {}
        self.metrics = self.receipt.get("metrics", {})
        self.series = self._read_history()

    def _read_history(self):
        path = self.folder / "history.csv"
        if not path.exists():
            return {}
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
        return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}

    @property
    def time(self):
        return self.series["time"]

    def probe(self, name):
        return self.series["probe." + name]

    def reaction(self, name, component):
        return self.series[f"reaction.{name}.force.{component}"]

    def impulse(self, name, component):
        """Integral of the interval force: force is impulse over interval, so nothing is lost."""
        force = self.reaction(name, component)
        return math.fsum(force[k] * (self.time[k] - self.time[k - 1])
                         for k in range(1, len(force)))

    def value_at(self, series, when):
        """Linear interpolation in a series of the history."""
        values = self.series[series]
        for k in range(1, len(values)):
            if self.time[k] >= when:
                share = (when - self.time[k - 1]) / (self.time[k] - self.time[k - 1])
                return values[k - 1] + share * (values[k] - values[k - 1])
        return values[-1]

    def mean(self, series, begin, end=math.inf):
        """Mean over an interval of time, by the trapezoidal rule."""
        chosen = [(t, v) for t, v in zip(self.time, self.series[series]) if begin <= t <= end]
        area = sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(chosen, chosen[1:]))
        return area / (chosen[-1][0] - chosen[0][0])

    def frame(self, index=-1):
        """Fields of a frame as numpy arrays, with "position", "time" and "id" order kept."""
        import h5py
        path = sorted((self.folder / "frames").glob("frame_*.hdf"))[index]
        with h5py.File(path) as file:
            root = file["VTKHDF"]
            fields = {name: data[...] for name, data in root["PointData"].items()}
            fields["position"] = root["Points"][...]
            fields["time"] = float(root["FieldData/Time"][0])
        return fields

    def digest(self, name):
        return hashlib.sha256((self.folder / name).read_bytes()).hexdigest()


class Verification:
    """One problem: runs its scenes and collects comparisons."""

    def __init__(self, problem):
        self.problem = problem
        self.failed = 0
        self.scratch = tempfile.TemporaryDirectory(prefix="talus-verification-")
        self.run_count = 0
        print(f"{problem}, {'full' if FULL else 'reduced'} form")

    def new_folder(self):
        self.run_count += 1
        folder = pathlib.Path(self.scratch.name) / f"run-{self.run_count}"
        folder.mkdir()
        return folder

    def command(self, scene_path, folder, threads, *options):
        return [worker(), "run", str(scene_path), "--out", str(folder),
                "--threads", str(threads), "--quiet", *options]

    def run(self, scene, threads=1, expected_exit=0, folder=None, options=()):
        """Runs a scene (a dict) to its end, with linear shapes unless it has others; any other exit code than the expected one is an
        error of the check itself."""
        folder = folder or self.new_folder()
        path = folder.parent / (folder.name + ".json")
        path.write_text(json.dumps(on_linear_shapes(scene)))
        begin = time.monotonic()
        ended = subprocess.run(self.command(path, folder, threads, *options),
                               capture_output=True, text=True)
        if ended.returncode != expected_exit:
            sys.exit(f"{scene.get('title', 'scene')}: exit code {ended.returncode}, "
                     f"expected {expected_exit}\n{ended.stdout[-2000:]}\n{ended.stderr[-2000:]}"
                     f"{log_tail(folder)}")
        run = Run(folder, ended.returncode, ended.stderr)
        print(f"  ran '{scene.get('title', '')}': {run.metrics.get('steps', 0):.0f} steps, "
              f"{run.metrics.get('particles', 0):.0f} particles, "
              f"{time.monotonic() - begin:.1f} s")
        return run

    def interrupt(self, scene, folder, signal_number, is_time, threads=1, timeout=60):
        """Starts a scene, sends a signal when is_time(folder) holds, returns the exit code."""
        path = folder.parent / (folder.name + ".json")
        path.write_text(json.dumps(on_linear_shapes(scene)))
        process = subprocess.Popen(self.command(path, folder, threads),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + timeout
        while process.poll() is None and time.monotonic() < deadline:
            if is_time(folder):
                process.send_signal(signal_number)
                break
            time.sleep(0.005)
        else:
            process.kill()
            process.wait()
            sys.exit("the run ended before it could be interrupted")
        return process.wait(timeout=timeout)

    def point(self, path):
        """Drives one material point; returns its steps."""
        file = self.new_folder() / "path.json"
        file.write_text(json.dumps(path))
        ended = subprocess.run([worker(), "point", str(file)], capture_output=True, text=True)
        if ended.returncode != 0:
            sys.exit(f"point: exit code {ended.returncode}\n{ended.stdout[-2000:]}"
                     f"\n{ended.stderr[-2000:]}")
        return [json.loads(line) for line in ended.stdout.splitlines()]

    def _judge(self, quantity, tolerance, value, good, good_word="ok"):
        verdict = good_word if good else "FAILED"
        self.failed += not good
        print(f"  {verdict:6} {quantity}: {value} (tolerance: {tolerance})")
        self._write_row(quantity, tolerance, value, verdict)

    def _write_row(self, quantity, tolerance, value, verdict):
        table = os.environ.get("TALUS_VERIFICATION_TABLE")
        if table:
            with open(table, "a") as file:
                file.write(f"| {self.problem} | {quantity} | {tolerance} | {value} "
                           f"| {'full' if FULL else 'reduced'} | {verdict} |\n")

    def relative(self, quantity, value, expected, tolerance):
        error = abs(value - expected) / abs(expected)
        self._judge(quantity, f"{tolerance:g} relative",
                    f"{value:.7g} for {expected:.7g}, off by {error:.2g}", error <= tolerance)

    def absolute(self, quantity, value, expected, tolerance):
        error = abs(value - expected)
        self._judge(quantity, f"{tolerance:g} absolute",
                    f"{value:.7g} for {expected:.7g}, off by {error:.2g}", error <= tolerance)

    def between(self, quantity, value, low, high):
        self._judge(quantity, f"{low:.6g} to {high:.6g}", f"{value:.6g}", low <= value <= high)

    def below(self, quantity, value, limit):
        self._judge(quantity, f"below {limit:g}", f"{value:.3g}", value < limit)

    def above(self, quantity, value, limit):
        self._judge(quantity, f"above {limit:g}", f"{value:.4g}", value > limit)

    def equal(self, quantity, value, expected):
        self._judge(quantity, "equal", f"{value}" if value == expected
                    else f"{value} is not {expected}", value == expected)

    def deviation(self, quantity, value, aim, guard):
        """A figure that is known to miss its aim, for a reason that the README gives. It is reported
        as such, fails when it gets worse than the guard, and when it starts to meet the aim (then the
        check must be made a plain one)."""
        if value <= aim:
            self._judge(quantity, f"above {aim:g}: it now meets its aim, tighten the check",
                        f"{value:.4g}", False)
            return
        self._judge(quantity, f"aim {aim:g}, missed and known; at most {guard:g}",
                    f"{value:.4g}", value <= guard, "misses")

    def note(self, quantity, value, reason):
        """A figure that is reported and not judged."""
        self._judge(quantity, f"none: {reason}", f"{value:.4g}", True, "note")

    def finish(self):
        self.scratch.cleanup()
        spent = os.times()
        self._write_row(PROCESSOR_TIME, "none: reported", f"{sum(spent[:4]):.1f}", "note")
        sys.exit(1 if self.failed else 0)


def particle_bodies(points, size, material, velocity):
    """One body per particle: a lattice that the scene's shapes cannot say (a rotated block, a
    velocity that varies). `points` are centres, `size` the edge lengths of a particle,
    `velocity` a function of the centre."""
    bodies = []
    for centre in points:
        bodies.append({
            "material": material,
            "box": {"min": [c - s / 2 for c, s in zip(centre, size)],
                    "max": [c + s / 2 for c, s in zip(centre, size)]},
            "count": [1] * len(centre),
            "velocity": list(velocity(centre)),
        })
    return bodies
