# SPDX-License-Identifier: Apache-2.0
"""Studies: every design from its submission to its table of results, with the fake worker."""
import csv
import io
import unittest

from talus_harness import DaemonTest, PATIENCE, fake_scene, wait_for


def study_scene(directive=None, **changes):
    """A scene with a probe whose `max` the fake worker makes the scene's duration."""
    return fake_scene(dict({"seconds": 0.01, "rows": 3}, **(directive or {})),
                      probes=[{"name": "runout", "kind": "front", "along": [1, 0]}], **changes)


def study_body(design, **fields):
    return dict({"name": "a study", "scene": study_scene(), "design": design,
                 "metrics": ["probe.runout.final", "probe.runout.max"], "reuse": False}, **fields)


GRID = {"grid": {"parameters": {"duration": [1, 2, 3], "stiffness": [1e5, 2e5]},
                 "set": {"/duration": "duration", "/materials/rubber/young_modulus": "stiffness"}}}


class StudyTest(DaemonTest):
    def submit(self, body, **headers):
        reply = self.client.post("/v1/studies", body, **headers)
        self.assertEqual(reply.status, 201, reply)
        study = reply.json()
        self.assertEqual(reply.headers["location"], f"/v1/studies/{study['id']}")
        return study

    def study(self, study_id):
        reply = self.client.get(f"/v1/studies/{study_id}")
        self.assertEqual(reply.status, 200, reply)
        return reply.json()

    def end(self, study_id, seconds=60):
        """Waits for the end of a study and returns it."""
        for _ in range(int(seconds * PATIENCE / 5) + 1):
            reply = self.client.get(f"/v1/studies/{study_id}?wait=5")
            self.assertEqual(reply.status, 200, reply)
            if reply.json()["state"] != "running":
                return reply.json()
        raise AssertionError(f"not ended: {reply.json()}")

    def results(self, study_id):
        reply = self.client.get(f"/v1/studies/{study_id}/results")
        self.assertEqual(reply.status, 200, reply)
        return reply.json()

    def run_study(self, body, state="finished"):
        study = self.end(self.submit(body)["id"])
        self.assertEqual(study["state"], state, study)
        return study, self.results(study["id"])["rows"]


