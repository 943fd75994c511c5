# SPDX-License-Identifier: Apache-2.0
"""The client against the real daemon and worker: one job from submission to deletion."""
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

TALUS, TALUSD = "", ""

SCENE = {
    "title": "a square of water falls on a floor", "dimension": "plane_strain", "duration": 0.2,
    "grid": {"cell": 0.05, "min": [0, 0], "max": [1, 1]},
    "materials": {"water": {"model": "newtonian_fluid", "density": 1000, "bulk_modulus": 2e5}},
    "bodies": [{"name": "square", "material": "water", "particles_per_cell": [2, 2],
                "box": {"min": [0.3, 0.05], "max": [0.6, 0.3]}}],
    "gravity": [0, -9.81],
    "boundaries": [{"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
                    "condition": "slip"}],
    "output": {"frames": {"every": 0.05, "fields": ["velocity"]}, "history": {"every": 0.005}},
}


class WithDaemon(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.server = f"unix:{self.folder}/socket"
        self.start_daemon()

    def start_daemon(self):
        self.daemon = subprocess.Popen(
            [TALUSD, "--state", os.path.join(self.folder, "state"), "--listen", self.server],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.stop_daemon, self.daemon)
        for _ in range(200):
            if self.talus("list").returncode == 0:
                return
            time.sleep(0.05)
        self.fail("talusd does not answer")

    @staticmethod
    def stop_daemon(daemon):
        if daemon.poll() is None:
            daemon.terminate()
            daemon.wait(timeout=60)

    def talus(self, *arguments):
        environment = {**os.environ, "TALUS_SERVER": self.server}
        return subprocess.run([TALUS, *arguments], capture_output=True, text=True, check=False,
                              env=environment, cwd=self.folder, timeout=100)

    def run_json(self, *arguments):
        result = self.talus(*arguments, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)


class Jobs(WithDaemon):
    def write_scene(self, **changes):
        with open(os.path.join(self.folder, "scene.json"), "w", encoding="utf-8") as stream:
            json.dump({**SCENE, **changes}, stream)

    def test_life_of_a_job(self):
        self.write_scene()
        result = self.talus("submit", "scene.json", "--name", "water", "--label", "kind=test",
                            "--watch")
        self.assertEqual(result.returncode, 0, result.stderr)
        for text in ("queued", "running", "succeeded", "reaction.floor.peak"):
            self.assertIn(text, result.stdout)
        (job,) = self.run_json("list", "--label", "kind=test", "--state", "succeeded")
        self.assertEqual((job["name"], job["state"]), ("water", "succeeded"))
        self.assertEqual(self.run_json("list", "--state", "failed"), [])
        self.assertEqual(self.run_json("list", "--text", "no such name"), [])
        self.assertEqual(self.run_json("list", "--label", "kind=test", "--label", "a=b"), [])
        self.assertEqual(len(self.run_json("list", "--label", "kind=test", "--text", "")), 1)
        (floor,) = self.run_json("reactions", job["id"])
        self.assertEqual((floor["name"], floor["unit"]), ("floor", "N/m"))
        self.assertGreater(floor["peak"], 0.0)

        fetched = self.talus("fetch", job["id"], "--into", "out")
        self.assertEqual(fetched.returncode, 0, fetched.stderr)
        with open(os.path.join(self.folder, "out", "scene.json"), encoding="utf-8") as stream:
            self.assertEqual(json.load(stream)["title"], SCENE["title"])
        with open(os.path.join(self.folder, "out", "frames", "frame_000000.hdf"), "rb") as stream:
            digest = hashlib.sha256(stream.read()).hexdigest()
        events = self.talus("watch", job["id"], "--json").stdout.splitlines()
        frames = [event["data"] for event in map(json.loads, events) if event["event"] == "frame"]
        self.assertEqual(frames[0]["sha256"], digest)

        self.assertEqual(self.talus("cancel", job["id"]).returncode, 3)
        self.assertEqual(self.talus("delete", job["id"]).returncode, 0)
        self.assertEqual(self.talus("show", job["id"]).returncode, 3)

    def test_mistakes_come_with_their_pointers(self):
        self.write_scene(duration=-1, gravity=[0])
        result = self.talus("submit", "scene.json")
        self.assertEqual(result.returncode, 3)
        self.assertIn("/scene/duration", result.stderr)
        self.assertIn("/scene/gravity", result.stderr)

    def test_same_key_same_job(self):
        self.write_scene()
        first = self.run_json("submit", "scene.json", "--idempotency-key", "k")
        again = self.run_json("submit", "scene.json", "--idempotency-key", "k")
        self.assertEqual(first["id"], again["id"])

    def test_watch_goes_on_when_the_daemon_is_killed(self):
        walls = [{"name": name, "condition": "slip",
                  "plane": {"point": [at, 0], "normal": [normal, 0]}}
                 for name, at, normal in (("left", 0, 1), ("right", 1, -1))]
        self.write_scene(duration=5000, boundaries=SCENE["boundaries"] + walls,
                         output={"frames": {"every": 5000}, "history": {"every": 5}})
        job = self.run_json("submit", "scene.json")
        with subprocess.Popen([TALUS, "watch", job["id"], "--json", "--server", self.server],
                              stdout=subprocess.PIPE, text=True) as watch:
            for line in watch.stdout:
                if json.loads(line)["event"] == "progress":
                    break
            self.daemon.kill()
            self.daemon.wait()
            self.start_daemon()
            self.assertEqual(self.talus("cancel", job["id"]).returncode, 0)
            events = [json.loads(line) for line in watch.stdout]
        self.assertEqual(watch.returncode, 1)
        self.assertEqual(events[-1]["event"], "done")
        self.assertEqual(self.run_json("show", job["id"])["state"], "cancelled")


if __name__ == "__main__":
    TALUSD, TALUS = sys.argv.pop(), sys.argv.pop()
    unittest.main()
