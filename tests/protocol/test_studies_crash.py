# SPDX-License-Identifier: Apache-2.0
"""Studies across restarts and kill -9 of the daemon (at random moments: tests/faults), their streams
of events, and thousands of rows.

TALUS_FULL=1: the large study runs to its end."""
import os
import time
import unittest

from sse_reader import Stream, read_all
from test_studies import GRID, StudyTest, study_body, study_scene
from talus_harness import PATIENCE, wait_for

FULL = os.environ.get("TALUS_FULL") == "1"


def many(count, stiffness=1e5):
    return {"grid": {"parameters": {"duration": list(range(1, count + 1)), "stiffness": [stiffness]},
                     "set": {"/duration": "duration",
                             "/materials/rubber/young_modulus": "stiffness"}}}


class Crash(StudyTest):
    def check_complete(self, study, count):
        """Every row is one job, and every job ran once."""
        rows = self.results(study["id"])["rows"]
        self.assertEqual([row["row"] for row in rows], list(range(count)))
        self.assertEqual({row["state"] for row in rows}, {"succeeded"})
        jobs = self.jobs(study["id"])
        self.assertEqual(sorted(job["study_row"] for job in jobs), list(range(count)))
        self.assertEqual({row["job"] for row in rows}, {job["id"] for job in jobs})
        for row in rows:
            self.assertEqual(row["metrics"]["probe.runout.max"], row["parameters"]["duration"])
            self.assertEqual(len(self.daemon.started(row["job"])), 1, row)
        self.assertEqual(self.daemon.violations(), "")

    def jobs(self, study_id):
        jobs, cursor = [], ""
        while True:
            page = self.client.get(f"/v1/jobs?limit=500&study={study_id}{cursor}").json()
            jobs += page["jobs"]
            if page["cursor"] is None:
                return jobs
            cursor = "&cursor=" + page["cursor"]

    def restarted(self):
        self.client.close()
        self.daemon.start()

    def test_killed_after_the_answer(self):
        study = self.submit(study_body(many(5, 2e5)))
        self.daemon.kill()
        self.restarted()
        self.check_complete(self.end(study["id"]), 5)

    def test_restarted(self):
        study = self.submit(study_body(many(12, 3e5)))
        self.daemon.restart()
        self.client.close()
        self.check_complete(self.end(study["id"]), 12)

    def test_a_bisection_goes_on(self):
        design = {"bisect": {"parameter": "/duration", "low": 1, "high": 100, "tolerance": 0.5,
                             "condition": "probe.runout.max < 33"}}
        study = self.submit(study_body(design))
        for kill in range(5):
            time.sleep(0.05 + 0.04 * kill)
            self.daemon.kill()
            self.restarted()
        study = self.end(study["id"])
        self.assertLessEqual(study["result"]["low"], 33)
        self.assertGreaterEqual(study["result"]["high"], 33)
        rows = self.results(study["id"])["rows"]
        values = [row["parameters"]["/duration"] for row in rows]
        self.assertEqual(len(values), len(set(values)))

    def test_a_cancel_survives(self):
        study = self.submit(study_body(many(9, 4e5), scene=study_scene({"seconds": 20})))
        wait_for(lambda: self.study(study["id"])["counts"]["running"] == 2, 30, "rows run")
        self.assertEqual(self.client.post(f"/v1/studies/{study['id']}/cancel").status, 200)
        self.daemon.kill()
        self.restarted()
        study = self.end(study["id"])
        self.assertEqual(study["state"], "cancelled")
        self.assertEqual(study["counts"]["cancelled"], 9)

    def test_a_removal_survives(self):
        study = self.end(self.submit(study_body(many(6, 5e5)))["id"])
        folders = [self.daemon.job_folder(job["id"]) for job in self.jobs(study["id"])]
        self.daemon.kill()
        self.restarted()
        client = self.daemon.client()
        try:
            client.delete(f"/v1/studies/{study['id']}")
        finally:
            self.daemon.kill()
        self.restarted()
        self.assertEqual(self.client.get(f"/v1/studies/{study['id']}").status, 404)
        self.assertEqual([path for path in folders if os.path.exists(path)], [])
        self.assertEqual(self.jobs(study["id"]), [])


