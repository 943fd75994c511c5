# SPDX-License-Identifier: Apache-2.0
"""The daemon with the real worker: a small scene from submission to picture, and runs that are
killed and resumed against runs that were left alone."""
import io
import json
import os
import signal
import struct
import subprocess
import tempfile
import unittest
import zlib

import h5py
import numpy

from sse_reader import read_all, series
from talus_harness import DaemonTest, PATIENCE, REAL_WORKER, sha256, wait_for


def falling_block(duration=0.3, cell=0.05, checkpoints=60):
    """A soft block falls 0.1 m onto a floor; 16 cells of 4 particles at cell = 0.1."""
    return {
        "title": "falling block",
        "dimension": "plane_strain",
        "duration": duration,
        "grid": {"cell": cell, "min": [0, 0], "max": [1.0, 1.0]},
        "solver": {"kind": "explicit", "shape": "linear", "strain": "finite", "courant": 0.1},
        "materials": {"rubber": {"model": "linear_elastic", "density": 1000, "young_modulus": 1e5,
                                 "poisson_ratio": 0.3}},
        "bodies": [{"name": "block", "material": "rubber", "velocity": [0, -1.0],
                    "box": {"min": [0.3, 0.1], "max": [0.7, 0.5]}, "particles_per_cell": [2, 2]}],
        "gravity": [0, -9.81],
        "boundaries": [{"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
                        "condition": "friction", "friction_coefficient": 0.3}],
        "probes": [{"name": "top", "kind": "height"}],
        "output": {"frames": {"every": duration / 3, "fields": ["velocity", "stress"]},
                   "history": {"every": duration / 300}, "checkpoints": {"every": checkpoints}},
    }


def picture(data):
    """(width, height, raw bytes) of a PNG; fails if a chunk or the stream is broken."""
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    place, size, pixels, names = 8, None, b"", []
    while place < len(data):
        length, name = struct.unpack(">I4s", data[place:place + 8])
        content = data[place + 8:place + 8 + length]
        crc, = struct.unpack(">I", data[place + 8 + length:place + 12 + length])
        assert crc == zlib.crc32(name + content), name
        names.append(name)
        if name == b"IHDR":
            size = struct.unpack(">II", content[:8])
        if name == b"IDAT":
            pixels += content
        place += 12 + length
    assert names[-1] == b"IEND"
    return size[0], size[1], zlib.decompress(pixels)


