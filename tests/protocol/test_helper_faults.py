# SPDX-License-Identifier: Apache-2.0
"""The helper processes that check scenes and draw pictures may hang, die or talk nonsense: the
request gets an answer, the daemon and the next request are well."""
import threading
import time
import unittest

from talus_harness import DaemonTest, PATIENCE, fake_scene


class HelperFaults(DaemonTest):
    config = {"helper_seconds": 1.5 * PATIENCE, "render_seconds": 3 * PATIENCE}

    def submit(self, directive=None):
        return self.client.post("/v1/jobs", {"scene": fake_scene(directive)})

    def recover(self):
        """After the fault is switched off, at most a few requests may still meet an old helper."""
        for _ in range(6):
            reply = self.submit()
            if reply.status == 201:
                return
            self.assertIn(reply.status, (500, 502, 503, 504))
        self.fail(f"does not recover: {reply}")

    def fault(self, name, statuses, seconds, value="1"):
        self.daemon.switch(name, value)
        try:
            begin = time.monotonic()
            reply = self.submit()
            self.assertLess(time.monotonic() - begin, seconds * PATIENCE)
            self.assertIn(reply.status, statuses, reply)
            self.assert_problem(reply, reply.status)
            self.assertEqual(self.client.get("/healthz").status, 200)
        finally:
            self.daemon.switch_off(name)
        self.recover()

    def test_dies(self):
        self.fault("helper-die", (422, 502, 503), 20)

    def test_hangs(self):
        self.fault("helper-hang", (422, 502, 503, 504), 30)

    def test_nonsense(self):
        self.fault("helper-nonsense", (502, 503), 20)

    def test_half_a_line(self):
        self.fault("helper-half", (422, 502, 503, 504), 30)

    def test_endless_answer(self):
        before = self.daemon.memory()
        self.fault("helper-endless", (422, 502, 503, 504), 30)
        self.assertLess(self.daemon.memory() - before, 300 << 20)

    def test_does_not_start(self):
        self.fault("helper-exit", (502, 503), 30)

    def test_one_poisonous_scene_does_not_hurt_the_others(self):
        """Good requests beside ones that kill their helper."""
        statuses, poisoned = [], []

        def good():
            client = self.daemon.client()
            for _ in range(10):
                statuses.append(client.post("/v1/jobs", {"scene": fake_scene()}).status)

        def bad():
            client = self.daemon.client()
            for _ in range(5):
                poisoned.append(client.post("/v1/jobs", {"scene": fake_scene({"helper": "die"})}).status)

        threads = [threading.Thread(target=good) for _ in range(3)] + [threading.Thread(target=bad)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(statuses, [201] * 30)
        self.assertNotIn(201, poisoned)

    def test_a_hanging_picture_does_not_block_submissions(self):
        job = self.submit().json()["id"]
        self.client.finish(job)
        self.daemon.switch("helper-render-hang")
        try:
            replies = []
            other = self.daemon.client()
            thread = threading.Thread(target=lambda: replies.append(
                other.get(f"/v1/jobs/{job}/frames/0.png?width=333")))
            thread.start()
            time.sleep(0.3)
            begin = time.monotonic()
            self.assertEqual(self.client.get("/v1/version").status, 200)
            self.assertLess(time.monotonic() - begin, 1 * PATIENCE)
            thread.join()
            self.assertEqual(replies[0].status, 503)
        finally:
            self.daemon.switch_off("helper-render-hang")
        self.assertEqual(self.client.get(f"/v1/jobs/{job}/frames/0.png?width=333").status, 200)


if __name__ == "__main__":
    unittest.main()
