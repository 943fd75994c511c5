# SPDX-License-Identifier: Apache-2.0
"""Polls may be answered from what was told before, but never with what is not true any more."""
import threading
import unittest

from talus_harness import Client, DaemonTest, wait_for


class Kept(DaemonTest):
    def poll(self, job, times=3):
        """The same answer, several times: from the second on it is a kept one."""
        for _ in range(times):
            view = self.client.job(job)
        return view

    def running(self):
        job = self.client.submit({"seconds": 120, "rows": 12})["id"]
        self.addCleanup(self.daemon.client().post, f"/v1/jobs/{job}/cancel")
        wait_for(lambda: self.client.job(job)["state"] == "running", 30, "the job runs")
        return job

    def test_own_changes_show_at_once(self):
        job = self.running()
        for number in range(30):
            before = self.poll(job)
            reply = self.client.request("PATCH", f"/v1/jobs/{job}", {"labels": {"n": str(number)}})
            self.assertEqual(reply.status, 200, reply)
            after = self.client.get(f"/v1/jobs/{job}")
            self.assertEqual(after.json()["labels"], {"n": str(number)})
            self.assertEqual(after.headers["etag"], reply.headers["etag"])
            self.assertGreater(after.json()["revision"], before["revision"])

    def test_known_etag(self):
        job = self.client.submit()["id"]
        self.client.finish(job)
        tag = self.client.get(f"/v1/jobs/{job}").headers["etag"]
        for _ in range(3):
            reply = self.client.get(f"/v1/jobs/{job}", if_none_match=tag)
            self.assertEqual((reply.status, reply.body, reply.headers["etag"]), (304, b"", tag))
        other = self.client.get(f"/v1/jobs/{job}", if_none_match='"0"')
        self.assertEqual(other.status, 200)

    def test_progress_goes_on(self):
        job = self.client.submit({"seconds": 60, "rows": 600})["id"]
        wait_for(lambda: self.client.step(job) > 0, 30, "the first step")
        first = self.poll(job)["progress"]["step"]
        wait_for(lambda: self.client.step(job) > first + 20, 30, "further steps")
        self.assertEqual(self.client.post(f"/v1/jobs/{job}/cancel").status, 200)
        self.assertTrue(self.client.job(job)["cancel_requested"] or
                        self.client.job(job)["state"] == "cancelled")
        self.assertEqual(self.client.finish(job)["state"], "cancelled")

    def test_gone(self):
        job = self.client.submit()["id"]
        self.client.finish(job)
        self.poll(job)
        self.assertEqual(self.client.delete(f"/v1/jobs/{job}").status, 204)
        self.assertEqual(self.client.get(f"/v1/jobs/{job}").status, 404)

    def test_many_readers_beside_a_writer(self):
        """Revisions never go back, whoever reads while somebody writes."""
        job = self.running()
        stop, wrong = threading.Event(), []

        def read():
            client, last = Client(self.daemon.port), 0
            while not stop.is_set():
                revision = client.job(job)["revision"]
                if revision < last:
                    wrong.append((last, revision))
                last = revision
            client.close()

        readers = [threading.Thread(target=read) for _ in range(4)]
        for reader in readers:
            reader.start()
        try:
            for number in range(50):
                reply = self.client.request("PATCH", f"/v1/jobs/{job}", {"labels": {"w": str(number)}})
                self.assertEqual(reply.json()["revision"], self.client.job(job)["revision"])
        finally:
            stop.set()
            for reader in readers:
                reader.join()
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
