# SPDX-License-Identifier: Apache-2.0
"""The studies that are shipped: the daemon takes every row of all of them, and parts of them, run with
the real worker, find what the documentation's tables say. TALUS_FULL=1 runs them whole (the sand
columns apart, which take an hour)."""
import csv
import json
import math
import os
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "protocol"))
from talus_harness import DaemonTest, PATIENCE, wait_for

STUDIES = ROOT / "clients" / "scenes" / "studies"
FULL = os.environ.get("TALUS_FULL") == "1"
# The bisections of the map stop at 3 % of the number, those of the study at 0.02.
MAP_TOLERANCE = 0.05


def study_of(name):
    return json.loads((STUDIES / f"{name}.json").read_text())


def table(path):
    with open(ROOT / "docs" / path, newline="") as file:
        return list(csv.DictReader(file))


class ShippedStudies(DaemonTest):
    real = True

    def run_study(self, body):
        reply = self.client.post("/v1/studies", body)
        self.assertEqual(reply.status, 201, reply)
        path = "/v1/studies/" + reply.json()["id"]
        wait_for(lambda: self.client.get(path).json()["state"] != "running",
                 (7200 if FULL else 120) * PATIENCE, f"the end of {body['name']}", every=0.2)
        study = self.client.get(path).json()
        self.assertEqual(study["state"], "finished", study["detail"])
        return study, self.client.get(path + "/results").json()["rows"]

    def test_every_row_of_every_study_is_taken(self):
        names = sorted(path.stem for path in STUDIES.glob("*.json"))
        self.assertGreaterEqual(len(names), 10)
        for name in names:
            with self.subTest(name):
                reply = self.client.post("/v1/forecast", study_of(name))
                self.assertEqual(reply.status, 200, reply)
                self.assertGreater(reply.json()["forecast"]["rows"], 0)
        columns = self.client.post("/v1/forecast", study_of("mast-7.2-sand-columns")).json()
        self.assertEqual(columns["forecast"]["rows"], 180)

    def test_bouncing_block(self):
        """Energy grows by 2.7 % at a factor of 0.6 and is lost at 0.4."""
        study, rows = self.run_study(study_of("stability-bouncing-block"))
        self.assertTrue(0.4 < study["result"]["value"] < 0.6, study["result"])
        self.assertLessEqual(study["result"]["high"] - study["result"]["low"], 0.02)
        self.assertLessEqual(len(rows), 9)

    def test_stability_map(self):
        rows = {tuple(row[key] for key in ("shape", "transfer", "stress_update", "anti_locking")): row
                for row in table("stability/stability-map.csv")}
        names = (sorted(path.stem for path in STUDIES.glob("stability-map-*.json")) if FULL else
                 ("stability-map-uniform", "stability-map-quadratic-uniform"))
        for name in names:
            body = name.split("-")[-1]
            study = study_of(name)
            parameters = study["design"]["bisect"]["for_each"]["parameters"]
            if not FULL:
                shapes = [shape for shape in parameters["shape"]
                          if shape in ("linear", "bspline2", "quadratic")]
                parameters.update(shape=shapes, transfer=["flip"],
                                  stress_update=["modified_last"],
                                  anti_locking=parameters["anti_locking"][:2])
            study, _ = self.run_study(study)
            for found in study["result"]["for_each"]:
                method = tuple(found["parameters"][key] for key in parameters)
                wanted = float(rows[method][body])
                with self.subTest(name, method=method):
                    self.assertAlmostEqual(found["value"], wanted, delta=MAP_TOLERANCE * wanted + 0.02)

    def test_accuracy_against_cost(self):
        """The same particle-steps as in the chart's table, and its error times the square root of two
        (README of the studies), but for the rounding of the reference curve."""
        chart = {(row["method"], row["resolution"]): row
                 for row in table("work-precision/work-precision.csv") if row["problem"] == "cantilever"}
        study = study_of("work-precision-cantilever")
        design = study["design"]["work_precision"]
        if not FULL:
            design["variants"] = [variant for variant in design["variants"]
                                  if variant["label"] in ("linear", "bspline3", "linear, cell full")]
            design["resolutions"] = design["resolutions"][:2]
        _, rows = self.run_study(study)
        self.assertEqual(len(rows), len(design["variants"]) * len(design["resolutions"]))
        for row in rows:
            wanted = chart[row["parameters"]["variant"], row["parameters"]["resolution"].split()[0]]
            with self.subTest(**row["parameters"]):
                self.assertAlmostEqual(row["metrics"]["particle_steps"] / float(wanted["particle_steps"]),
                                       1, delta=1e-5)
                self.assertAlmostEqual(row["metrics"]["error.beam"] / float(wanted["error"]),
                                       math.sqrt(2), delta=0.02)


if __name__ == "__main__":
    unittest.main()
