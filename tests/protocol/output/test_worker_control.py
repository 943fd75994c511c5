# SPDX-License-Identifier: Apache-2.0
"""Signals, control.json, the lock, and every way in which a run can end."""
import fcntl
import json
import os
import pty
import resource
import signal
import subprocess
import time

import worker_run

# 10 s of wall clock if nobody stops it.
LONG = worker_run.scene(title="particles=50 delay_us=10000", solver={"time_step": 0.001})


class ControlTest(worker_run.RunTest):
    def order(self, process, **orders):
        aside = self.folder / "job/.control.new"
        aside.write_text(json.dumps(orders))
        aside.rename(self.folder / "job/control.json")
        process.send_signal(signal.SIGUSR1)

    def test_sigterm_checkpoints_and_stops(self):
        process = self.start(LONG)
        self.wait_for("job", "history")
        process.terminate()
        process.communicate(timeout=5)
        self.assertEqual(process.returncode, 12)
        last = self.events()[-1]
        self.assertEqual([last["event"], last["reason"]], ["failed", "cancelled"])
        self.assertEqual(len(self.events(kind="checkpoint")), 1)
        self.assertTrue((self.folder / "job/checkpoint.h5").exists())
        self.assertTrue((self.folder / "job/results.h5").exists())

    def test_sigusr1_frame_and_checkpoint(self):
        process = self.start(LONG)
        self.wait_for("job", "frame")
        time.sleep(0.1)
        self.order(process, frame_now=True, checkpoint_now=True)
        self.wait_for("job", "checkpoint")
        process.terminate()
        process.communicate(timeout=5)
        frames = self.events(kind="frame")
        self.assertEqual(len(frames), 2)
        self.assertNotIn(frames[1]["time"], (0.0, 0.1))

    def test_end_time_is_moved(self):
        process = self.start(LONG)
        self.wait_for("job", "progress")
        self.order(process, end_time=0.05)
        process.communicate(timeout=10)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(self.events(kind="finished")[0]["metrics"]["time"], 0.05)
        self.assertTrue(json.loads((self.folder / "job/receipt.json").read_text())["steered"])
        self.assertIn("moved", self.events(kind="log")[0]["detail"])

    def test_bad_orders_are_warned_of(self):
        process = self.start(LONG)
        self.wait_for("job", "progress")
        self.order(process, end_tim=0.05)
        self.wait_for("job", "warning")
        time.sleep(0.05)
        self.order(process, end_time=-1.0)
        self.wait_for("job", "warning", 2)
        process.terminate()
        process.communicate(timeout=5)
        self.assertEqual(process.returncode, 12)
        self.assertIn("end_tim", self.events(kind="warning")[0]["detail"])

    def test_second_run_is_refused(self):
        process = self.start(LONG)
        self.wait_for("job", "history")
        errors = self.run_job(LONG, expect=1)
        self.assertIn("another run holds", errors)
        errors = self.run_job(LONG, "job", "--resume", expect=1)
        self.assertIn("another run holds", errors)
        process.terminate()
        process.communicate(timeout=5)
        before = self.digest("job", "events.ndjson")
        errors = self.run_job(LONG, expect=1)
        self.assertIn("holds the results", errors)
        self.assertEqual(before, self.digest("job", "events.ndjson"))

    def test_inherited_lock(self):
        job = self.folder / "job"
        job.mkdir()
        lock = os.open(job / "job.lock", os.O_RDWR | os.O_CREAT)
        fcntl.flock(lock, fcntl.LOCK_EX)
        (job / "scene.json").write_text(json.dumps(worker_run.scene()))
        (job / "events.ndjson").write_text('{"event":"state","attempt":3}\n')
        environment = dict(os.environ, TALUS_LOCK_FD=str(lock))
        command = [worker_run.worker(), "run", str(job / "scene.json"), "--out", str(job)]
        command += ["--attempt", "3"]
        errors = subprocess.run(command, stderr=subprocess.PIPE, timeout=30)
        self.assertEqual(errors.returncode, 1, "held by us and not handed on")
        result = subprocess.run(command, env=environment, pass_fds=[lock], timeout=30)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(self.events(kind="started")[0]["attempt"], 3)
        os.close(lock)

    def test_bad_scene(self):
        errors = self.run_job({"title": "no duration"}, expect=10)
        self.assertIn("/duration", errors)
        self.assertFalse((self.folder / "job").exists())
        job = self.folder / "job"
        job.mkdir()
        lock = os.open(job / "job.lock", os.O_RDWR | os.O_CREAT)
        environment = dict(os.environ, TALUS_LOCK_FD=str(lock))
        self.run_job({"title": ""}, expect=10, env=environment, pass_fds=[lock])
        os.close(lock)
        self.assertEqual(self.events()[-1]["reason"], "invalid")

    def test_usage(self):
        for options in (["--threads", "-1"], ["--threads", "x"], ["--sideways"], ["extra"]):
            self.run_job(worker_run.scene(), "job", *options, expect=1)
        self.assertFalse((self.folder / "job").exists())

    def test_unstable(self):
        self.run_job(worker_run.scene(title="unstable=100"), expect=11)
        last = self.events()[-1]
        self.assertEqual([last["event"], last["reason"]], ["failed", "unstable"])
        self.assertIn("particle 7", last["detail"])
        self.assertEqual(self.events(kind="frame")[-1]["step"], 100)
        self.assertIn("probe.h.final", last["metrics"])

    def test_audit(self):
        self.run_job(worker_run.scene(title="audit=1"), expect=15)
        last = self.events()[-1]
        self.assertEqual(last["reason"], "audit")
        self.assertIn("energy grew", last["detail"])
        receipt = json.loads((self.folder / "job/receipt.json").read_text())
        self.assertEqual(receipt["outcome"], "audit")

    def test_out_of_memory(self):
        self.run_job(worker_run.scene(title="memory=100"), expect=13)
        self.assertEqual(self.events()[-1]["reason"], "memory_limit")

    def test_wall_clock_limit(self):
        process = self.start(LONG, "job", "--wall-seconds", "0.3")
        process.communicate(timeout=10)
        self.assertEqual(process.returncode, 14)
        self.assertEqual(self.events()[-1]["reason"], "time_limit")
        self.assertEqual(len(self.events(kind="checkpoint")), 1)

    def test_disk_limit(self):
        """Wherever in a file the disk is full, the run ends in order and leaves nothing behind."""
        # 20,000 particles need 240 kB of positions alone.
        scene = worker_run.scene(title="particles=20000")
        for size in (2000, 2500, 5000, 20_000, 60_000, 100_000):

            def limit(size=size):
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

            job = f"job{size}"
            self.run_job(scene, job, expect=14, preexec_fn=limit)
            last = self.events(job)[-1]
            self.assertEqual([last["event"], last["reason"]], ["failed", "disk_limit"])
            self.assertEqual(list((self.folder / job).rglob(".*")), [])
            self.assertEqual(self.frame_names(job), [])

    def test_history_that_cannot_be_written_keeps_whole_rows(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, 30_000))

        output = {"frames": {"every": 0.5}, "history": {"every": 0.001}}
        scene = worker_run.scene(title="particles=1", output=output, solver={"time_step": 0.001})
        self.run_job(scene, expect=14, preexec_fn=limit)
        self.assertEqual(self.events()[-1]["reason"], "disk_limit")
        self.assertEqual((self.folder / "job/history.bin").stat().st_size % 48, 0)

    def test_nobody_listens(self):
        read_end, write_end = os.pipe()
        os.close(read_end)
        self.run_job(worker_run.scene(), stderr=write_end)
        os.close(write_end)

    def test_progress_is_paced(self):
        process = self.start(LONG)
        time.sleep(2.3)
        process.terminate()
        process.communicate(timeout=5)
        self.assertLessEqual(len(self.events(kind="progress")), 4)
        frames = len(self.events(kind="frame"))
        self.assertLessEqual(len(self.events(kind="history")), 4 * 2.5 + frames + 2)
        progress = self.events(kind="progress")[1]
        self.assertAlmostEqual(progress["fraction"], progress["time"], 12)
        self.assertGreater(progress["eta_seconds"], 1)
        self.assertGreater(progress["particle_steps_per_second"], 1000)

    def test_progress_line_on_a_terminal(self):
        main, terminal = pty.openpty()
        process = self.start(LONG, "job", stderr=terminal)
        self.wait_for("job", "progress")
        time.sleep(0.6)
        process.terminate()
        process.communicate(timeout=5)
        os.close(terminal)
        text = os.read(main, 100_000).decode()
        os.close(main)
        self.assertIn("\r", text)
        self.assertIn("particle-steps/s", text)
        self.assertIn("reaction floor", text)
        self.assertIn("ETA", text)

    def test_quiet(self):
        self.assertEqual(self.run_job(worker_run.scene(), "job", "--quiet"), "")
        self.assertIn("finished", (self.folder / "job/log.txt").read_text())


if __name__ == "__main__":
    worker_run.main()