class Designs(StudyTest):
    def test_grid(self):
        study, rows = self.run_study(study_body(GRID))
        self.assertEqual(study["counts"]["succeeded"], 6)
        self.assertEqual(study["counts"]["total"], 6)
        self.assertEqual(study["progress"]["fraction"], 1)
        self.assertEqual(study["parameters"], ["duration", "stiffness"])
        self.assertEqual([row["row"] for row in rows], list(range(6)))
        pairs = {(row["parameters"]["duration"], row["parameters"]["stiffness"]) for row in rows}
        self.assertEqual(pairs, {(d, s) for d in (1, 2, 3) for s in (1e5, 2e5)})
        for row in rows:
            self.assertEqual(row["state"], "succeeded")
            self.assertEqual(row["metrics"]["probe.runout.max"], row["parameters"]["duration"])
            job = self.client.job(row["job"])
            self.assertEqual((job["study"], job["study_row"]), (study["id"], row["row"]))
        jobs = self.client.get(f"/v1/jobs?study={study['id']}").json()["jobs"]
        self.assertEqual({job["id"] for job in jobs}, {row["job"] for row in rows})

    def test_list_with_an_expression_and_labels(self):
        design = {"list": {"rows": [{"n": 1, "what": {"label": "soft", "value": 1e4}},
                                    {"n": 2, "what": {"label": "hard", "value": 1e6}}],
                           "set": {"/duration": "2 * n^2",
                                   "/materials/rubber/young_modulus": "what"}}}
        _, rows = self.run_study(study_body(design))
        self.assertEqual([row["parameters"] for row in rows],
                         [{"n": 1, "what": "soft"}, {"n": 2, "what": "hard"}])
        self.assertEqual([row["metrics"]["probe.runout.max"] for row in rows], [2, 8])

    def test_samples(self):
        for method in ("latin_hypercube", "sobol"):
            design = {"sample": {"method": method, "count": 8, "seed": 3, "parameters": {
                "d": {"min": 1, "max": 9, "scale": "linear"}}, "set": {"/duration": "d"}}}
            _, rows = self.run_study(study_body(design))
            values = sorted(row["parameters"]["d"] for row in rows)
            # One in each eighth of the range: what both methods promise of eight samples.
            for index, value in enumerate(values):
                self.assertTrue(1 + index <= value <= 2 + index, (method, values))

    def test_work_precision(self):
        scene = study_scene()
        scene["references"] = [{"probe": "runout", "value": 1.0}]
        design = {"work_precision": {
            "variants": [{"label": "a", "set": {"/materials/rubber/young_modulus": 1e5}},
                         {"label": "b", "set": {"/materials/rubber/young_modulus": 2e5}}],
            "resolutions": [{"label": "coarse", "set": {"/duration": 1}},
                            {"label": "fine", "set": {"/duration": 2}}],
            "error": "error.runout", "cost": "particle_steps"}}
        body = study_body(design, scene=scene, metrics=["error.runout", "particle_steps"])
        study, rows = self.run_study(body)
        self.assertEqual(len(rows), 4)
        self.assertEqual({tuple(row["parameters"].values()) for row in rows},
                         {(v, r) for v in "ab" for r in ("coarse", "fine")})
        self.assertEqual(study["kind"], "work_precision")
        self.assert_own_chart(study, b'"x": "particle_steps"')
        del design["work_precision"]["cost"]  # wall_seconds, of the same runs
        study, _ = self.run_study(body)
        self.assert_own_chart(study, b'"x": "wall_seconds"')

    def assert_own_chart(self, study, axis):
        """A comparison of work and precision has a chart without asking for one."""
        reply = self.client.get(f"/v1/studies/{study['id']}/chart.svg")
        self.assertEqual(reply.status, 200, reply)
        self.assertIn(axis, reply.body)
        self.assertIn(b'"y": "error.runout"', reply.body)

    def bisection(self, **changes):
        return {"bisect": dict({"parameter": "/duration", "low": 1, "high": 9, "tolerance": 0.25,
                                "condition": "probe.runout.max < 4.3"}, **changes)}

    def test_bisection_finds_the_edge(self):
        study, rows = self.run_study(study_body(self.bisection()))
        result = study["result"]
        self.assertLessEqual(result["low"], 4.3)
        self.assertGreaterEqual(result["high"], 4.3)
        self.assertLessEqual(result["high"] - result["low"], 0.25)
        self.assertEqual(result["value"], result["low"])
        self.assertEqual(study["progress"]["rows_expected"], len(rows))
        values = [row["parameters"]["/duration"] for row in rows]
        self.assertEqual(sorted(values[:2]), [1, 9])
        self.assertEqual(len(set(values)), len(values), values)

    def test_bisection_without_an_edge_fails(self):
        study, rows = self.run_study(study_body(self.bisection(low=5)), "failed")
        self.assertIn("end", study["detail"])
        self.assertIsNone(study["result"])
        self.assertEqual(len(rows), 2)

    def test_bisections_for_each_row_of_a_grid(self):
        """The fake worker's run-out follows the duration; a label moves its edge out of reach."""
        each = {"parameters": {"limit": [{"label": "in reach", "value": 1},
                                         {"label": "beyond", "value": 100}]},
                "set": {"/bodies/0/box/max/0": "limit"}}
        study, rows = self.run_study(study_body(self.bisection(for_each=each)))
        found = study["result"]["for_each"]
        self.assertEqual([one["parameters"]["limit"] for one in found], ["in reach", "beyond"])
        for one in found:
            self.assertLessEqual(one["low"], 4.3)
            self.assertGreaterEqual(one["high"], 4.3)
            self.assertEqual(one["value"], one["low"])
            tried = [row["parameters"]["/duration"] for row in rows
                     if row["parameters"]["limit"] == one["parameters"]["limit"]]
            self.assertEqual(len(set(tried)), len(tried), tried)
        self.assertEqual(len(rows), study["progress"]["rows_expected"])

    def test_a_scene_that_is_invalid_between_the_ends(self):
        """Both ends are valid, so the study is taken; the gap must not pass for the edge."""
        study, rows = self.run_study(study_body(
            self.bisection(), scene=study_scene({"refuse": [4.5, 5.5]})), "failed")
        self.assertEqual([row["state"] for row in rows], ["succeeded", "succeeded", "failed"])
        self.assertEqual(rows[2]["reason"], "invalid")
        self.assertIsNone(study["result"])
        self.assertIn("row 2: the scene is refused: /duration: in the gap", study["detail"])

    def test_a_failed_job_does_not_meet_a_condition(self):
        scene = study_scene({"fail": {"reason": "unstable", "exit": 11, "row": 1, "above": 6}})
        study, rows = self.run_study(study_body(
            self.bisection(condition="probe.runout.max < 100"), scene=scene))
        self.assertLessEqual(study["result"]["low"], 6)
        self.assertGreaterEqual(study["result"]["high"], 6)
        self.assertIn("failed", {row["state"] for row in rows})


