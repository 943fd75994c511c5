# SPDX-License-Identifier: Apache-2.0
"""`talus study` against the real daemon and worker."""
import csv
import io
import json
import os
import sys
import unittest

import test_client_with_daemon as base

GRID_OF_FOUR = {"grid": {"parameters": {"h": [0.2, 0.3], "courant": [0.2, 0.4]},
                   "set": {"/bodies/0/box/max/1": "h", "/solver/courant": "courant"}}}
SCENE = dict(base.SCENE, duration=0.02, solver={"courant": 0.4},
             output={"frames": {"every": 0.02, "fields": ["velocity"]}, "history": {"every": 0.005}})


class Study(base.WithDaemon):
    def write(self, **changes):
        study = {"name": "falling squares", "scene": SCENE, "design": GRID_OF_FOUR,
                 "metrics": ["steps", "energy_error"], **changes}
        with open(os.path.join(self.folder, "study.json"), "w", encoding="utf-8") as stream:
            json.dump(study, stream)

    def test_life_of_a_study(self):
        self.write()
        check = self.talus("study", "submit", "study.json", "--check")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("4 rows, 0 of them", check.stdout)
        self.assertEqual(self.run_json("study", "list"), [])
        result = self.talus("study", "submit", "study.json", "--watch", "--name", "squares")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("finished  4 of 4 rows", result.stdout)
        (study,) = self.run_json("study", "list", "--state", "finished")
        self.assertEqual((study["name"], study["state"]), ("squares", "finished"))
        self.assertEqual(self.run_json("study", "list", "--state", "running"), [])
        self.assertIn("4 succeeded", self.talus("study", "show", study["id"]).stdout)

        rows = self.run_json("study", "results", study["id"])["rows"]
        text = self.talus("study", "results", study["id"], "--csv").stdout
        table = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual([float(line["steps"]) for line in table],
                         [row["metrics"]["steps"] for row in rows])
        steps = {(row["parameters"]["h"], row["parameters"]["courant"]): row["metrics"]["steps"]
                 for row in rows}
        for height in (0.2, 0.3):
            self.assertGreater(steps[height, 0.2], steps[height, 0.4])
        self.assertEqual(len(self.talus("study", "results", study["id"]).stdout.splitlines()), 5)

        again = self.talus("study", "submit", "study.json", "--watch")
        self.assertIn("4 reused", again.stdout)
        (newest, _) = self.run_json("study", "list")
        self.assertEqual(self.talus("study", "chart", newest["id"]).returncode, 3)
        self.assertEqual(self.talus("study", "cancel", newest["id"]).returncode, 3)
        deleted = self.talus("study", "delete", newest["id"], study["id"])
        self.assertEqual(deleted.returncode, 0, deleted.stderr)
        self.assertEqual(self.run_json("study", "list"), [])
        self.assertEqual(self.run_json("list"), [])
        self.assertEqual(self.talus("study", "show", study["id"]).returncode, 3)

    def test_a_bisection(self):
        """The largest step that is stable needs no `steps` above a number: a condition on a count of
        steps has a known edge, duration / (courant x critical step)."""
        self.write(design={"bisect": {"parameter": "/solver/courant", "low": 0.1, "high": 0.8,
                                      "tolerance": 0.05, "condition": "steps > 12"}})
        result = self.talus("study", "submit", "study.json", "--watch")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("result", result.stdout)
        (study,) = self.run_json("study", "list")
        rows = self.run_json("study", "results", study["id"])["rows"]
        met = [row["parameters"]["/solver/courant"] for row in rows if row["metrics"]["steps"] > 12]
        missed = [row["parameters"]["/solver/courant"] for row in rows
                  if row["metrics"]["steps"] <= 12]
        self.assertEqual((study["result"]["low"], study["result"]["high"]), (max(met), min(missed)))

    def test_mistakes_name_the_row(self):
        self.write(design={"list": {"rows": [{"h": 0.2}, {"h": -1}],
                                    "set": {"/bodies/0/box/max/1": "h"}}})
        result = self.talus("study", "submit", "study.json")
        self.assertEqual(result.returncode, 3)
        self.assertIn("row 1", result.stderr)
        self.assertIn("/scene/bodies/0", result.stderr)
        self.assertEqual(self.talus("study", "submit", "none.json").returncode, 2)

    def test_cancelled_is_no_success(self):
        self.write(scene=dict(SCENE, duration=1000, output={"frames": {"every": 500}}))
        study = self.run_json("study", "submit", "study.json")
        self.assertEqual(self.talus("study", "delete", study["id"]).returncode, 3)
        self.assertEqual(self.talus("study", "cancel", study["id"]).returncode, 0)
        self.assertEqual(self.talus("study", "watch", study["id"]).returncode, 1)


if __name__ == "__main__":
    base.TALUSD, base.TALUS = sys.argv.pop(), sys.argv.pop()
    unittest.main()
