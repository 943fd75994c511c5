# SPDX-License-Identifier: Apache-2.0
"""Advice over HTTP: a program asks for it, follows what can be followed, and gets what was said."""
import unittest

from talus_harness import DaemonTest

TEXTS = {"pointer", "code", "detail", "change", "saves"}

# Too small a step, too many frames, too fine a history, one particle too few.
WASTEFUL = {
    "dimension": "plane_strain", "duration": 2.0,
    "grid": {"cell": 0.5, "min": [0, 0], "max": [20, 10]},
    "solver": {"time_step": 2e-4, "anti_locking": {"control": "cell"}},
    "materials": {"rubber": {"model": "linear_elastic", "density": 1000, "young_modulus": 1e6,
                             "poisson_ratio": 0.3}},
    "gravity": [0.1, -9.81],
    "bodies": [{"material": "rubber", "box": {"min": [0, 0], "max": [4, 2]},
                "particles_per_cell": [1, 2]}],
    "boundaries": [{"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]},
                    "condition": "slip"}],
    "output": {"frames": {"every": 1e-3}, "history": {"every": 1e-4}},
}


def follow(scene, item):
    for pointer, value in item["set"].items():
        place = scene
        *parents, last = pointer.split("/")[1:]
        for key in parents:
            place = place[int(key)] if isinstance(place, list) else place[key]
        place[int(last) if isinstance(place, list) else last] = value


class Advice(DaemonTest):
    real = True

    def forecast(self, scene):
        reply = self.client.post("/v1/forecast", {"scene": scene})
        self.assertEqual(reply.status, 200, reply)
        return reply.json()

    def test_is_followed(self):
        before = self.forecast(WASTEFUL)
        items = {item["code"]: item for item in before["advice"]}
        self.assertEqual(set(items), {"small_time_step", "many_frames", "fine_history",
                                      "superfluous_anti_locking", "few_particles"})
        scene = before["effective_scene"]
        for item in before["advice"]:
            self.assertLessEqual(TEXTS, set(item))
            follow(scene, item)
        after = self.forecast(scene)
        self.assertEqual(after["advice"], [])
        steps = [answer["forecast"]["steps"] for answer in (before, after)]
        # The forecast knows that automatic steps get smaller as the material falls.
        claimed = items["small_time_step"]["saving"]["particle_steps"]
        self.assertAlmostEqual(steps[0] / steps[1], claimed, delta=0.1 * claimed)

    def test_stays_with_the_job(self):
        reply = self.client.post("/v1/jobs", {"scene": WASTEFUL})
        self.assertEqual(reply.status, 201, reply)
        job = reply.json()
        again = self.client.get(f"/v1/jobs/{job['id']}").json()
        self.assertEqual(job["advice"], self.forecast(WASTEFUL)["advice"])
        self.assertEqual(again["advice"], job["advice"])


if __name__ == "__main__":
    unittest.main()