class Life(StudyTest):
    config = {"stop_seconds": 30}  # a stop takes the time that the fake worker wants
    def test_a_failed_job_is_a_row(self):
        scene = study_scene({"fail": {"reason": "unstable", "exit": 11, "row": 1, "above": 2.5}})
        study, rows = self.run_study(study_body(GRID, scene=scene))
        self.assertEqual((study["counts"]["succeeded"], study["counts"]["failed"]), (4, 2))
        for row in rows:
            failed = row["parameters"]["duration"] == 3
            self.assertEqual(row["state"], "failed" if failed else "succeeded")
            self.assertEqual(row["reason"], "unstable" if failed else None)

    def test_csv(self):
        study, rows = self.run_study(study_body(GRID))
        reply = self.client.get(f"/v1/studies/{study['id']}/results", accept="text/csv")
        self.assertEqual(reply.headers["content-type"].split(";")[0], "text/csv")
        table = list(csv.DictReader(io.StringIO(reply.body.decode())))
        self.assertEqual(len(table), 6)
        for line, row in zip(table, rows):
            self.assertEqual(int(line["row"]), row["row"])
            self.assertEqual(line["job"], row["job"])
            self.assertEqual(float(line["stiffness"]), row["parameters"]["stiffness"])
            self.assertEqual(float(line["probe.runout.max"]), row["metrics"]["probe.runout.max"])

    def test_chart(self):
        chart = {"x": "duration", "y": "probe.runout.time_of_max", "series": "stiffness",
                 "log": "y"}
        study, _ = self.run_study(study_body(GRID, chart=chart))
        reply = self.client.get(f"/v1/studies/{study['id']}/chart.svg")
        self.assertEqual(reply.status, 200, reply)
        self.assertEqual(reply.headers["content-type"], "image/svg+xml")
        self.assertIn(b'"x": "duration"', reply.body)
        self.assertIn(b'"probe.runout.max": "m"', reply.body)
        self.assertNotIn(b'"probe.runout.time_of_max":', reply.body)
        self.assertIn(b"6 rows", reply.body)
        self.assertEqual(study["chart"], chart)
        plain, _ = self.run_study(study_body(GRID))
        problem = self.assert_problem(
            self.client.get(f"/v1/studies/{plain['id']}/chart.svg"), 404)
        self.assertIn("chart", problem["detail"])

    def test_list_pages_and_states(self):
        made = [self.submit(study_body(GRID, name=f"n{index}"))["id"] for index in range(3)]
        for study_id in made:
            self.end(study_id)
        seen, cursor = [], ""
        while True:
            page = self.client.get(f"/v1/studies?limit=1&state=finished{cursor}").json()
            seen += [study["id"] for study in page["studies"]]
            if page["cursor"] is None:
                break
            cursor = "&cursor=" + page["cursor"]
        self.assertEqual(seen, sorted(seen, reverse=True))
        self.assertTrue(set(made) <= set(seen))
        self.assertNotIn("scene", self.client.get("/v1/studies").json()["studies"][0])
        self.assert_problem(self.client.get("/v1/studies?state=done"), 422)
        self.assert_problem(self.client.get("/v1/studies?cursor=x"), 422)

    def test_cancel(self):
        body = study_body(GRID, scene=study_scene({"seconds": 30, "term_delay": 5}))
        study = self.submit(body)
        wait_for(lambda: self.study(study["id"])["counts"]["running"] == 2, what="two running jobs")
        # All other rows are jobs already: nothing but the wish itself tells the driver.
        wait_for(lambda: self.study(study["id"])["counts"]["queued"] == 4, what="four queued jobs")
        reply = self.client.post(f"/v1/studies/{study['id']}/cancel")
        self.assertEqual(reply.status, 200, reply)
        self.assertTrue(reply.json()["cancel_requested"])
        self.assertEqual(reply.json()["counts"]["waiting"], 0)
        self.assert_problem(self.client.delete(f"/v1/studies/{study['id']}"), 409)
        study = self.end(study["id"])
        self.assertEqual(study["state"], "cancelled")
        self.assertEqual(study["counts"]["cancelled"], 6, self.results(study["id"]))
        self.assertEqual(self.client.post(f"/v1/studies/{study['id']}/cancel").status, 200)
        for job in self.client.get(f"/v1/jobs?study={study['id']}").json()["jobs"]:
            self.assertEqual(job["state"], "cancelled")

    def test_cancel_of_a_finished_study(self):
        study, _ = self.run_study(study_body(GRID))
        self.assert_problem(self.client.post(f"/v1/studies/{study['id']}/cancel"), 409)

    def test_delete_removes_own_jobs_but_not_reused_ones(self):
        first, rows = self.run_study(study_body(GRID, scene=study_scene(gravity=[0, -1])))
        again = study_body(GRID, scene=study_scene(gravity=[0, -1]), reuse=True)
        second, reused = self.run_study(again)
        self.assertEqual(second["counts"]["reused"], 6)
        self.assertEqual([row["job"] for row in reused], [row["job"] for row in rows])
        self.assertTrue(all(row["reused"] for row in reused))
        self.assertEqual([row["metrics"] for row in reused], [row["metrics"] for row in rows])
        self.assertEqual(self.client.get(f"/v1/jobs?study={second['id']}").json()["jobs"], [])
        self.assertEqual(self.client.delete(f"/v1/studies/{second['id']}").status, 204)
        self.assertEqual(self.client.get(f"/v1/studies/{second['id']}").status, 404)
        for row in rows:
            self.assertEqual(self.client.job(row["job"])["state"], "succeeded")
        third, _ = self.run_study(again)
        self.assertEqual(self.client.delete(f"/v1/studies/{first['id']}").status, 204)
        for row in rows:
            self.assertEqual(self.client.get(f"/v1/jobs/{row['job']}").status, 404)
            self.assertIsNone(self.daemon.job_folder(row["job"]))
        # What another study showed of them stays, without the jobs.
        for row, before in zip(self.results(third["id"])["rows"], reused):
            self.assertEqual(row["metrics"], before["metrics"])
            self.assertIsNone(row["job"])

    def test_forecast(self):
        body = study_body(GRID, scene=study_scene(gravity=[0, -2]), reuse=True)
        before = len(self.client.get("/v1/studies").json()["studies"])
        reply = self.client.post("/v1/forecast", body)
        self.assertEqual(reply.status, 200, reply)
        forecast = reply.json()["forecast"]
        self.assertEqual((forecast["rows"], forecast["reused"]), (6, 0))
        self.assertEqual(forecast["steps"], 6000)
        self.assertAlmostEqual(forecast["wall_seconds"]["expected"], 1.2)
        self.assertAlmostEqual(forecast["elapsed_seconds"]["expected"], 0.6)
        self.assertEqual(len(self.client.get("/v1/studies").json()["studies"]), before)
        study, _ = self.run_study(body)
        self.assertEqual(study["forecast"], forecast)
        forecast = self.client.post("/v1/forecast", body).json()["forecast"]
        self.assertEqual((forecast["rows"], forecast["reused"]), (6, 6))
        self.assertEqual(forecast["steps"], 0)

    def test_revision(self):
        study, _ = self.run_study(study_body(GRID))
        path = f"/v1/studies/{study['id']}"
        etag = self.client.get(path).headers["etag"]
        self.assertEqual(self.client.get(path, if_none_match=etag).status, 304)
        self.assertEqual(self.client.get(path + "?wait=0.2", if_none_match=etag).status, 304)
        self.assert_problem(self.client.delete(path, if_match='"0"'), 412)
        self.assertEqual(self.client.delete(path, if_match=etag).status, 204)

    def test_idempotency(self):
        body = study_body(GRID)
        key = {"idempotency_key": "study-1"}
        study = self.submit(body, **key)
        reply = self.client.post("/v1/studies", body, **key)
        self.assertEqual(reply.status, 201)
        self.assertEqual(reply.headers["idempotent-replayed"], "true")
        self.assertEqual(reply.json()["id"], study["id"])
        self.assert_problem(self.client.post("/v1/studies", dict(body, name="b"), **key), 422)
        self.end(study["id"])
        self.assertEqual(self.client.delete(f"/v1/studies/{study['id']}").status, 204)
        self.assertNotEqual(self.submit(body, **key)["id"], study["id"])


