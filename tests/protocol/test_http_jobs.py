# SPDX-License-Identifier: Apache-2.0
"""The life of a job over HTTP: submit, read, wait, cancel, resume, delete."""
import os
import re
import threading
import time
import unittest

from talus_harness import DaemonTest, FINAL, fake_scene, wait_for

TIME = re.compile(r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z$")


class Submit(DaemonTest):
    def test_created(self):
        body = {"scene": fake_scene(), "name": "one", "labels": {"kind": "test", "n": "1"},
                "priority": 3, "threads": 1, "retries": 0}
        reply = self.client.post("/v1/jobs", body)
        self.assertEqual(reply.status, 201, reply)
        self.assertEqual(reply.headers["content-type"].split(";")[0], "application/json")
        job = reply.json()
        self.assertTrue(reply.headers["location"].endswith(f"/v1/jobs/{job['id']}"))
        self.assertRegex(job["id"], r"^[A-Za-z0-9_-]+$")
        self.assertEqual(job["name"], "one")
        self.assertEqual(job["labels"], {"kind": "test", "n": "1"})
        self.assertIn(job["state"], ("queued", "running"))
        self.assertRegex(job["created_at"], TIME)
        self.assertIn("particles", job["forecast"])
        self.assertIsInstance(job["advice"], list)
        done = self.client.finish(job["id"])
        self.assertEqual(done["state"], "succeeded")
        for key in ("created_at", "started_at", "finished_at"):
            self.assertRegex(done[key], TIME)
        self.assertLessEqual(done["created_at"], done["started_at"])
        self.assertLessEqual(done["started_at"], done["finished_at"])
        self.assertEqual(len(done["attempts"]), 1)
        self.assertEqual(done["metrics"]["probe.runout.final"], 40.0)
        self.assertNotIn("reason", {k: v for k, v in done.items() if v is not None})

    def test_location_answers(self):
        reply = self.client.post("/v1/jobs", {"scene": fake_scene()})
        path = reply.headers["location"]
        path = path[path.index("/v1"):]
        self.assertEqual(self.client.get(path).json()["id"], reply.json()["id"])

    def test_identifiers_sort_by_age(self):
        jobs = [self.client.submit()["id"] for _ in range(12)]
        self.assertEqual(jobs, sorted(jobs))
        self.assertEqual(len(set(jobs)), 12)

    def test_mistakes_in_the_request(self):
        good = fake_scene()
        cases = [
            ({}, "/scene", None),
            ({"scene": 5}, "/scene", None),
            ({"scene": good, "nmae": "x"}, "/nmae", None),
            ({"scene": good, "priority": 101}, "/priority", None),
            ({"scene": good, "priority": "high"}, "/priority", None),
            ({"scene": good, "priority": 1.5}, "/priority", None),
            ({"scene": good, "threads": -1}, "/threads", None),
            ({"scene": good, "threads": 100000}, "/threads", None),
            ({"scene": good, "name": 3}, "/name", None),
            ({"scene": good, "labels": []}, "/labels", None),
            ({"scene": good, "labels": {"a": 1}}, "/labels/a", None),
            ({"scene": good, "limits": {"wall": 1}}, "/limits/wall", None),
            ({"scene": good, "limits": {"wall_seconds": -1}}, "/limits/wall_seconds", None),
            ({"scene": good, "limits": {"memory_bytes": "1G"}}, "/limits/memory_bytes", None),
            ({"scene": good, "retries": -1}, "/retries", None),
            ({"scene": good, "reuse": "yes"}, "/reuse", None),
        ]
        for body, pointer, code in cases:
            with self.subTest(pointer=pointer, body=str(body)[:60]):
                self.assert_problem(self.client.post("/v1/jobs", body), 422, code, pointer)

    def test_all_mistakes_at_once_with_a_suggestion(self):
        body = {"scene": fake_scene(), "pirority": 1, "threads": -1, "retries": -1}
        problem = self.assert_problem(self.client.post("/v1/jobs", body), 422)
        pointers = {error["pointer"] for error in problem["errors"]}
        self.assertLessEqual({"/pirority", "/threads", "/retries"}, pointers)
        near = next(e for e in problem["errors"] if e["pointer"] == "/pirority")
        self.assertIn("priority", near["detail"])

    def test_mistakes_in_the_scene(self):
        scene = fake_scene()
        del scene["duration"]
        problem = self.assert_problem(self.client.post("/v1/jobs", {"scene": scene}), 422)
        self.assertIn("/scene/duration", [error["pointer"] for error in problem["errors"]])

    def test_a_refused_job_leaves_nothing(self):
        before = len(self.client.get("/v1/jobs?limit=500").json()["jobs"])
        self.client.post("/v1/jobs", {"scene": {}})
        self.assertEqual(len(self.client.get("/v1/jobs?limit=500").json()["jobs"]), before)

    def test_forecast_makes_nothing(self):
        before = len(self.client.get("/v1/jobs?limit=500").json()["jobs"])
        reply = self.client.post("/v1/forecast", {"scene": fake_scene()})
        self.assertEqual(reply.status, 200, reply)
        answer = reply.json()
        self.assertLessEqual({"forecast", "advice", "effective_scene"}, set(answer))
        self.assertEqual(len(self.client.get("/v1/jobs?limit=500").json()["jobs"]), before)
        self.assert_problem(self.client.post("/v1/forecast", {"scene": {}}), 422)

    def test_reuse(self):
        scene = fake_scene({"rows": 7}, duration=0.125)
        first = self.client.post("/v1/jobs", {"scene": scene}).json()
        self.client.finish(first["id"])
        reply = self.client.post("/v1/jobs", {"scene": scene, "reuse": True})
        self.assertEqual(reply.status, 200, reply)
        self.assertEqual(reply.json()["reused_from"], first["id"])
        self.assertEqual(reply.json()["state"], "succeeded")
        other = self.client.post("/v1/jobs", {"scene": dict(scene, duration=0.25), "reuse": True})
        self.assertEqual(other.status, 201, other)


class Read(DaemonTest):
    def test_unknown_job(self):
        for path in ("", "/events", "/series", "/files", "/log", "/files/scene.json"):
            with self.subTest(path=path):
                self.assert_problem(self.client.get("/v1/jobs/nosuchjob" + path), 404)
        self.assert_problem(self.client.delete("/v1/jobs/nosuchjob"), 404)
        self.assert_problem(self.client.post("/v1/jobs/nosuchjob/cancel"), 404)

    def test_unknown_path_and_method(self):
        self.assert_problem(self.client.get("/v1/nothing"), 404)
        self.assert_problem(self.client.get("/v2/jobs"), 404)
        reply = self.client.request("PUT", "/v1/jobs")
        self.assert_problem(reply, 405)
        self.assertIn("POST", reply.headers["allow"])
        self.assertIn("GET", reply.headers["allow"])
        reply = self.client.post("/healthz", {})
        self.assert_problem(reply, 405)

    def test_etag_stays_while_only_progress_moves(self):
        job = self.client.submit({"seconds": 1.5, "rows": 100})
        path = f"/v1/jobs/{job['id']}"
        wait_for(lambda: self.client.step(job["id"]) > 0, 10, "running")
        first = self.client.get(path)
        time.sleep(0.5)
        second = self.client.get(path)
        self.assertEqual(second.json()["state"], "running")
        self.assertEqual(first.headers["etag"], second.headers["etag"])
        self.assertGreater(second.json()["progress"]["step"], first.json()["progress"]["step"])
        self.assertEqual(self.client.get(path, if_none_match=first.headers["etag"]).status, 304)
        self.client.finish(job["id"])
        last = self.client.get(path, if_none_match=first.headers["etag"])
        self.assertEqual(last.status, 200)
        self.assertNotEqual(last.headers["etag"], first.headers["etag"])

    def test_wait_for_the_end(self):
        job = self.client.submit({"seconds": 0.7})
        begin = time.monotonic()
        reply = self.client.get(f"/v1/jobs/{job['id']}?wait=30")
        self.assertEqual(reply.json()["state"], "succeeded")
        self.assertGreater(time.monotonic() - begin, 0.3)

    def test_wait_runs_out(self):
        job = self.client.submit({"seconds": 30})
        begin = time.monotonic()
        reply = self.client.get(f"/v1/jobs/{job['id']}?wait=1")
        self.assertEqual(reply.status, 200)
        self.assertGreaterEqual(time.monotonic() - begin, 0.9)
        wait_for(lambda: self.client.job(job["id"])["state"] == "running", 10, "running")
        etag = self.client.get(f"/v1/jobs/{job['id']}").headers["etag"]
        reply = self.client.get(f"/v1/jobs/{job['id']}?wait=1", if_none_match=etag)
        self.assertEqual((reply.status, reply.body), (304, b""))
        self.client.post(f"/v1/jobs/{job['id']}/cancel")
        self.assertEqual(self.client.finish(job["id"])["state"], "cancelled")

    def test_wait_answers_at_the_change(self):
        job = self.client.submit({"seconds": 30})
        wait_for(lambda: self.client.job(job["id"])["state"] == "running", 10, "running")
        path = f"/v1/jobs/{job['id']}"
        etag = self.client.get(path).headers["etag"]
        other = self.daemon.client()
        timer = threading.Timer(0.4, lambda: other.post(path + "/cancel"))
        timer.start()
        begin = time.monotonic()
        reply = self.client.get(path + "?wait=20", if_none_match=etag)
        timer.join()
        self.assertEqual(reply.status, 200)
        self.assertLess(time.monotonic() - begin, 8)
        self.assertTrue(reply.json().get("cancel_requested") or reply.json()["state"] in FINAL)
        self.client.finish(job["id"])

    def test_bad_wait(self):
        job = self.client.submit()
        for value in ("-1", "x", "", "1e9", "nan", "1;2", "61"):
            with self.subTest(wait=value):
                reply = self.client.get(f"/v1/jobs/{job['id']}?wait={value}")
                self.assertIn(reply.status, (200, 400, 422) if value == "61" else (400, 422))

    def test_many_waiters(self):
        job = self.client.submit({"seconds": 1.0})
        states = []

        def waiter():
            client = self.daemon.client()
            states.append(client.get(f"/v1/jobs/{job['id']}?wait=30").json()["state"])

        threads = [threading.Thread(target=waiter) for _ in range(30)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(states, ["succeeded"] * 30)

    def test_head(self):
        job = self.client.submit()
        self.client.finish(job["id"])
        reply = self.client.request("HEAD", f"/v1/jobs/{job['id']}")
        self.assertEqual((reply.status, reply.body), (200, b""))
        self.assertEqual(reply.headers["etag"],
                         self.client.get(f"/v1/jobs/{job['id']}").headers["etag"])

    def test_service_calls(self):
        self.assertEqual(self.client.get("/healthz").status, 200)
        self.assertEqual(self.client.get("/readyz").status, 200)
        version = self.client.get("/v1/version").json()
        self.assertTrue(any(isinstance(v, str) and re.match(r"\d+\.\d+", v)
                            for v in version.values()), version)
        reply = self.client.get("/v1/schema/scene")
        self.assertEqual(reply.status, 200)
        self.assertIsInstance(reply.json(), dict)


class CancelResumeDelete(DaemonTest):
    workers = 1

    def running(self, **directive):
        job = self.client.submit(dict({"seconds": 30}, **directive))["id"]
        wait_for(lambda: self.daemon.started(job), 10, "started")
        wait_for(lambda: self.client.job(job)["state"] == "running", 10, "running")
        return job

    def cancel(self, job, **headers):
        return self.client.post(f"/v1/jobs/{job}/cancel", **headers)

    def test_cancel_queued(self):
        busy = self.running()
        queued = self.client.submit()["id"]
        self.assertEqual(self.client.job(queued)["state"], "queued")
        reply = self.cancel(queued)
        self.assertEqual((reply.status, reply.json()["state"]), (200, "cancelled"))
        again = self.cancel(queued)
        self.assertEqual((again.status, again.json()["state"]), (200, "cancelled"))
        self.cancel(busy)
        self.client.finish(busy)
        self.assertEqual(self.daemon.started(queued), [])

    def test_cancel_running(self):
        job = self.running(term_delay=0.6)
        begin = time.monotonic()
        reply = self.cancel(job)
        self.assertLess(time.monotonic() - begin, 0.5)
        self.assertIn(reply.status, (200, 202))
        self.assertEqual(reply.json()["state"], "running")
        self.assertTrue(reply.json()["cancel_requested"])
        twice = self.cancel(job)
        self.assertIn(twice.status, (200, 202))
        done = self.client.finish(job)
        self.assertEqual(done["state"], "cancelled")
        self.assertEqual(self.cancel(job).status, 200)
        ends = [run for run in self.daemon.runs() if run["job"] == job and run["what"] == "end"]
        self.assertEqual(len(ends), 1)

    def test_cancel_ends_what_ignores_sigterm(self):
        job = self.running(ignore_term=True)
        self.cancel(job)
        self.assertEqual(self.client.finish(job, 40)["state"], "cancelled")
        pid = self.daemon.started(job)[0]["pid"]
        self.assertNotIn(pid, self.daemon.stray_workers())

    def test_cancel_of_a_worker_that_dies_of_sigterm(self):
        job = self.running(die_of_term=True)
        self.cancel(job)
        done = self.client.finish(job)
        self.assertEqual(done["state"], "cancelled")
        self.assertEqual(len(done["attempts"]), 1)

    def test_cancel_after_the_end(self):
        job = self.client.submit()["id"]
        self.client.finish(job)
        self.assert_problem(self.cancel(job), 409)
        failed = self.client.submit({"fail": {"reason": "unstable", "exit": 11, "row": 3}})["id"]
        self.assertEqual(self.client.finish(failed)["state"], "failed")
        self.assert_problem(self.cancel(failed), 409)

    def test_the_end_recorded_first_wins(self):
        for _ in range(10):
            job = self.client.submit({"seconds": 0.1})["id"]
            time.sleep(0.1)
            reply = self.cancel(job)
            done = self.client.finish(job)
            self.assertIn(done["state"], ("succeeded", "cancelled"))
            if reply.status == 409:
                self.assertEqual(done["state"], "succeeded")

    def test_if_match(self):
        job = self.running()
        path = f"/v1/jobs/{job}"
        etag = self.client.get(path).headers["etag"]
        self.assert_problem(self.cancel(job, if_match='"nonsense"'), 412)
        self.assertEqual(self.client.job(job)["state"], "running")
        self.assertFalse(self.client.job(job).get("cancel_requested", False))
        self.assertIn(self.cancel(job, if_match=etag).status, (200, 202))
        self.client.finish(job)
        self.assert_problem(self.client.delete(path, if_match=etag), 412)
        self.assertEqual(self.client.get(path).status, 200)
        now = self.client.get(path).headers["etag"]
        self.assert_problem(self.client.post(path + "/resume", if_match=etag), 412)
        self.assertIn(self.client.delete(path, if_match=now).status, (200, 204))

    def test_resume_goes_on_from_the_checkpoint(self):
        job = self.running(seconds=3, rows=60, checkpoint=5)
        wait_for(lambda: self.client.step(job) >= 60, 10, "row 6")
        self.cancel(job)
        cancelled = self.client.finish(job)
        self.assertEqual(cancelled["state"], "cancelled")
        reply = self.client.post(f"/v1/jobs/{job}/resume")
        self.assertIn(reply.status, (200, 202), reply)
        self.assertIn(reply.json()["state"], ("queued", "running"))
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 2))
        runs = self.daemon.started(job)
        self.assertEqual([run["attempt"] for run in runs], [1, 2])
        self.assertEqual([run["resume"] for run in runs], [False, True])
        self.assert_problem(self.client.post(f"/v1/jobs/{job}/resume"), 409)

    def test_resume_of_a_failed_job(self):
        job = self.client.submit({"fail": {"reason": "unstable", "exit": 11, "row": 8,
                                           "attempts": [1]}})["id"]
        failed = self.client.finish(job)
        self.assertEqual((failed["state"], failed["reason"]), ("failed", "unstable"))
        self.assertTrue(failed["detail"])
        self.assertIn(self.client.post(f"/v1/jobs/{job}/resume").status, (200, 202))
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 2))
        self.assertIsNone(done.get("reason"))

    def test_resume_of_a_job_cancelled_before_it_ran(self):
        busy = self.running()
        job = self.client.submit()["id"]
        self.cancel(job)
        self.assertIn(self.client.post(f"/v1/jobs/{job}/resume").status, (200, 202))
        self.cancel(busy)
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 1))

    def test_resume_needs_an_end(self):
        job = self.running()
        self.assert_problem(self.client.post(f"/v1/jobs/{job}/resume"), 409)
        self.cancel(job)
        self.client.finish(job)

    def test_delete(self):
        job = self.running()
        folder = self.daemon.job_folder(job)
        self.assertIsNotNone(folder)
        self.assert_problem(self.client.delete(f"/v1/jobs/{job}"), 409)
        self.cancel(job)
        self.client.finish(job)
        self.assertIn(self.client.delete(f"/v1/jobs/{job}").status, (200, 204))
        self.assert_problem(self.client.get(f"/v1/jobs/{job}"), 404)
        self.assert_problem(self.client.delete(f"/v1/jobs/{job}"), 404)
        self.assertNotIn(job, [j["id"] for j in self.client.get("/v1/jobs?limit=500").json()["jobs"]])
        wait_for(lambda: self.daemon.job_folder(job) is None, 5, "folder removed")

    def test_delete_queued(self):
        busy = self.running()
        job = self.client.submit()["id"]
        self.assert_problem(self.client.delete(f"/v1/jobs/{job}"), 409)
        self.cancel(job)
        self.assertIn(self.client.delete(f"/v1/jobs/{job}").status, (200, 204))
        self.cancel(busy)
        self.client.finish(busy)