class WholeRun(DaemonTest):
    real = True

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        client = cls.daemon.client()
        reply = client.post("/v1/jobs", {"scene": falling_block(), "name": "falling block"})
        assert reply.status == 201, reply
        cls.created = reply.json()
        cls.base = f"/v1/jobs/{cls.created['id']}"
        cls.events = read_all(cls.daemon.port, cls.base + "/events", seconds=60)
        cls.job = client.finish(cls.created["id"], 60)

    def get(self, path, **headers):
        reply = self.client.get(self.base + path, **headers)
        self.assertEqual(reply.status, 200, reply)
        return reply

    def test_succeeds_as_forecast(self):
        self.assertEqual(self.job["state"], "succeeded", self.job)
        self.assertEqual(self.created["forecast"]["particles"], 256)
        metrics = self.job["metrics"]
        for name in ("mass_error", "momentum_error", "energy_error", "wall_seconds",
                     "particle_steps_per_second", "reaction.floor.peak", "probe.top.final",
                     "probe.top.max", "probe.top.time_of_max"):
            self.assertIn(name, metrics)
        self.assertLessEqual(abs(metrics["mass_error"]), 1e-12)
        # Steps: a forecast from the critical step at t = 0 is within a factor of the truth.
        steps = [e.data["step"] for e in self.events if e.name == "progress"]
        self.assertGreater(self.created["forecast"]["steps"], 10)
        if steps:
            self.assertLess(self.created["forecast"]["steps"] / max(steps), 4)

    def test_receipt(self):
        receipt = self.job["receipt"]
        text = json.dumps(receipt)
        self.assertRegex(text, r"[0-9a-f]{64}")
        self.assertEqual(self.get("/files/receipt.json").json().get("metrics", self.job["metrics"])
                         ["probe.top.final"], self.job["metrics"]["probe.top.final"])

    def test_story(self):
        self.assertEqual([e.data["state"] for e in self.events if e.name == "state"],
                         ["queued", "running", "succeeded"])
        self.assertEqual(self.events[-1].name, "done")
        self.assertEqual([e.data["n"] for e in self.events if e.name == "frame"], [0, 1, 2, 3])
        found = series(self.events)
        self.assertIn("reaction.floor.force.y", found)
        rows = self.history()
        for index, column in enumerate(self.columns()):
            if column["name"] != "time" and column["name"] in found:
                self.assertEqual(found[column["name"]][0], list(rows[:, 0]))
                self.assertEqual(found[column["name"]][1], list(rows[:, index]))

    def columns(self):
        return self.get("/files/history.json").json()["columns"]

    def history(self):
        data = numpy.frombuffer(self.get("/files/history.bin").body, dtype="<f8")
        return data.reshape(-1, len(self.columns()))

    def test_history_is_physical(self):
        rows, names = self.history(), [column["name"] for column in self.columns()]
        self.assertEqual(names[0], "time")
        self.assertEqual(rows[0, 0], 0.0)
        self.assertAlmostEqual(rows[-1, 0], 0.3, 12)
        self.assertTrue((numpy.diff(rows[:, 0]) > 0).all())
        self.assertTrue(numpy.isfinite(rows).all())
        force = rows[:, names.index("reaction.floor.force.y")]
        # A floor under an impact reads a push downwards; before the block arrives nothing.
        self.assertEqual(force[1], 0.0)
        weight = 1000 * 0.16 * 9.81
        self.assertLess(force.min(), -weight)
        # The impulse balance over the run, from reaction alone, against the change of momentum.
        top = rows[:, names.index("probe.top")]
        self.assertLess(top.min(), 0.5)

    def test_series_is_the_history(self):
        rows, names = self.history(), [column["name"] for column in self.columns()]
        data = self.get("/series/reaction.floor.force.y").json()
        self.assertEqual(data["unit"], "N/m")  # a plane problem: per metre of its thickness
        self.assertEqual(data["value"], list(rows[:, names.index("reaction.floor.force.y")]))
        text = self.get("/files/history.csv").body.decode().splitlines()
        self.assertEqual(text[0].split(",")[0], "time")
        self.assertEqual(len(text), len(rows) + 1)
        table = numpy.genfromtxt(io.StringIO("\n".join(text[1:])), delimiter=",")
        numpy.testing.assert_allclose(table[:, 0], rows[:, 0], rtol=1e-12)

    def test_frames_open_in_h5py(self):
        listing = self.get("/files").json()
        listing = listing["files"] if isinstance(listing, dict) else listing
        names = [file["name"] for file in listing]
        frames = [name for name in names if name.startswith("frames/frame_")]
        self.assertEqual(len(frames), 4)
        for name in frames + ["results.h5"]:
            data = self.get("/files/" + name).body
            with h5py.File(io.BytesIO(data)) as file:
                if name.startswith("frames/"):
                    group = file["VTKHDF"]
                    self.assertEqual(tuple(group.attrs["Version"]), (1, 0))
                    points = group["Points"][...]
                    self.assertEqual(points.shape, (256, 3))
                    self.assertTrue(numpy.isfinite(points).all())
                    self.assertIn("velocity", group["PointData"])
        shown = {e.data["n"]: e.data["sha256"] for e in self.events if e.name == "frame"}
        for number, digest in shown.items():
            data = self.get(f"/files/frames/frame_{number:06d}.hdf").body
            self.assertEqual(sha256(data), digest)
        self.assertNotIn("checkpoint.h5.tmp", names)

    def test_pictures(self):
        whole = self.get("/frames/3.png")
        self.assertEqual(whole.headers["content-type"], "image/png")
        width, height, pixels = picture(whole.body)
        self.assertGreaterEqual(min(width, height), 100)
        self.assertLessEqual(max(width, height), 4096)
        self.assertGreater(len(set(pixels)), 16, "an empty picture")
        width, _, _ = picture(self.get("/frames/0.png?width=640&field=velocity").body)
        self.assertEqual(width, 640)
        self.assertNotEqual(self.get("/frames/0.png").body, whole.body)
        reply = self.client.get(self.base + "/frames/0.png?field=colour")
        self.assertIn(reply.status, (400, 404, 422))

    def test_effective_scene(self):
        scene = self.get("/files/scene.json").json()
        self.assertEqual(scene["solver"]["transfer"], "flip")
        self.assertEqual(scene["solver"]["stress_update"], "modified_last")
        again = self.client.post("/v1/forecast", {"scene": scene})
        self.assertEqual(again.status, 200, again)
        self.assertEqual(again.json()["effective_scene"], scene)

    def test_reuse_of_the_same_scene(self):
        reply = self.client.post("/v1/jobs", {"scene": dict(falling_block(), title="another title"),
                                              "reuse": True})
        self.assertEqual(reply.status, 200, reply)
        self.assertEqual(reply.json()["reused_from"], self.created["id"])

    def test_log(self):
        self.assertEqual(self.client.get(self.base + "/log?tail=50").status, 200)

    def test_unstable_scene_fails_by_name(self):
        scene = falling_block()
        scene["solver"].update(time_step=0.05, allow_unstable=True)
        scene["duration"] = 5.0
        job = self.client.post("/v1/jobs", {"scene": scene}).json()
        done = self.client.finish(job["id"], 60)
        self.assertEqual((done["state"], done["reason"]), ("failed", "unstable"), done)
        self.assertTrue(done["detail"])