class Refusals(StudyTest):
    def refused(self, body, code, pointer):
        before = len(self.client.get("/v1/studies?limit=500").json()["studies"])
        problem = self.assert_problem(self.client.post("/v1/studies", body), 422, code, pointer)
        self.assertEqual(len(self.client.get("/v1/studies?limit=500").json()["studies"]), before)
        return problem

    def test_unknown_keys(self):
        problem = self.refused(study_body(GRID, metrcis=[]), "unknown_key", "/metrcis")
        self.assertIn("metrics", problem["errors"][0]["detail"])
        self.refused(study_body(GRID, chart={"x": "duration", "y": "steps", "color": 1}),
                     "unknown_key", "/chart/color")

    def test_missing_keys(self):
        for key in ("name", "scene", "design", "metrics"):
            body = study_body(GRID)
            del body[key]
            self.refused(body, "required", "/" + key)

    def test_metrics(self):
        for metric in ("probe.runuot.final", "probe.runout.last", "wall_second", "reaction.floor.peak",
                       "error.runout", "probe.runout"):
            self.refused(study_body(GRID, metrics=[metric]), "unknown_value", "/metrics/0")
        self.refused(study_body(GRID, metrics=["steps", "steps"]), "repeated", "/metrics/1")
        self.refused(study_body(GRID, metrics=[3]), "type", "/metrics/0")
        problem = self.refused(study_body(GRID, metrics=["wall_second"]), "unknown_value",
                               "/metrics/0")
        self.assertIn("wall_seconds", problem["errors"][0]["detail"])

    def test_chart(self):
        self.refused(study_body(GRID, chart={"x": "nothing", "y": "steps"}), "unknown_value",
                     "/chart/x")
        self.refused(study_body(GRID, chart={"x": "duration"}), "required", "/chart/y")
        self.refused(study_body(GRID, chart={"x": "duration", "y": "steps", "log": "w"}), "type",
                     "/chart/log")

    def test_one_bad_row_refuses_the_study_and_is_named(self):
        """The fake helper refuses a scene whose duration is negative."""
        design = {"grid": {"parameters": {"d": [1, 2, -3, 4]}, "set": {"/duration": "d"}}}
        problem = self.refused(study_body(design), "range", "/scene/duration")
        error = problem["errors"][0]
        self.assertEqual(error["row"], 2)
        self.assertEqual(error["parameters"], {"d": -3})
        self.assertIn("row 2", error["detail"])

    def test_a_row_that_kills_or_holds_the_helper(self):
        for wish, status in (("hang", 422), ("die", 503)):
            body = study_body({"grid": {"parameters": {"t": ["a", "b", "c"]}, "set": {"/title": "t"}}})
            body["design"]["grid"]["parameters"]["t"][1] = 'fake {"helper": "%s"}' % wish
            reply = self.client.post("/v1/studies", body)
            self.assertEqual(reply.status, status, (wish, reply))
            if wish == "hang":
                self.assertEqual([e["row"] for e in reply.json()["errors"]], [1])
        self.run_study(study_body(GRID))

    def test_not_a_study(self):
        self.assert_problem(self.client.post("/v1/studies", [1]), 422, "type", "")
        self.assert_problem(self.client.get("/v1/studies/nothing"), 404)
        self.assert_problem(self.client.get("/v1/studies/01m82b5c26js54kv9yjhj9pxct"), 404)
        self.assert_problem(self.client.request("PUT", "/v1/studies"), 405)


if __name__ == "__main__":
    unittest.main()