class Ends(DaemonTest):
    """How an attempt may end, and what the job says then."""

    def end(self, retries=0, **directive):
        job = self.client.submit(directive, retries=retries)
        return self.client.finish(job["id"], 40)

    def test_reasons(self):
        for reason, code in (("unstable", 11), ("audit", 15), ("memory_limit", 13),
                             ("disk_limit", 14), ("time_limit", 14)):
            with self.subTest(reason=reason):
                done = self.end(fail={"reason": reason, "exit": code, "row": 2}, retries=2)
                self.assertEqual((done["state"], done["reason"]), ("failed", reason))
                self.assertEqual(len(done["attempts"]), 1)
                self.assertEqual(done["metrics"]["probe.runout.final"], 1.0)

    def test_crash_is_retried_and_counted(self):
        done = self.end(retries=2, crash={"row": 12, "signal": 11, "attempts": [1, 2]})
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 3))
        done = self.end(retries=1, crash={"row": 3, "signal": 9, "attempts": [1, 2, 3]})
        self.assertEqual((done["state"], done["reason"]), ("failed", "crashed"))
        self.assertEqual(len(done["attempts"]), 2)
        done = self.end(retries=0, crash={"row": 3, "signal": 6, "attempts": [1]})
        self.assertEqual((done["state"], done["reason"]), ("failed", "crashed"))
        self.assertEqual(len(done["attempts"]), 1)
        self.assertTrue(done["detail"])

    def test_two_retries_are_the_default(self):
        job = self.client.submit({"crash": {"row": 1, "attempts": [1, 2, 3, 4]}})
        done = self.client.finish(job["id"], 40)
        self.assertEqual((done["reason"], len(done["attempts"])), ("crashed", 3))

    def test_an_end_without_a_last_line_is_a_crash(self):
        for code in (0, 1, 11):
            with self.subTest(exit=code):
                done = self.end(exit=code)
                self.assertEqual((done["state"], done["reason"]), ("failed", "crashed"))

    def test_torn_last_line(self):
        job = self.client.submit({"crash": {"row": 12}, "torn": True})
        done = self.client.finish(job["id"])
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 2))
        events = self.client.get(f"/v1/jobs/{job['id']}/files/events.ndjson")
        if events.status == 200:
            for line in events.body.splitlines():
                self.assertTrue(line.endswith(b"}"), line)

    def test_a_child_left_behind_does_not_stop_the_retry(self):
        done = self.end(retries=1, crash={"row": 12}, orphan=True)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 2))

    def test_wall_limit(self):
        job = self.client.submit({"hang": True, "seconds": 0.1}, limits={"wall_seconds": 1})
        begin = time.monotonic()
        done = self.client.finish(job["id"], 60)
        self.assertEqual((done["state"], done["reason"]), ("failed", "time_limit"))
        self.assertGreater(time.monotonic() - begin, 0.9)
        self.assertEqual(len(done["attempts"]), 1)

    def test_memory_limit(self):
        job = self.client.submit({"memory": 3 << 30}, limits={"memory_bytes": 400 << 20}, retries=0)
        done = self.client.finish(job["id"], 40)
        self.assertEqual(done["state"], "failed")
        self.assertIn(done["reason"], ("memory_limit", "crashed"))

    def test_results_that_would_not_fit(self):
        """The answer says in numbers what is needed and what is free."""
        needed = 10 ** 17
        scene = fake_scene({"disk_bytes": needed})
        # The first row equals the scene of many jobs that have ended.
        study = {"name": "large", "scene": scene, "metrics": ["wall_seconds"], "reuse": False,
                 "design": {"list": {"rows": [{"/duration": 1}, {"/duration": 2}]}}}
        space = os.statvfs(self.daemon.state)
        for path, body, count in (("/v1/jobs", {"scene": scene}, 1), ("/v1/studies", study, 2)):
            with self.subTest(path=path):
                problem = self.assert_problem(self.client.post(path, body), 507)
                self.assertEqual(problem["needed_bytes"], needed * count)
                self.assertGreater(problem["free_bytes"], 0)
                self.assertLess(problem["free_bytes"], space.f_blocks * space.f_frsize)
        self.assertEqual(self.client.post("/v1/forecast", {"scene": scene}).status, 200)

    def test_disk_limit(self):
        for directive in ({"frame_bytes": 3_000_000}, {"frame_bytes": 300_000, "frames": 50, "rows": 50,
                                                       "seconds": 30}):
            with self.subTest(directive=directive):
                job = self.client.submit(directive, limits={"disk_bytes": 1_000_000})
                done = self.client.finish(job["id"], 40)
                self.assertEqual((done["state"], done["reason"]), ("failed", "disk_limit"))

    def test_lines_that_are_no_events_do_no_harm(self):
        done = self.end(garbage=True)
        self.assertEqual(done["state"], "succeeded")

    def test_the_log_is_bounded(self):
        job = self.client.submit({"noise": 3_000_000})
        self.assertEqual(self.client.finish(job["id"])["state"], "succeeded")
        whole = self.client.get(f"/v1/jobs/{job['id']}/log")
        self.assertEqual(whole.status, 200)
        self.assertLess(len(whole.body), 2_000_000)
        self.assertIn(b"the last line of the noise", whole.body)
        tail = self.client.get(f"/v1/jobs/{job['id']}/log?tail=3")
        self.assertLessEqual(len(tail.body.splitlines()), 3)
        self.assertIn(b"the last line of the noise", tail.body)


if __name__ == "__main__":
    unittest.main()
