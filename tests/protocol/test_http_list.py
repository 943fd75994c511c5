# SPDX-License-Identifier: Apache-2.0
"""GET /v1/jobs: order, filters, fields, and a cursor that neither repeats nor skips."""
import unittest
from urllib.parse import quote

from talus_harness import DaemonTest, wait_for


class List(DaemonTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        client = cls.daemon.client()
        cls.jobs = []
        for index in range(23):
            directive = {} if index % 4 else {"fail": {"reason": "unstable", "exit": 11}}
            labels = {"parity": "odd" if index % 2 else "even", "text": "a:b c&d"}
            cls.jobs.append(client.submit(directive, labels=labels, name=f"n{index}")["id"])
        for job in cls.jobs:
            client.finish(job)

    def page(self, query=""):
        reply = self.client.get("/v1/jobs" + query)
        self.assertEqual(reply.status, 200, reply)
        return reply.json()

    def all_pages(self, query, limit):
        found, cursor, pages = [], None, 0
        while True:
            more = f"&cursor={quote(cursor)}" if cursor else ""
            page = self.page(f"?limit={limit}{query}{more}")
            self.assertLessEqual(len(page["jobs"]), limit)
            found += [job["id"] for job in page["jobs"]]
            cursor, pages = page.get("cursor"), pages + 1
            if not cursor:
                return found, pages
            self.assertLess(pages, 100)

    def test_newest_first(self):
        self.assertEqual([j["id"] for j in self.page("?limit=500")["jobs"]], self.jobs[::-1])

    def test_paging_is_complete_for_every_limit(self):
        for limit in (1, 2, 5, 22, 23, 24, 500):
            with self.subTest(limit=limit):
                found, pages = self.all_pages("", limit)
                self.assertEqual(found, self.jobs[::-1])
                self.assertLessEqual(pages, 23 // limit + 1)

    def test_paging_while_jobs_come(self):
        first = self.page("?limit=5")
        new = self.client.submit()["id"]
        self.client.finish(new)
        second = self.page(f"?limit=5&cursor={quote(first['cursor'])}")
        ids = [job["id"] for job in first["jobs"] + second["jobs"]]
        self.assertEqual(ids, self.jobs[::-1][:10])
        self.client.delete(f"/v1/jobs/{new}")

    def test_state(self):
        failed = [job["id"] for job in self.page("?state=failed")["jobs"]]
        self.assertEqual(failed, self.jobs[::4][::-1])
        self.assertEqual(self.page("?state=queued")["jobs"], [])
        found, _ = self.all_pages("&state=failed", 2)
        self.assertEqual(found, failed)

    def test_label(self):
        odd = [job["id"] for job in self.page("?label=parity:odd")["jobs"]]
        self.assertEqual(odd, self.jobs[1::2][::-1])
        both = [job["id"] for job in self.page("?label=parity:even&state=failed")["jobs"]]
        self.assertEqual(both, self.jobs[::4][::-1])
        self.assertEqual(self.page("?label=parity:none")["jobs"], [])
        special = self.page("?label=" + quote("text:a:b c&d", safe=""))["jobs"]
        self.assertEqual(len(special), 23)
        self.assertEqual(self.page("?label=" + quote("parity:%", safe=""))["jobs"], [])
        self.assertEqual(self.page("?label=" + quote("parity:' OR 1=1 --", safe=""))["jobs"], [])

    def test_several_labels(self):
        query = "?label=parity:odd&label=" + quote("text:a:b c&d", safe="")
        self.assertEqual([job["id"] for job in self.page(query)["jobs"]], self.jobs[1::2][::-1])
        self.assertEqual(self.page("?label=parity:odd&label=parity:even")["jobs"], [])
        found, pages = self.all_pages("&label=parity:odd&label=" + quote("text:a:b c&d", safe=""), 2)
        self.assertEqual((found, pages), (self.jobs[1::2][::-1], 6))

    def test_text(self):
        found = [job["name"] for job in self.page("?text=N1")["jobs"]]
        self.assertEqual(found, [f"n{index}" for index in range(19, 9, -1)] + ["n1"])
        self.assertEqual(self.page("?text=" + quote("n_", safe=""))["jobs"], [])
        self.assertEqual(self.page("?text=" + quote("%", safe=""))["jobs"], [])
        found = [job["name"] for job in self.page("?text=n1&label=parity:odd&state=succeeded")["jobs"]]
        self.assertEqual(found, ["n19", "n17", "n15", "n13", "n11", "n1"])
        names, _ = self.all_pages("&text=n2", 1)
        self.assertEqual(names, [self.jobs[index] for index in (22, 21, 20, 2)])

    def test_labels_follow_changes(self):
        job = self.client.submit({"seconds": 30}, labels={"turn": "one"})["id"]
        self.client.request("PATCH", f"/v1/jobs/{job}", {"labels": {"turn": "two"}})
        self.assertEqual(self.page("?label=turn:one")["jobs"], [])
        self.assertEqual([j["id"] for j in self.page("?label=turn:two")["jobs"]], [job])
        self.client.post(f"/v1/jobs/{job}/cancel")
        self.client.finish(job)
        self.client.delete(f"/v1/jobs/{job}")
        self.assertEqual(self.page("?label=turn:two")["jobs"], [])

    def test_fields(self):
        for job in self.page("?fields=id,state&limit=3")["jobs"]:
            self.assertEqual(set(job), {"id", "state"})

    def test_bad_queries(self):
        for query in ("?state=done", "?limit=0", "?limit=-1", "?limit=x", "?limit=501", "?limit=",
                      "?cursor=nonsense", "?cursor=%27", "?label=nocolon", "?fields=nofield",
                      "?stat=queued", "?limit=1&limit=2"):
            with self.subTest(query=query):
                reply = self.client.get("/v1/jobs" + query)
                allowed = (200, 400, 422) if query == "?limit=501" else (400, 422)
                self.assertIn(reply.status, allowed, reply)
                if reply.status != 200:
                    self.assert_problem(reply, reply.status)

    def test_a_deleted_job_does_not_break_a_cursor(self):
        extra = [self.client.submit()["id"] for _ in range(3)]
        for job in extra:
            self.client.finish(job)
        first = self.page("?limit=2")
        self.assertEqual([j["id"] for j in first["jobs"]], extra[::-1][:2])
        for job in extra:
            self.client.delete(f"/v1/jobs/{job}")
        second = self.page(f"?limit=2&cursor={quote(first['cursor'])}")
        self.assertEqual([j["id"] for j in second["jobs"]], self.jobs[::-1][:2])


class Order(DaemonTest):
    workers = 1

    def test_running_and_queued_show(self):
        busy = self.client.submit({"seconds": 30})["id"]
        wait_for(lambda: self.client.job(busy)["state"] == "running", 10, "running")
        queued = [self.client.submit()["id"] for _ in range(3)]
        states = {j["id"]: j["state"] for j in self.client.get("/v1/jobs").json()["jobs"]}
        self.assertEqual(states[busy], "running")
        self.assertEqual({states[job] for job in queued}, {"queued"})
        for job in queued + [busy]:
            self.client.post(f"/v1/jobs/{job}/cancel")
        self.client.finish(busy)


if __name__ == "__main__":
    unittest.main()
