# SPDX-License-Identifier: Apache-2.0
"""Shares of the machine among tokens, and what a token may take at most."""
import hashlib
import os
import tempfile
import unittest

from talus_harness import Daemon, fake_scene, wait_for

TOKENS = {name: name + "-secret-of-this-test" for name in ("ada", "bob")}


class Tokens(unittest.TestCase):
    config = {}

    def setUp(self):
        handle, path = tempfile.mkstemp(prefix="talus-tokens-")
        with os.fdopen(handle, "w", encoding="ascii") as file:
            for name, secret in TOKENS.items():
                file.write(f"{name}:submit:{hashlib.sha256(secret.encode()).hexdigest()}\n")
        self.addCleanup(os.unlink, path)
        self.daemon = Daemon(workers=1, config=dict(self.config, tokens=path)).start()
        self.client = self.daemon.client()

    def tearDown(self):
        for job in self.client.get("/v1/jobs?limit=500&fields=id,state").json()["jobs"]:
            if job["state"] in ("queued", "running"):
                self.client.post(f"/v1/jobs/{job['id']}/cancel")
        self.assertEqual(self.daemon.close(), "")

    def post(self, owner, directive=None, **fields):
        return self.client.post("/v1/jobs", dict(fields, scene=fake_scene(directive)),
                                authorization="Bearer " + TOKENS[owner])

    def submit(self, owner, directive=None, **fields):
        reply = self.post(owner, directive, **fields)
        self.assertEqual(reply.status, 201, reply)
        self.assertEqual(reply.json()["owner"], owner)
        return reply.json()["id"]

    def running(self, owner, directive, **fields):
        job = self.submit(owner, directive, **fields)
        wait_for(lambda: self.client.job(job)["state"] == "running", 20, "running")
        return job

    def assert_too_many(self, reply, code):
        self.assertEqual(reply.status, 429, reply)
        self.assertTrue(reply.json()["type"].endswith(":" + code), reply)
        self.assertTrue(1 <= int(reply.headers["retry-after"]) <= 60)


class Shares(Tokens):
    def test_owners_take_turns(self):
        busy = self.running("ada", {"seconds": 1.0})
        many = [self.submit("ada", {"seconds": 0.2}) for _ in range(6)]
        few = [self.submit("bob", {"seconds": 0.2}) for _ in range(3)]
        for job in [busy] + many + few:
            self.client.finish(job)
        ran = [run["job"] for run in self.daemon.runs() if run["what"] == "start"]
        # Bob has used nothing: he goes first, and is done long before all of Ada's.
        self.assertIn(ran[1], few)
        self.assertLess(ran.index(few[-1]), ran.index(many[3]))
        self.assertEqual([job for job in ran if job in many], many)

    def test_priority_comes_before_shares(self):
        busy = self.running("ada", {"seconds": 0.5})
        other = self.submit("bob")
        urgent = self.submit("ada", priority=1)
        for job in (busy, other, urgent):
            self.client.finish(job)
        ran = [run["job"] for run in self.daemon.runs() if run["what"] == "start"]
        self.assertLess(ran.index(urgent), ran.index(other))


class Queued(Tokens):
    config = {"quota_queued": 2}

    def test_queued(self):
        busy = self.running("ada", {"seconds": 60})
        for _ in range(2):
            self.submit("ada")
        self.assert_too_many(self.post("ada"), "quota")
        self.submit("bob")
        self.client.post(f"/v1/jobs/{busy}/cancel")
        wait_for(lambda: self.post("ada").status == 201, 20, "a place")


class Disk(Tokens):
    # A job of the fake helper is forecast to take 100,000 bytes.
    config = {"quota_disk_bytes": 250_000}

    def test_disk(self):
        jobs = [self.submit("ada") for _ in range(2)]
        for job in jobs:
            self.client.finish(job)
        self.assert_too_many(self.post("ada"), "quota")
        self.submit("bob")
        self.assertEqual(self.client.delete(f"/v1/jobs/{jobs[0]}").status, 204)
        self.submit("ada")


class Running(Tokens):
    config = {"quota_running": 1}

    def setUp(self):
        super().setUp()
        self.daemon.workers = 3
        self.daemon.restart()
        self.client.close()

    def test_running(self):
        first = self.running("ada", {"seconds": 60})
        second = self.submit("ada")
        other = self.submit("bob")
        self.assertEqual(self.client.finish(other)["state"], "succeeded")
        self.assertEqual(self.client.job(second)["state"], "queued")
        self.client.post(f"/v1/jobs/{first}/cancel")
        self.assertEqual(self.client.finish(second)["state"], "succeeded")


if __name__ == "__main__":
    unittest.main()
