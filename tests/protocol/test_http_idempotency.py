# SPDX-License-Identifier: Apache-2.0
"""Idempotency-Key: one key makes one job, whatever happens in between."""
import json
import threading
import unittest

from talus_harness import DaemonTest, fake_scene


class Idempotency(DaemonTest):
    def post(self, key, body, client=None):
        return (client or self.client).post("/v1/jobs", body, idempotency_key=key)

    def count(self):
        return len(self.client.get("/v1/jobs?limit=500").json()["jobs"])

    def test_replay(self):
        body = {"scene": fake_scene(), "name": "once"}
        first = self.post("replay", body)
        self.assertEqual(first.status, 201)
        self.assertNotIn("idempotent-replayed", first.headers)
        before = self.count()
        self.client.finish(first.json()["id"])
        again = self.post("replay", body)
        self.assertEqual(again.status, 201)
        self.assertEqual(again.headers["idempotent-replayed"], "true")
        self.assertEqual(again.headers["location"], first.headers["location"])
        self.assertEqual(again.json()["state"], "succeeded")
        self.assertEqual(self.count(), before)

    def test_equal_json_in_another_spelling(self):
        body = {"scene": fake_scene(), "name": "spelling", "priority": 1}
        first = self.post("spelling", body)
        turned = json.dumps(dict(reversed(body.items())), indent=3).replace("spelling", "sp\\u0065lling")
        again = self.client.request("POST", "/v1/jobs", turned, {
            "Content-Type": "application/json", "Idempotency-Key": "spelling"})
        self.assertEqual(again.status, 201, again)
        self.assertEqual(again.json()["id"], first.json()["id"])

    def test_another_body_is_refused(self):
        first = self.post("conflict", {"scene": fake_scene(), "name": "a"})
        self.assertEqual(first.status, 201)
        before = self.count()
        self.assert_problem(self.post("conflict", {"scene": fake_scene(), "name": "b"}), 422)
        self.assertEqual(self.count(), before)
        again = self.post("conflict", {"scene": fake_scene(), "name": "a"})
        self.assertEqual(again.json()["id"], first.json()["id"])

    def test_parallel_ones_make_one_job(self):
        body = {"scene": fake_scene(), "name": "parallel"}
        for attempt in range(3):
            key, replies = f"parallel-{attempt}", []
            barrier = threading.Barrier(20)

            def submit():
                client = self.daemon.client()
                barrier.wait()
                replies.append(self.post(key, body, client))

            threads = [threading.Thread(target=submit) for _ in range(20)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual([reply.status for reply in replies], [201] * 20)
            self.assertEqual(len({reply.json()["id"] for reply in replies}), 1)
            fresh = [r for r in replies if "idempotent-replayed" not in r.headers]
            self.assertEqual(len(fresh), 1)

    def test_parallel_with_two_bodies(self):
        replies = []
        barrier = threading.Barrier(20)

        def submit(index):
            client = self.daemon.client()
            barrier.wait()
            replies.append(self.post("mixed", {"scene": fake_scene(), "name": f"{index % 2}"}, client))

        threads = [threading.Thread(target=submit, args=(index,)) for index in range(20)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        made = [reply for reply in replies if reply.status == 201]
        self.assertEqual(len(made), 10)
        self.assertEqual(len({reply.json()["id"] for reply in made}), 1)
        self.assertEqual({reply.status for reply in replies}, {201, 422})

    def test_survives_a_kill(self):
        body = {"scene": fake_scene(), "name": "durable"}
        first = self.post("durable", body)
        self.daemon.kill()
        self.daemon.start()
        self.client.close()
        again = self.post("durable", body)
        self.assertEqual((again.status, again.json()["id"]), (201, first.json()["id"]))
        self.assertEqual(again.headers["idempotent-replayed"], "true")
        self.assert_problem(self.post("durable", {"scene": fake_scene()}), 422)

    def test_a_refused_body_does_not_burn_the_key(self):
        self.assert_problem(self.post("refused", {"scene": {}}), 422)
        self.assertEqual(self.post("refused", {"scene": fake_scene()}).status, 201)

    def test_key_dies_with_its_job(self):
        body = {"scene": fake_scene(), "name": "mortal"}
        first = self.post("mortal", body).json()["id"]
        self.client.finish(first)
        self.assertIn(self.client.delete(f"/v1/jobs/{first}").status, (200, 204))
        second = self.post("mortal", body)
        self.assertEqual(second.status, 201)
        self.assertNotEqual(second.json()["id"], first)

    def test_length_and_characters(self):
        body = {"scene": fake_scene(), "name": "long"}
        self.assertEqual(self.post("k" * 255, body).status, 201)
        self.assertIn(self.post("k" * 256, body).status, (400, 422, 431))
        self.assertIn(self.post("", body).status, (400, 422))
        other = self.post("k" * 254, body)
        self.assertEqual(other.status, 201)
        self.assertNotIn("idempotent-replayed", other.headers)

    def test_keys_are_case_sensitive(self):
        body = {"scene": fake_scene(), "name": "case"}
        lower, upper = self.post("case", body), self.post("CASE", body)
        self.assertNotEqual(lower.json()["id"], upper.json()["id"])

    def test_without_a_key_two_jobs(self):
        body = {"scene": fake_scene()}
        ids = {self.client.post("/v1/jobs", body).json()["id"] for _ in range(2)}
        self.assertEqual(len(ids), 2)


if __name__ == "__main__":
    unittest.main()
