# SPDX-License-Identifier: Apache-2.0
"""Wrong scenes over HTTP, checked by the real worker: 422 with the right pointer, at once."""
import statistics
import time
import unittest

from scene_mistakes import MISTAKES, broken, good_scene
from talus_harness import DaemonTest, PATIENCE


class SceneMistakes(DaemonTest):
    real = True

    def test_the_good_scene_is_good(self):
        reply = self.client.post("/v1/forecast", {"scene": good_scene()})
        self.assertEqual(reply.status, 200, reply)
        self.assertEqual(reply.json()["forecast"]["particles"], 256)

    def timed(self, path, scene, took):
        begin = time.monotonic()
        reply = self.client.post(path, {"scene": scene})
        took.append(time.monotonic() - begin)
        return reply

    def test_every_mistake_is_named(self):
        self.assertGreaterEqual(len(MISTAKES), 60)
        took, good = [], []
        for what, changes, pointer in MISTAKES:
            with self.subTest(what):
                self.timed("/v1/forecast", good_scene(), good)
                reply = self.timed("/v1/jobs", broken(changes), took)
                problem = self.assert_problem(reply, 422)
                pointers = [error["pointer"] for error in problem["errors"]]
                self.assertTrue(all(p.startswith("/scene") for p in pointers), pointers)
                wanted = "/scene" + pointer
                self.assertTrue(any(p == wanted or p.startswith(wanted + "/") for p in pointers),
                                f"{wanted} not in {problem['errors']}")
        # No mistake costs much more than a forecast, and none the 5 s after which a helper is given up.
        self.assertLess(statistics.median(took), 3 * statistics.median(good))
        self.assertLess(max(took), 4.0 * PATIENCE)

    def test_unsupported_says_so(self):
        for path in ("/solver/kind", "/dimension"):
            for what, changes, pointer in MISTAKES:
                if pointer == path and what in ("quasi-static", "plane stress"):
                    with self.subTest(what):
                        reply = self.client.post("/v1/jobs", {"scene": broken(changes)})
                        self.assert_problem(reply, 422, "unsupported", "/scene" + path)

    def test_near_misses(self):
        for changes, pointer, suggestion in (
                ([("/durration", 1)], "/scene/durration", "duration"),
                ([("/solver/timestep", 1e-5)], "/scene/solver/timestep", "time_step"),
                ([("/bodies/0/velocty", [0, 0])], "/scene/bodies/0/velocty", "velocity")):
            problem = self.assert_problem(
                self.client.post("/v1/jobs", {"scene": broken(changes)}), 422)
            error = next(e for e in problem["errors"] if e["pointer"] == pointer)
            self.assertIn(suggestion, str(error))

    def test_many_mistakes_at_once(self):
        changes = [change for _, changes, pointer in MISTAKES[14:22] for change in changes]
        problem = self.assert_problem(self.client.post("/v1/jobs", {"scene": broken(changes)}), 422)
        self.assertGreaterEqual(len(problem["errors"]), 8)
        scene = good_scene()
        scene.update({f"key_{index}": index for index in range(500)})
        problem = self.assert_problem(self.client.post("/v1/jobs", {"scene": scene}), 422)
        self.assertLessEqual(len(problem["errors"]), 50)

    def test_nothing_was_made(self):
        self.assertEqual(self.client.get("/v1/jobs").json()["jobs"], [])


if __name__ == "__main__":
    unittest.main()