class Stories(StudyTest):
    def stream(self, study, **more):
        return read_all(self.daemon.port, f"/v1/studies/{study['id']}/events", **more)

    def test_the_whole_story(self):
        study = self.submit(study_body(GRID))
        events = self.stream(study)
        self.assertEqual(events[0].name, "state")
        self.assertEqual(events[0].data["state"], "running")
        self.assertEqual([event.name for event in events[-2:]], ["state", "done"])
        self.assertEqual(events[-1].data["state"], "finished")
        for row in range(6):
            told = [event.data["state"] for event in events
                    if event.name == "row" and event.data["row"] == row]
            self.assertEqual(told, ["queued", "running", "succeeded"])
        numbers = [int(event.id) for event in events if event.name != "done"]
        self.assertEqual(numbers, sorted(set(numbers)))
        # Late-comers are told the same.
        self.assertEqual(self.stream(study), events)

    def test_resumed_without_gap_or_repeat(self):
        study = self.submit(study_body(GRID))
        events = self.stream(study)
        for cut in (0, 5, len(events) - 3):
            rest = self.stream(study, last_id=events[cut].id)
            self.assertEqual(rest, events[cut + 1:])
        reply = self.client.get(f"/v1/studies/{study['id']}/events", last_event_id=events[-1].id)
        self.assertEqual(reply.status, 204)
        self.assert_problem(self.client.get(f"/v1/studies/{study['id']}/events?after=x"), 422)

    def test_a_stream_survives_a_restart(self):
        study = self.submit(study_body(many(10, 7e5), scene=study_scene({"seconds": 0.2})))
        stream = Stream(self.daemon.port, f"/v1/studies/{study['id']}/events")
        first = [event for _, event in zip(range(8), stream)]
        stream.socket.close()
        self.daemon.kill()
        self.client.close()
        self.daemon.start()
        rest = self.stream(study, last_id=first[-1].id, seconds=60)
        self.assertEqual(self.stream(study), first + rest)

    def test_the_feed_tells_studies(self):
        stream = Stream(self.daemon.port, "/v1/events?after=latest")
        study = self.submit(study_body(GRID, name="in the feed"))
        states = []
        for event in stream:
            if event.name == "study" and event.data["study"] == study["id"]:
                states.append(event.data["state"])
            if states[-1:] == ["finished"]:
                break
        self.assertEqual(states, ["running", "finished"])
        stream.socket.close()


class Thousands(StudyTest):
    COUNT = 3000

    def test_accepted_listed_and_run(self):
        begin = time.monotonic()
        study = self.submit(study_body(many(self.COUNT)))
        accepted = time.monotonic() - begin
        self.assertEqual(study["counts"]["total"], self.COUNT)
        wait_for(lambda: self.study(study["id"])["counts"]["succeeded"] >= 10, 60, "rows succeed")
        # Few jobs are queued ahead, so one that is submitted by hand does not wait for all.
        counts = self.study(study["id"])["counts"]
        self.assertLessEqual(counts["queued"], 2 * self.workers)
        job = self.client.submit({"seconds": 0.01})
        self.assertEqual(self.client.finish(job["id"])["state"], "succeeded")
        self.assertGreater(self.study(study["id"])["counts"]["waiting"], self.COUNT // 2)
        begin = time.monotonic()
        rows = self.results(study["id"])["rows"]
        listed = time.monotonic() - begin
        self.assertEqual([row["row"] for row in rows], list(range(self.COUNT)))
        print(f"{self.COUNT} rows: accepted in {accepted:.2f} s, listed in {listed:.3f} s")
        if FULL:
            begin, done = time.monotonic(), self.study(study["id"])["counts"]["succeeded"]
            study = self.end(study["id"], 600)
            took = time.monotonic() - begin
            self.assertEqual(study["counts"]["succeeded"], self.COUNT)
            print(f"{(self.COUNT - done) / took:.1f} jobs a second")
        else:
            self.assertEqual(self.client.post(f"/v1/studies/{study['id']}/cancel").status, 200)
            study = self.end(study["id"])
            self.assertEqual(study["state"], "cancelled")
        self.assertEqual(sum(study["counts"][state] for state in
                             ("succeeded", "failed", "cancelled")), self.COUNT)
        begin = time.monotonic()
        events = read_all(self.daemon.port, f"/v1/studies/{study['id']}/events")
        print(f"{len(events)} events in {time.monotonic() - begin:.2f} s")
        self.assertGreaterEqual(len(events), self.COUNT)

    def test_too_many_are_refused_at_once(self):
        design = {"grid": {"parameters": {"a": list(range(1, 1001)), "b": list(range(1, 1001))},
                           "set": {"/duration": "a + b"}}}
        begin = time.monotonic()
        self.assert_problem(self.client.post("/v1/studies", study_body(design)), 422)
        self.assertLess(time.monotonic() - begin, 2 * PATIENCE)


if __name__ == "__main__":
    unittest.main()
