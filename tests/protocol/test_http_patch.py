# SPDX-License-Identifier: Apache-2.0
"""PATCH of a job: priority, labels and limits of what waits or runs, orders to what runs, and that
an order which was acknowledged survives a kill of the daemon and a crash of the worker."""
import os
import signal
import time
import unittest

from talus_harness import Daemon, DaemonTest, wait_for


def patch(client, job, body, **headers):
    return client.request("PATCH", f"/v1/jobs/{job}", body,
                          {key.replace("_", "-"): value for key, value in headers.items()})


class Patch(DaemonTest):
    workers = 1

    def setUp(self):
        super().setUp()
        self.jobs = []

    def tearDown(self):
        for job in self.jobs:
            self.client.post(f"/v1/jobs/{job}/cancel")
        for job in self.jobs:
            self.client.finish(job)
        super().tearDown()

    def running(self, **fields):
        directive = {"seconds": 60, "rows": 600}
        directive.update(fields.pop("directive", {}))
        job = self.client.submit(directive, **fields)["id"]
        self.jobs.append(job)
        wait_for(lambda: self.client.step(job) > 0, 20, "progress")
        return job

    def queued(self, **fields):
        job = self.client.submit(**fields)["id"]
        self.jobs.append(job)
        return job

    def patched(self, job, body, **headers):
        reply = patch(self.client, job, body, **headers)
        self.assertEqual(reply.status, 200, reply)
        self.assertEqual(reply.headers["etag"], f'"{reply.json()["revision"]}"')
        return reply.json()

    def test_settings_are_merged(self):
        self.running()
        job = self.queued(labels={"a": "1", "b": "2"}, priority=3,
                          limits={"wall_seconds": 50, "disk_bytes": 10_000_000})
        before = self.client.job(job)
        after = self.patched(job, {"labels": {"b": None, "c": "3/~"}, "priority": -7,
                                   "limits": {"wall_seconds": 70, "memory_bytes": 2_000_000_000}})
        self.assertEqual(after["labels"], {"a": "1", "c": "3/~"})
        self.assertEqual(after["priority"], -7)
        self.assertEqual(after["limits"], {"wall_seconds": 70, "disk_bytes": 10_000_000,
                                           "memory_bytes": 2_000_000_000})
        self.assertGreater(after["revision"], before["revision"])
        self.assertEqual((after["name"], after["state"], after["threads"]),
                         (before["name"], "queued", before["threads"]))
        self.assertFalse(after["steered"])
        self.assertEqual(self.client.job(job), after)
        after = self.patched(job, {"labels": None, "limits": None, "priority": None})
        self.assertEqual((after["labels"], after["limits"], after["priority"]), ({}, {}, 0))
        found = self.client.get("/v1/jobs?label=a:1").json()["jobs"]
        self.assertNotIn(job, [other["id"] for other in found])

    def test_nothing_asked_changes_nothing(self):
        job = self.running()
        before = self.client.job(job)["revision"]
        for body in ({}, {"frame_now": False, "checkpoint_now": False}):
            self.assertEqual(self.patched(job, body)["revision"], before)

    def test_priority_decides_what_starts(self):
        busy = self.running()
        first, second = self.queued(), self.queued()
        self.patched(second, {"priority": 5})
        self.client.post(f"/v1/jobs/{busy}/cancel")
        for job in (first, second):
            self.client.finish(job)
        ran = [run["job"] for run in self.daemon.runs() if run["what"] == "start"]
        self.assertLess(ran.index(second), ran.index(first))

    def test_mistakes_are_all_told(self):
        job = self.running()
        before = self.client.job(job)["revision"]
        reply = patch(self.client, job, {
            "priority": 101, "labels": {"a:b": "c", "d": 5}, "limits": {"wall_second": 3,
            "disk_bytes": "many"}, "end_time": "soon", "frame_now": 1, "framenow": True})
        problem = self.assert_problem(reply, 422)
        found = {error["pointer"]: error["code"] for error in problem["errors"]}
        self.assertEqual(found, {"/priority": "range", "/labels/a:b": "pattern", "/labels/d": "type",
                                 "/limits/wall_second": "unknown_key", "/limits/disk_bytes": "type",
                                 "/end_time": "type", "/frame_now": "type",
                                 "/framenow": "unknown_key"})
        detail, = [e["detail"] for e in problem["errors"] if e["pointer"] == "/framenow"]
        self.assertIn("frame_now", detail)
        for body in ([], 5, {"end_time": 0}, {"end_time": -1}, {"end_time": None},
                     {"labels": 5}, {"limits": []}, {"priority": 0.5}):
            with self.subTest(body=body):
                self.assert_problem(patch(self.client, job, body), 422)
        self.assert_problem(patch(self.client, job, "{", content_type="application/json"), 400)
        self.assert_problem(patch(self.client, job, "{}", content_type="text/plain"), 415)
        self.assert_problem(patch(self.client, "0" * 26, {}), 404)
        self.assert_problem(self.client.request("PATCH", f"/v1/jobs/{job}?x=1", {}), 422)
        self.assertEqual(self.client.job(job)["revision"], before)

    def test_an_end_in_the_past(self):
        job = self.running(directive={"seconds": 5, "rows": 50, "hang": True})
        wait_for(lambda: (self.client.job(job)["progress"]["time"] or 0) > 0.3, 20, "0.3 s")
        self.assert_problem(patch(self.client, job, {"end_time": 0.2}), 422, "past", "/end_time")

    def test_states(self):
        busy, waiting = self.running(), self.queued()
        for body in ({"end_time": 0.5}, {"frame_now": True}, {"checkpoint_now": True}):
            problem = self.assert_problem(patch(self.client, waiting, body), 409)
            self.assertIn("queued", problem["detail"])
        self.client.post(f"/v1/jobs/{waiting}/cancel")
        for body in ({"priority": 1}, {"end_time": 0.5}, {"labels": {"a": "b"}}):
            self.assert_problem(patch(self.client, waiting, body), 409)
        self.assertEqual(self.client.job(busy)["state"], "running")

    def test_if_match(self):
        job = self.running()
        old = self.client.get(f"/v1/jobs/{job}").headers["etag"]
        new = self.patched(job, {"priority": 1}, if_match=old)
        self.assert_problem(patch(self.client, job, {"priority": 2}, if_match=old), 412)
        self.assertEqual(self.client.job(job)["priority"], 1)
        self.assertEqual(self.patched(job, {"priority": 3}, if_match="*")["priority"], 3)
        self.assertEqual(new["priority"], 1)

    def test_wall_limit_takes_effect(self):
        job = self.running(directive={"hang": True, "seconds": 0.1})
        self.patched(job, {"limits": {"wall_seconds": 0.01}})
        done = self.client.finish(job)
        self.assertEqual((done["state"], done["reason"]), ("failed", "time_limit"))

    def test_wall_limit_is_taken_back(self):
        job = self.running(directive={"seconds": 4, "rows": 40}, limits={"wall_seconds": 2.5})
        self.patched(job, {"limits": {"wall_seconds": None}})
        self.assertEqual(self.client.finish(job)["state"], "succeeded")

    def test_disk_limit_takes_effect(self):
        job = self.running(directive={"frame_bytes": 300_000, "frames": 600})
        self.patched(job, {"limits": {"disk_bytes": 65536}})
        done = self.client.finish(job)
        self.assertEqual((done["state"], done["reason"]), ("failed", "disk_limit"))

    def test_looks(self):
        job = self.running(directive={"frames": 0})
        self.assertEqual(len(self.client.get(f"/v1/jobs/{job}/frames").json()), 1)
        after = self.patched(job, {"frame_now": True})
        self.assertEqual((after["steered"], after["steering"]), (True, {"frame_now": 1}))
        wait_for(lambda: len(self.client.get(f"/v1/jobs/{job}/frames").json()) == 2, 20, "frame")
        self.patched(job, {"frame_now": True, "checkpoint_now": True})
        wait_for(lambda: len(self.client.get(f"/v1/jobs/{job}/frames").json()) == 3, 20, "frame")
        time.sleep(0.2)
        self.assertEqual(len(self.client.get(f"/v1/jobs/{job}/frames").json()), 3)

    def test_end_time(self):
        job = self.running()
        after = self.patched(job, {"end_time": 0.05})
        self.assertEqual(after["steering"], {"end_time": 0.05})
        done = self.client.finish(job)
        self.assertEqual((done["state"], done["steered"]), ("succeeded", True))
        self.assertEqual(done["receipt"]["metrics"]["rows"], 30)
        self.assertTrue(done["receipt"]["steered"])