class KilledRuns(DaemonTest):
    real = True
    scene = falling_block(duration=0.6 / PATIENCE ** 2, cell=0.01, checkpoints=0.2)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        client = cls.daemon.client()
        job = client.post("/v1/jobs", {"scene": cls.scene}).json()["id"]
        assert client.finish(job, 120)["state"] == "succeeded"
        cls.undisturbed = client.get(f"/v1/jobs/{job}/files/history.bin").body

    def worker(self, job):
        """Process id of the run, from its event file."""
        path = os.path.join(self.daemon.job_folder(job), "events.ndjson")
        with open(path, encoding="utf-8") as file:
            started = [json.loads(line) for line in file if '"started"' in line]
        return started[-1]["pid"]

    def submit(self, **fields):
        reply = self.client.post("/v1/jobs", dict(fields, scene=self.scene))
        self.assertEqual(reply.status, 201, reply)
        return reply.json()["id"]

    def compare(self, job, attempts):
        done = self.client.finish(job, 120)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", attempts), done)
        history = self.client.get(f"/v1/jobs/{job}/files/history.bin").body
        self.assertEqual(sha256(history), sha256(self.undisturbed), "not the same bits")
        events = read_all(self.daemon.port, f"/v1/jobs/{job}/events")
        columns = self.client.get(f"/v1/jobs/{job}/files/history.json").json()["columns"]
        times = list(numpy.frombuffer(history, "<f8").reshape(-1, len(columns))[:, 0])
        for name, (time_list, _) in series(events).items():
            self.assertEqual(time_list, times, name)

    def test_worker_killed(self):
        job = self.submit(retries=3)
        self.wait_checkpoint(job)
        os.kill(self.worker(job), signal.SIGKILL)
        self.compare(job, 2)

    def wait_checkpoint(self, job):
        path = f"/v1/jobs/{job}/files/events.ndjson"
        wait_for(lambda: b'"checkpoint"' in self.client.get(path).body, 60, "a checkpoint")
        self.assertEqual(self.client.job(job)["state"], "running", "the scene is too short")

    def test_cancelled_and_resumed(self):
        job = self.submit()
        self.wait_checkpoint(job)
        self.client.post(f"/v1/jobs/{job}/cancel")
        self.assertEqual(self.client.finish(job)["state"], "cancelled")
        self.client.post(f"/v1/jobs/{job}/resume")
        self.compare(job, 2)

    def test_daemon_killed(self):
        job = self.submit()
        self.wait_checkpoint(job)
        self.daemon.kill()
        self.daemon.start()
        self.client.close()
        self.compare(job, 1)

    def test_both_killed(self):
        job = self.submit()
        self.wait_checkpoint(job)
        pid = self.worker(job)
        self.daemon.kill()
        os.kill(pid, signal.SIGKILL)
        self.daemon.start()
        self.client.close()
        self.compare(job, 2)

    def test_two_threads(self):
        """The short scene: where two cores are not free, threads that wait for each other crawl."""
        scene, histories = falling_block(), []
        for threads in (1, 2):
            job = self.client.post("/v1/jobs", {"scene": scene, "threads": threads}).json()["id"]
            self.assertEqual(self.client.finish(job, 120)["state"], "succeeded")
            histories.append(self.client.get(f"/v1/jobs/{job}/files/history.bin").body)
        self.assertEqual(sha256(histories[0]), sha256(histories[1]))


