# SPDX-License-Identifier: Apache-2.0
"""SIGTERM: the daemon drains, says so, ends with 0, and the next one takes over."""
import signal
import threading
import time
import unittest

from sse_reader import Stream
from talus_harness import Daemon, PATIENCE, fake_scene, wait_for


class Shutdown(unittest.TestCase):
    def setUp(self):
        self.daemon = Daemon(workers=2).start()
        self.client = self.daemon.client()

    def tearDown(self):
        self.assertEqual(self.daemon.close(), "")

    def again(self):
        self.daemon.start()
        self.client.close()

    def test_idle(self):
        begin = time.monotonic()
        self.assertEqual(self.daemon.terminate(), 0)
        self.assertLess(time.monotonic() - begin, 5 * PATIENCE)

    def test_interrupt(self):
        self.daemon.process.send_signal(signal.SIGINT)
        self.assertEqual(self.daemon.process.wait(20 * PATIENCE), 0)

    def test_with_work_then_restart(self):
        running = [self.client.submit({"seconds": 1.2, "rows": 50})["id"] for _ in range(2)]
        queued = [self.client.submit()["id"] for _ in range(3)]
        for job in running:
            wait_for(lambda: self.daemon.started(job), 10, "started")
        self.assertEqual(self.daemon.terminate(60), 0)
        self.again()
        for job in running + queued:
            self.assertEqual(self.client.finish(job)["state"], "succeeded")
        starts = [(r["job"], r["attempt"]) for r in self.daemon.runs() if r["what"] == "start"]
        self.assertEqual(len(starts), len(set(starts)))

    def test_draining_shows(self):
        """While connections are being served to their end, readyz is 503 and nothing is taken."""
        job = self.client.submit({"seconds": 3.0})["id"]
        wait_for(lambda: self.daemon.started(job), 10, "started")
        seen = []
        self.assertEqual(self.client.get("/readyz").status, 200)
        self.daemon.process.terminate()
        begin = time.monotonic()
        while self.daemon.process.poll() is None and time.monotonic() - begin < 20 * PATIENCE:
            for method, path, body in (("GET", "/readyz", None),
                                       ("POST", "/v1/jobs", {"scene": fake_scene()})):
                try:
                    reply = self.client.request(method, path, body)
                    seen.append((method, reply.status, reply.headers.get("retry-after")))
                except OSError:
                    pass
            time.sleep(0.02)
        self.assertEqual(self.daemon.process.wait(20 * PATIENCE), 0)
        late = [entry for entry in seen[4:]]
        for method, status, retry in late:
            self.assertEqual(status, 503, seen)
            self.assertTrue(retry, "503 needs Retry-After")
        self.again()
        self.assertEqual(self.client.finish(job)["state"], "succeeded")

    def test_streams_end(self):
        job = self.client.submit({"seconds": 2.0, "rows": 50})["id"]
        events = []
        stream = Stream(self.daemon.port, f"/v1/jobs/{job}/events", timeout=20).open()

        def read():
            try:
                for event in stream:
                    events.append(event)
            except (OSError, EOFError):
                pass

        reader = threading.Thread(target=read)
        reader.start()
        wait_for(lambda: len(events) > 3, 10, "events")
        begin = time.monotonic()
        self.assertEqual(self.daemon.terminate(), 0)
        self.assertLess(time.monotonic() - begin, 15 * PATIENCE)
        reader.join(10 * PATIENCE)
        self.assertFalse(reader.is_alive())
        self.again()
        last_id = [event.id for event in events if event.id][-1]
        with Stream(self.daemon.port, f"/v1/jobs/{job}/events", last_id) as rest:
            events += list(rest)
        values = [v for e in events if e.name == "probe" for v in e.data["value"]]
        self.assertEqual(values, [2.0 * k for k in range(51)])

    def test_twice(self):
        self.client.submit({"seconds": 1.0})
        self.daemon.process.terminate()
        time.sleep(0.05)
        self.daemon.process.terminate()
        self.assertEqual(self.daemon.process.wait(20 * PATIENCE), 0)

    def test_what_was_accepted_survives(self):
        """Every 201 given before or during the drain is there afterwards."""
        accepted, stop = [], threading.Event()

        def submit():
            client = self.daemon.client()
            while not stop.is_set():
                try:
                    reply = client.post("/v1/jobs", {"scene": fake_scene()})
                    if reply.status == 201:
                        accepted.append(reply.json()["id"])
                except OSError:
                    time.sleep(0.01)

        threads = [threading.Thread(target=submit) for _ in range(4)]
        for thread in threads:
            thread.start()
        time.sleep(0.5)
        self.assertEqual(self.daemon.terminate(60), 0)
        stop.set()
        for thread in threads:
            thread.join()
        self.assertGreater(len(accepted), 3)
        self.again()
        for job in accepted:
            self.assertEqual(self.client.finish(job, 60)["state"], "succeeded")


if __name__ == "__main__":
    unittest.main()