class Kills(unittest.TestCase):
    def setUp(self):
        self.daemon = Daemon(workers=2).start()
        self.client = self.daemon.client()

    def tearDown(self):
        self.assertEqual(self.daemon.close(), "")

    def running(self, **directive):
        job = self.client.submit(dict({"seconds": 60, "rows": 600, "frames": 0}, **directive))["id"]
        wait_for(lambda: self.client.step(job) > 0, 20, "progress")
        return job

    def steer(self, job, **body):
        reply = patch(self.client, job, body)
        self.assertEqual(reply.status, 200, reply)

    def frames(self, job):
        return len(self.client.get(f"/v1/jobs/{job}/frames").json())

    def test_daemon_killed_at_once(self):
        jobs = [self.running() for _ in range(2)]
        for job in jobs:
            self.steer(job, end_time=0.1, frame_now=True)
        self.daemon.kill()
        self.daemon.start()
        self.client.close()
        for job in jobs:
            done = self.client.finish(job)
            self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 1))
            self.assertEqual(done["receipt"]["metrics"]["rows"], 60)
            self.assertEqual(self.frames(job), 2)

    def test_worker_killed_before_it_hears(self):
        job = self.running()
        wait_for(lambda: self.client.step(job) > 100, 20, "a checkpoint")
        pid = self.daemon.started(job)[0]["pid"]
        os.kill(pid, signal.SIGSTOP)
        self.steer(job, end_time=0.1, frame_now=True)
        os.kill(pid, signal.SIGKILL)
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 2))
        self.assertEqual(done["receipt"]["metrics"]["rows"], 60)
        self.assertEqual(self.frames(job), 2)

    def test_both_killed_and_the_file_is_not_there(self):
        """As if the daemon had died between its store and the file of orders."""
        job = self.running()
        pid = self.daemon.started(job)[0]["pid"]
        os.kill(pid, signal.SIGSTOP)
        self.steer(job, end_time=0.1)
        self.daemon.kill()
        os.kill(pid, signal.SIGKILL)
        os.unlink(os.path.join(self.daemon.job_folder(job), "control.json"))
        self.daemon.start()
        self.client.close()
        done = self.client.finish(job)
        self.assertEqual((done["state"], done["receipt"]["metrics"]["rows"]), ("succeeded", 60))

    def test_limits_of_an_adopted_worker(self):
        job = self.running(hang=True, seconds=0.1)
        self.daemon.kill()
        self.daemon.start()
        self.client.close()
        reply = patch(self.client, job, {"limits": {"wall_seconds": 0.5, "memory_bytes": 10 ** 10}})
        self.assertEqual(reply.status, 200, reply)
        done = self.client.finish(job)
        self.assertEqual((done["state"], done["reason"]), ("failed", "time_limit"))


if __name__ == "__main__":
    unittest.main()
