# SPDX-License-Identifier: Apache-2.0
"""Which job runs when: priorities, threads, wide jobs, adopted workers."""
import os
import signal
import time
import unittest

from talus_harness import Daemon, DaemonTest, wait_for


def overlap(runs):
    """Largest number of threads that ran at once, from the fake worker's log."""
    edges = []
    for run in runs:
        edges.append((run["at"], run["threads"] if run["what"] == "start" else -run["threads"]))
    most = now = 0
    for _, change in sorted(edges):
        now += change
        most = max(most, now)
    return most


class OneAtATime(DaemonTest):
    workers = 1

    def test_priority_then_age(self):
        busy = self.client.submit({"seconds": 60})["id"]
        wait_for(lambda: self.daemon.started(busy), 10, "started")
        order = []
        for priority in (0, -5, 7, 0, 100, -100, 7):
            order.append((priority, self.client.submit(priority=priority)["id"]))
        self.client.post(f"/v1/jobs/{busy}/cancel")
        for _, job in order:
            self.client.finish(job)
        expected = [job for _, job in sorted(order, key=lambda pair: -pair[0])]
        ran = [run["job"] for run in self.daemon.runs() if run["what"] == "start"]
        self.assertEqual([job for job in ran if job in expected], expected)

    def test_never_more_than_the_workers(self):
        jobs = [self.client.submit({"seconds": 0.05})["id"] for _ in range(10)]
        for job in jobs:
            self.client.finish(job)
        self.assertEqual(overlap(self.daemon.runs()), 1)


class ThreeThreads(DaemonTest):
    workers = 3

    def test_threads_are_counted(self):
        jobs = [self.client.submit({"seconds": 0.15}, threads=threads)["id"]
                for threads in (1, 2, 1, 3, 2, 1, 1, 2, 3, 1, 1, 1)]
        for job in jobs:
            self.assertEqual(self.client.finish(job)["state"], "succeeded")
        self.assertEqual(overlap([r for r in self.daemon.runs() if r["job"] in jobs]), 3)

    def test_a_wide_job_is_not_starved(self):
        stop = time.monotonic() + 25
        narrow = [self.client.submit({"seconds": 0.4})["id"] for _ in range(6)]
        wide = self.client.submit({"seconds": 0.1}, threads=3)["id"]
        ended_after = None
        while time.monotonic() < stop:
            narrow.append(self.client.submit({"seconds": 0.4})["id"])
            if self.client.job(wide)["state"] == "succeeded":
                ended_after = len(narrow)
                break
            time.sleep(0.1)
        for job in narrow:
            self.client.post(f"/v1/jobs/{job}/cancel")
        for job in narrow:
            self.client.finish(job)
        self.assertIsNotNone(ended_after, "the wide job starved behind a stream of narrow ones")

    def test_more_threads_than_there_are(self):
        reply = self.client.post("/v1/jobs", {"scene": {}, "threads": 4})
        self.assertIn(reply.status, (422,))

    def test_automatic_threads(self):
        job = self.client.submit(threads=0)["id"]
        self.assertEqual(self.client.finish(job)["state"], "succeeded")
        self.assertIn(self.daemon.started(job)[0]["threads"], (1, 2, 3))


class Adoption(unittest.TestCase):
    def setUp(self):
        self.daemon = Daemon(workers=2).start()
        self.client = self.daemon.client()

    def tearDown(self):
        self.assertEqual(self.daemon.close(), "")

    def restart(self, between=lambda: None):
        self.daemon.kill()
        between()
        self.daemon.start()
        self.client.close()

    def running(self, **directive):
        job = self.client.submit(directive)["id"]
        wait_for(lambda: self.daemon.started(job), 10, "started")
        return job

    def test_an_adopted_worker_runs_to_its_end(self):
        job = self.running(seconds=1.5, rows=100)
        self.restart()
        self.assertEqual(self.client.job(job)["state"], "running")
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 1))
        self.assertEqual(len(self.daemon.started(job)), 1)

    def test_an_adopted_worker_keeps_its_place(self):
        jobs = [self.running(seconds=1.5) for _ in range(2)]
        self.restart()
        third = self.client.submit()["id"]
        time.sleep(0.3)
        self.assertEqual(self.client.job(third)["state"], "queued")
        for job in jobs + [third]:
            self.assertEqual(self.client.finish(job)["state"], "succeeded")
        self.assertEqual(overlap(self.daemon.runs()), 2)

    def test_a_worker_that_ended_meanwhile(self):
        job = self.running(seconds=0.3)
        failing = self.running(seconds=0.2, fail={"reason": "unstable", "exit": 11, "row": 15})
        self.restart(lambda: time.sleep(1.0))
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 1))
        self.assertEqual(self.client.finish(failing)["reason"], "unstable")

    def test_a_worker_that_was_lost_meanwhile(self):
        job = self.running(seconds=2.0, rows=40)
        wait_for(lambda: self.client.step(job) > 60, 10, "row 6")

        def kill_worker():
            os.kill(self.daemon.started(job)[0]["pid"], signal.SIGKILL)
            time.sleep(0.1)

        self.restart(kill_worker)
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 2))
        self.assertEqual([run["resume"] for run in self.daemon.started(job)], [False, True])

    def test_cancel_of_an_adopted_worker(self):
        polite = self.running(seconds=30)
        rude = self.running(seconds=30, ignore_term=True)
        self.restart()
        for job in (polite, rude):
            self.assertIn(self.client.post(f"/v1/jobs/{job}/cancel").status, (200, 202))
        for job in (polite, rude):
            self.assertEqual(self.client.finish(job, 60)["state"], "cancelled")
        self.assertEqual(len(self.daemon.runs()), 3)

    def test_cancel_survives_a_kill(self):
        job = self.running(seconds=30, term_delay=0.5)
        self.assertIn(self.client.post(f"/v1/jobs/{job}/cancel").status, (200, 202))
        self.restart()
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("cancelled", 1))

    def test_queued_jobs_survive(self):
        busy = [self.running(seconds=0.8) for _ in range(2)]
        queued = [self.client.submit()["id"] for _ in range(10)]
        self.restart()
        self.restart()
        for job in busy + queued:
            done = self.client.finish(job)
            self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 1))

    def test_wall_limit_of_an_adopted_worker(self):
        job = self.client.submit({"hang": True}, limits={"wall_seconds": 2})["id"]
        wait_for(lambda: self.daemon.started(job), 10, "started")
        self.restart()
        done = self.client.finish(job, 60)
        self.assertEqual((done["state"], done["reason"]), ("failed", "time_limit"))


if __name__ == "__main__":
    unittest.main()
