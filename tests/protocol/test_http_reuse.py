# SPDX-License-Identifier: Apache-2.0
"""`reuse`: a finished job of the same scene and solver answers, and nothing else does."""
import unittest

from talus_harness import DaemonTest, fake_scene, wait_for


class Reuse(DaemonTest):
    config = {"queue_limit": 1}
    workers = 1
    duration = 1.0

    def setUp(self):
        super().setUp()
        Reuse.duration += 0.5  # a scene of its own for every test

    def scene(self, directive=None, **changes):
        return fake_scene(directive, duration=self.duration, **changes)

    def post(self, directive=None, headers=None, **fields):
        scene = fields.pop("scene", None) or self.scene(directive)
        return self.client.request("POST", "/v1/jobs", dict(fields, scene=scene), headers)

    def made(self, directive=None, **fields):
        reply = self.post(directive, **fields)
        self.assertEqual(reply.status, 201, reply)
        self.assertIsNone(reply.json()["reused_from"])
        return reply.json()["id"]

    def finished(self, directive=None, **fields):
        job = self.made(directive, **fields)
        self.client.finish(job)
        return job

    def assert_reused(self, reply, job):
        self.assertEqual(reply.status, 200, reply)
        self.assertEqual(reply.headers["location"], f"/v1/jobs/{job}")
        body = reply.json()
        self.assertEqual((body["id"], body["reused_from"], body["state"]), (job, job, "succeeded"))
        self.assertEqual(dict(body, reused_from=None), self.client.job(job))

    def test_a_finished_job_answers(self):
        job = self.finished()
        count = len(self.client.get("/v1/jobs?limit=500&fields=id").json()["jobs"])
        self.assert_reused(self.post({"rows": 3}, reuse=True, name="n", labels={"a": "b"}), job)
        self.assert_reused(self.post(reuse=True), job)
        self.assertEqual(len(self.client.get("/v1/jobs?limit=500&fields=id").json()["jobs"]), count)

    def test_only_if_asked(self):
        job = self.finished()
        for fields in ({}, {"reuse": False}):
            self.assertNotEqual(self.finished(**fields), job)
        # Of several the oldest, so that a repetition finds the same.
        self.assert_reused(self.post(reuse=True), job)

    def test_another_scene(self):
        self.finished()
        scene = self.scene(gravity=[0, -1.62])
        self.finished(scene=scene, reuse=True)

    def test_mistakes_come_first(self):
        self.finished()
        self.assert_problem(self.post(reuse=True, priority=1000), 422, "range", "/priority")

    def test_states(self):
        self.finished({"fail": {"reason": "unstable", "exit": 11}})
        running = self.made({"seconds": 60}, reuse=True)
        wait_for(lambda: self.client.job(running)["state"] == "running", 20, "running")
        queued = self.made(reuse=True)
        for job in (queued, running):
            self.client.post(f"/v1/jobs/{job}/cancel")
            self.assertEqual(self.client.finish(job)["state"], "cancelled")
        job = self.finished(reuse=True)
        self.assert_reused(self.post(reuse=True), job)

    def test_steered_and_deleted_ones_never(self):
        for order in ({"end_time": 0.2}, {"frame_now": True}, {"checkpoint_now": True}):
            job = self.made({"seconds": 3, "rows": 60})
            wait_for(lambda: self.client.step(job) > 0, 20, "progress")
            reply = self.client.request("PATCH", f"/v1/jobs/{job}", order)
            self.assertEqual(reply.status, 200, reply)
            self.assertEqual(self.client.finish(job)["state"], "succeeded")
        job = self.finished(reuse=True)
        self.assert_reused(self.post(reuse=True), job)
        self.client.delete(f"/v1/jobs/{job}")
        self.assertNotEqual(self.finished(reuse=True), job)

    def test_another_build(self):
        job = self.finished()
        self.daemon.switch("helper-build", "another")
        self.addCleanup(self.daemon.switch_off, "helper-build")
        self.assertNotEqual(self.finished(reuse=True), job)
        self.daemon.switch_off("helper-build")
        self.assert_reused(self.post(reuse=True), job)

    def test_when_the_queue_is_full(self):
        job = self.finished()
        duration, Reuse.duration = self.duration, self.duration + 0.25
        busy = [self.made({"seconds": 60}), None]
        wait_for(lambda: self.client.job(busy[0])["state"] == "running", 20, "running")
        busy[1] = self.made()
        self.assertEqual(self.post().status, 429)
        Reuse.duration = duration
        self.assert_reused(self.post(reuse=True), job)
        for other in busy[::-1]:
            self.client.post(f"/v1/jobs/{other}/cancel")
            self.client.finish(other)

    def test_with_a_key(self):
        key = {"Idempotency-Key": f"key {self.duration}"}
        first = self.post(reuse=True, headers=key)
        self.assertEqual(first.status, 201)
        job = first.json()["id"]
        self.client.finish(job)
        again = self.post(reuse=True, headers=key)
        self.assertEqual((again.status, again.headers["idempotent-replayed"]), (201, "true"))
        self.assertEqual(again.json()["id"], job)
        other = {"Idempotency-Key": f"other key {self.duration}"}
        for _ in range(2):
            reply = self.post(reuse=True, headers=other)
            self.assert_reused(reply, job)
            self.assertNotIn("idempotent-replayed", reply.headers)

    def test_after_a_restart(self):
        job = self.finished()
        self.daemon.kill()
        self.daemon.start()
        self.client.close()
        self.assert_reused(self.post(reuse=True), job)


if __name__ == "__main__":
    unittest.main()
