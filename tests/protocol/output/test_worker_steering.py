# SPDX-License-Identifier: Apache-2.0
"""Orders to a run with the real solver: a moved end gives the bits of a run that was made with it,
looking changes nothing, kills lose no order; and the receipt's command repeats the bits."""
import hashlib
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import time

import worker_run

# A step takes some thirty times as long under sanitizers: fewer of them leave the same time to give
# an order in.
LONGER = 20 if os.environ.get("TALUS_SANITIZE") == "ON" else 1


def block(duration=0.3, **solver):
    """A soft block that falls on a floor, in some 10,000 steps per 0.1 s of it (500 sanitized)."""
    return {
        "title": "falling block",
        "dimension": "plane_strain",
        "duration": duration,
        "grid": {"cell": 0.05, "min": [0, 0], "max": [1.0, 1.0]},
        "solver": {"shape": "linear", "courant": 0.005 * LONGER, **solver},
        "materials": {"rubber": {"model": "linear_elastic", "density": 1000,
                                 "young_modulus": 1e6, "poisson_ratio": 0.3}},
        "bodies": [{"name": "block", "material": "rubber", "velocity": [0, -1.0],
                    "box": {"min": [0.3, 0.1], "max": [0.7, 0.5]}, "particles_per_cell": [2, 2]}],
        "gravity": [0, -9.81],
        "boundaries": [{"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
                        "condition": "friction", "friction_coefficient": 0.3}],
        "probes": [{"name": "top", "kind": "height"}],
        "output": {"frames": {"every": 0.05, "fields": ["velocity", "stress"]},
                   "history": {"every": 0.002}, "checkpoints": {"every": 0.02}},
    }


class SteeringTest(worker_run.RunTest):
    def order(self, process=None, job="job", **orders):
        aside = self.folder / job / ".control.new"
        aside.write_text(json.dumps(orders))
        aside.rename(self.folder / job / "control.json")
        if process is not None:
            process.send_signal(signal.SIGUSR1)

    def receipt(self, job="job"):
        return json.loads((self.folder / job / "receipt.json").read_text())

    def finish(self, process):
        _, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, errors)

    def assert_same_physics(self, job, other):
        self.assertEqual(self.receipt(job)["state_hash"], self.receipt(other)["state_hash"])
        self.assertEqual(self.digest(job, "history.bin"), self.digest(other, "history.bin"))

    def test_a_shorter_and_a_longer_run(self):
        for given, wanted, solver in ((1000.0, 0.3, {}), (1000.0, 0.20001, {"time_step": 2e-5 * LONGER}),
                                      (0.2, 0.3, {})):
            name = f"{given:g} to {wanted:g}"
            with self.subTest(name):
                plain, job = f"plain {name}", f"job {name}"
                self.run_job(block(wanted, **solver), plain)
                process = self.start(block(given, **solver), job)
                self.wait_for(job, "frame")
                self.order(process, job, end_time=wanted)
                self.finish(process)
                self.assert_same_physics(plain, job)
                receipt = self.receipt(job)
                self.assertTrue(receipt["steered"])
                self.assertEqual(receipt["metrics"]["time"], wanted)
                note, = receipt["steering"]
                self.assertEqual((note["what"], note["wanted"], note["from"], note["to"]),
                                 ("end_time", wanted, given, wanted))
                self.assertLess(note["time"], wanted)
                self.assertGreaterEqual(note["step"], 0)
                self.assertRegex(note["at"], r"^\d{4}-\d\d-\d\dT")
                self.assertEqual(self.events(job, "progress")[-1]["fraction"], 1.0)
                self.repeat(job)
        self.assertFalse(self.receipt(plain)["steered"])

    def test_an_end_in_the_past_is_the_present(self):
        process = self.start(block(1000.0))
        self.wait_for("job", "frame", 2)
        self.order(process, end_time=1e-6)
        self.finish(process)
        note, = self.receipt()["steering"]
        self.assertEqual(note["wanted"], 1e-6)
        self.assertGreaterEqual(note["time"], 0.04)
        self.assertEqual(self.receipt()["metrics"]["time"], note["time"])
        self.assertEqual(self.events(kind="frame")[-1]["time"], note["time"])
        self.repeat("job")

    def test_looking_changes_nothing(self):
        self.run_job(block(0.3), "plain")
        process = self.start(block(0.3))
        self.wait_for("job", "frame")
        looks = 0
        while process.poll() is None and looks < 20:
            looks += 1
            self.order(process, frame_now=looks, checkpoint_now=looks)
            time.sleep(0.01)
        self.finish(process)
        self.assert_same_physics("plain", "job")
        times = [frame["time"] for frame in self.events("plain", "frame")]
        more = {frame["time"]: frame["file"] for frame in self.events("job", "frame")}
        self.assertGreater(len(more), len(times))
        for index, moment in enumerate(times):
            self.assertEqual(self.digest("plain", f"frames/frame_{index:06d}.hdf"),
                             self.digest("job", more[moment]))
        self.assertIn("frame_now", [note["what"] for note in self.receipt()["steering"]])

    def test_orders_survive_kills(self):
        """Orders are given, the run is killed before and after it hears of them, and resumed."""
        self.run_job(block(0.3), "plain")
        process = self.start(block(1000.0))
        self.wait_for("job", "frame")
        self.order(None, end_time=0.3, frame_now=1)  # nobody is told
        process.kill()
        process.wait()
        process = self.start(block(1000.0), "job", "--resume")
        self.wait_for("job", "checkpoint")
        process.kill()
        process.wait()
        process = self.start(block(1000.0), "job", "--resume")
        self.finish(process)
        self.assert_same_physics("plain", "job")
        notes = self.receipt()["steering"]
        self.assertEqual(len([note for note in notes if note["what"] == "end_time"]), 1, notes)
        self.assertLessEqual(len([note for note in notes if note["what"] == "frame_now"]), 1, notes)

    def test_the_command_repeats_a_resumed_run(self):
        process = self.start(block(0.3))
        self.wait_for("job", "checkpoint")
        process.kill()
        process.wait()
        self.run_job(block(0.3), "job", "--resume")
        self.repeat("job")

    def repeat(self, job):
        """Runs the receipt's command in a fresh folder beside nothing but scene.json."""
        receipt = self.receipt(job)
        fresh = self.folder / ("fresh " + job)
        fresh.mkdir()
        shutil.copy(self.folder / job / "scene.json", fresh)
        programs = str(pathlib.Path(worker_run.worker()).parent)
        environment = dict(os.environ, PATH=programs + ":" + os.environ["PATH"])
        result = subprocess.run(["/bin/sh", "-c", receipt["command"]], cwd=fresh, env=environment,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                timeout=120, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        words = shlex.split(receipt["command"])
        repeated = fresh / words[words.index("--out") + 1]
        compared = 0
        for entry in receipt["results"]:
            content = (repeated / entry["file"]).read_bytes()
            if not entry.get("varies"):
                compared += 1
                self.assertEqual(hashlib.sha256(content).hexdigest(), entry["sha256"], entry)
        self.assertGreaterEqual(compared, 2)
        other = json.loads((repeated / "receipt.json").read_text())
        for key in ("state_hash", "scene_hash", "build", "isa"):
            self.assertEqual(other[key], receipt[key], key)


if __name__ == "__main__":
    worker_run.main()