class ByHand(unittest.TestCase):
    """talus-worker without any daemon."""

    def run_worker(self, *arguments, timeout=60):
        return subprocess.run([REAL_WORKER, *arguments], capture_output=True, text=True,
                              timeout=timeout * PATIENCE)

    def in_folder(self, folder, scene, *more):
        path = os.path.join(folder, "in.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(scene, file)
        return self.run_worker("run", path, "--out", os.path.join(folder, "out"), *more)

    def test_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.in_folder(folder, falling_block(0.1))
            self.assertEqual(done.returncode, 0, done.stderr)
            for name in ("scene.json", "history.bin", "history.json", "history.csv", "results.h5",
                         "receipt.json", "events.ndjson", "frames/frame_000000.hdf"):
                self.assertTrue(os.path.exists(os.path.join(folder, "out", name)), name)

    def test_exit_codes(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.in_folder(folder, {"dimension": "line"}).returncode, 10)
        with tempfile.TemporaryDirectory() as folder:
            scene = falling_block(5.0)
            scene["solver"].update(time_step=0.05, allow_unstable=True)
            self.assertEqual(self.in_folder(folder, scene).returncode, 11)

    def test_terminated_then_resumed(self):
        scene = falling_block(0.6 / PATIENCE ** 2, 0.01)
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.in_folder(folder, scene).returncode, 0)
            with open(os.path.join(folder, "out", "history.bin"), "rb") as file:
                whole = file.read()
        with tempfile.TemporaryDirectory() as folder:
            path, out = os.path.join(folder, "in.json"), os.path.join(folder, "out")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(scene, file)
            process = subprocess.Popen([REAL_WORKER, "run", path, "--out", out],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            history = os.path.join(out, "history.bin")
            wait_for(lambda: os.path.exists(history) and os.path.getsize(history) > len(whole) // 4,
                     60, "a quarter of the run", 0.005)
            process.terminate()
            self.assertEqual(process.wait(30 * PATIENCE), 12)
            again = self.run_worker("run", path, "--out", out, "--resume")
            self.assertEqual(again.returncode, 0, again.stderr)
            with open(history, "rb") as file:
                self.assertEqual(sha256(file.read()), sha256(whole))

    def test_two_at_once_in_one_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            path, out = os.path.join(folder, "in.json"), os.path.join(folder, "out")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(falling_block(5.0, 0.02), file)
            first = subprocess.Popen([REAL_WORKER, "run", path, "--out", out],
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            wait_for(lambda: os.path.exists(os.path.join(out, "history.bin")), 20, "a first run")
            second = self.run_worker("run", path, "--out", out)
            self.assertNotEqual(second.returncode, 0)
            first.kill()
            first.wait()


if __name__ == "__main__":
    unittest.main()
