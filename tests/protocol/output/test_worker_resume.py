# SPDX-License-Identifier: Apache-2.0
"""A run that is killed and resumed ends with the bits of one that was not."""
import os
import random
import shutil
import signal
import tempfile
import time

import h5py

import worker_run

OUTPUT = {
    "frames": {"every": 0.1, "grid_fields": 4},
    "history": {"every": 0.004},
    "checkpoints": {"every": 0.02},
    "vtu": True,
}
# 1,000 steps of 0.2 ms and more.
SCENE = worker_run.scene(
    title="particles=2500 delay_us=100", solver={"time_step": 0.001}, output=OUTPUT
)


class ResumeTest(worker_run.RunTest):
    def run_whole(self):
        """One run without interruption, made by the first test that asks for it."""
        if not hasattr(ResumeTest, "whole"):
            self.run_job(SCENE, "whole")
            ResumeTest.whole = tempfile.mkdtemp(prefix="talus-whole-")
            shutil.copytree(self.folder / "whole", ResumeTest.whole, dirs_exist_ok=True)
        else:
            shutil.copytree(ResumeTest.whole, self.folder / "whole")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.whole)

    def check_stream(self, job):
        """The story of all attempts, told by the rules that readers follow, is the final files."""
        rows, frames = 0, []
        for event in self.events(job):
            if event["event"] == "rewind":
                self.assertLessEqual(event["row"], rows)
                self.assertLessEqual(event["frame"], len(frames))
                rows, frames = event["row"], frames[: event["frame"]]
            elif event["event"] == "history":
                self.assertGreater(event["rows"], rows)
                rows = event["rows"]
            elif event["event"] == "frame":
                self.assertEqual(event["n"], len(frames))
                frames.append(event)
        folder = self.folder / job
        self.assertEqual((folder / "history.bin").stat().st_size, rows * 6 * 8)
        for frame in frames:
            self.assertEqual(frame["sha256"], self.digest(job, frame["file"]))
        hdf = [name for name in self.frame_names(job) if name.startswith("frame_")]
        self.assertEqual(len(frames), len(hdf))

    def test_killed_at_random_moments(self):
        self.run_whole()
        seed = int(os.environ.get("TALUS_TEST_SEED", "20261122"))
        moments = random.Random(seed)
        kills, attempts = 0, 0
        # All kills in a few jobs: each is killed again and again until it ends by itself.
        while kills < 20:
            job = f"killed{attempts}"
            attempts += 1
            options = []
            while kills < 20:
                process = self.start(SCENE, job, *options)
                time.sleep(moments.uniform(0.0, 0.35))
                process.send_signal(signal.SIGKILL)
                process.communicate()
                kills += process.returncode == -signal.SIGKILL
                if process.returncode == 0:
                    break
                options = ["--resume"]
            else:
                self.run_job(SCENE, job, "--resume")
            self.assert_same_results("whole", job)
            self.check_stream(job)
            self.assertEqual(self.events(job)[-1]["event"], "finished")
            self.assertEqual(list((self.folder / job).rglob(".*")), [])
        checkpointed = sum(len(self.events(f"killed{n}", "checkpoint")) for n in range(attempts))
        self.assertGreater(checkpointed, 20)

    def test_every_file_is_whole_at_any_moment(self):
        process = self.start(SCENE)
        looks = 0
        while process.poll() is None:
            for path in sorted((self.folder / "job").glob("frames/[!.]*.hdf"))[-2:]:
                with h5py.File(path) as file:
                    self.assertIn("FieldData", file["VTKHDF"])
                looks += 1
            time.sleep(0.01)
        process.communicate()
        self.assertEqual(process.returncode, 0)
        self.assertGreater(looks, 5)

    def test_torn_lines_and_rows_are_cut(self):
        self.run_whole()
        process = self.start(SCENE)
        self.wait_for("job", "checkpoint", 2)
        process.kill()
        process.communicate()
        with open(self.folder / "job/events.ndjson", "a") as stream:
            stream.write('{"event":"progr')
        with open(self.folder / "job/history.bin", "ab") as stream:
            stream.write(b"12345")
        (self.folder / "job/frames/.frame_000099.hdf.part").write_bytes(b"half")
        (self.folder / "job/.results.h5.part").write_bytes(b"half")
        self.run_job(SCENE, "job", "--resume")
        self.assert_same_results("whole", "job")
        self.check_stream("job")
        started = self.events(kind="started")
        self.assertEqual([event["attempt"] for event in started], [1, 2])
        self.assertGreater(started[1]["resumed_from"], 0)
        self.assertEqual(list((self.folder / "job").rglob(".*")), [])

    def test_damaged_checkpoint_starts_over(self):
        self.run_whole()
        process = self.start(SCENE)
        self.wait_for("job", "checkpoint")
        process.kill()
        process.communicate()
        path = self.folder / "job/checkpoint.h5"
        path.write_bytes(path.read_bytes()[:1000])
        self.run_job(SCENE, "job", "--resume", "--attempt", "5")
        self.assert_same_results("whole", "job")
        rewind = self.events(kind="rewind")[0]
        self.assertEqual([rewind["row"], rewind["frame"], rewind["attempt"]], [0, 0, 5])
        self.assertEqual(self.events(kind="warning")[0]["code"], "checkpoint")

    def test_resume_of_another_scene_is_refused(self):
        process = self.start(SCENE)
        self.wait_for("job", "checkpoint")
        process.kill()
        process.communicate()
        other = dict(SCENE, duration=2.0)
        errors = self.run_job(other, "job", "--resume", expect=10)
        self.assertIn("another scene", errors)
        self.run_job(SCENE, "job", "--resume")
        before = self.digest("job", "events.ndjson")
        (self.folder / "job/checkpoint.h5").unlink()
        self.run_job(other, "job", "--resume", expect=10)
        self.assertEqual(before, self.digest("job", "events.ndjson"))

    def test_accumulators_go_on(self):
        process = self.start(SCENE)
        self.wait_for("job", "checkpoint", 3)
        process.terminate()
        process.communicate()
        self.assertEqual(process.returncode, 12)
        first = self.events(kind="failed")[0]["metrics"]
        self.run_job(SCENE, "job", "--resume")
        metrics = self.events(kind="finished")[0]["metrics"]
        self.assertEqual(metrics["particle_steps"], 2500 * 1000)
        self.assertGreater(metrics["wall_seconds"], first["wall_seconds"])
        self.assertGreater(metrics["cpu_seconds"], first["cpu_seconds"])


if __name__ == "__main__":
    worker_run.main()
