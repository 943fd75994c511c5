# SPDX-License-Identifier: Apache-2.0
"""talus-worker check, describe and helper, as processes."""
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest

import scene_samples

WORKER = ""


def run(*arguments):
    return subprocess.run([WORKER, *arguments], capture_output=True, text=True, timeout=30)


def write_scene(folder, content):
    path = os.path.join(folder, "scene.json")
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(content if isinstance(content, str) else json.dumps(content))
    return path


class Check(unittest.TestCase):
    def check(self, content, *options):
        with tempfile.TemporaryDirectory() as folder:
            return run("check", write_scene(folder, content), *options)

    def test_a_valid_scene_prints_its_cost(self):
        for name, scene in scene_samples.SCENES.items():
            result = self.check(scene)
            self.assertEqual(result.returncode, 0, (name, result.stderr))
            self.assertEqual(result.stderr, "")
            for word in ("particles", "critical time step", "memory", "disk", "wall time"):
                self.assertIn(word, result.stdout)

    def test_every_mistake_is_a_line_on_standard_error(self):
        scene = scene_samples.changed(scene_samples.BLOCK, ["grid", "cel"], 1)
        scene = scene_samples.changed(scene, ["bodies", 0, "velocity"], [1, 2, 3])
        result = self.check(scene)
        self.assertEqual(result.returncode, 10)
        self.assertEqual(result.stdout, "")
        lines = result.stderr.splitlines()
        self.assertEqual(sorted(line.split(":")[0] for line in lines),
                         ["/bodies/0/velocity", "/grid/cel"])
        self.assertIn("did you mean 'cell'?", result.stderr)

    def test_text_that_is_not_json(self):
        result = self.check("{\n \"duration\": 1,\n}")
        self.assertEqual(result.returncode, 10)
        self.assertIn("line 3", result.stderr)

    def test_json_output(self):
        result = self.check(scene_samples.BLOCK, "--json", "--threads", "2")
        answer = json.loads(result.stdout)
        self.assertTrue(answer["ok"])
        self.assertEqual(answer["forecast"]["particles"], 128)
        self.assertEqual(len(answer["hash"]), 64)
        wrong = json.loads(self.check({}, "--json").stdout)
        self.assertFalse(wrong["ok"])
        self.assertIn("/dimension", [error["pointer"] for error in wrong["errors"]])

    def test_usage(self):
        for arguments in ([], ["a", "b"], ["--threads"], ["a", "--threads", "0"], ["--what"]):
            self.assertEqual(run("check", *arguments).returncode, 1, arguments)
        self.assertEqual(run("check", "/nowhere.json").returncode, 10)


class Describe(unittest.TestCase):
    def test_text_and_json_name_everything(self):
        text = run("describe")
        self.assertEqual(text.returncode, 0)
        answer = json.loads(run("describe", "--json").stdout)
        for part, key in (("materials", "model"), ("conditions", "condition"),
                          ("fields", "field"), ("shapes", "shape")):
            self.assertGreater(len(answer[part]), 0)
            for entry in answer[part]:
                self.assertIn(f"  {entry[key]}: ", text.stdout)
        soil = next(entry for entry in answer["materials"]
                    if entry["model"] == "drucker_prager_cap")
        parameters = {entry["key"]: entry for entry in soil["parameters"]}
        self.assertEqual(parameters["density"]["unit"], "kg/m^3")
        self.assertEqual(parameters["density"]["exclusiveMinimum"], 0)
        self.assertTrue(parameters["density"]["required"])
        self.assertEqual(run("describe", "all").returncode, 1)


class Conversation(unittest.TestCase):
    def setUp(self):
        self.helper = scene_samples.Helper(WORKER)

    def tearDown(self):
        self.assertEqual(self.helper.close(), 0)

    def test_check(self):
        answer = self.helper.ask(op="check", scene=scene_samples.BALL, threads=2)
        self.assertTrue(answer["ok"])
        self.assertEqual(set(answer),
                         {"ok", "effective", "forecast", "advice", "warnings", "hash", "build"})
        self.assertEqual(answer["effective"]["solver"]["courant"], 0.4)
        self.assertEqual(answer["effective"]["solver"]["shape"], "bspline2")
        again = self.helper.ask(op="check", scene=answer["effective"])
        self.assertEqual(again["effective"], answer["effective"])
        self.assertEqual(again["hash"], answer["hash"])

    def test_mistakes(self):
        scene = scene_samples.changed(scene_samples.BALL, ["solver", "time_step"], 1.0)
        answer = self.helper.ask(op="check", scene=scene)
        self.assertFalse(answer["ok"])
        self.assertEqual([(error["pointer"], error["code"]) for error in answer["errors"]],
                         [("/solver/time_step", "over_critical")])

    def test_bad_questions_are_answered(self):
        for line in (b"nonsense", b"{}", b"[1]", b"null", b'{"op": 7}', b'{"op": "dance"}',
                     b'{"op": "check"}', b'{"op": "check", "scene": 5}', b'{"op": "render"}',
                     b'{"op": "check", "op": "check"}', b'"' + b"x" * 100000 + b'"',
                     b'{"op":"check","scene":' + b"[" * 3000 + b"]" * 3000 + b"}",
                     b'{"op":"check","scene":' + b"[" * 500 + b"]" * 500 + b"}",
                     b'{"op":"check","scene":{"duration":1e999}}', b"\xff\xfe", b"\x00",
                     b'{"op":"render","folder":"/nowhere","output":"/nowhere/a.png"}',
                     b'{"op":"render","folder":"/","output":"/a","frame":-1}'):
            answer = self.helper.ask_text(line)
            self.assertFalse(answer["ok"], line[:60])
            self.assertGreater(len(answer["errors"]), 0)
        self.assertTrue(self.helper.ask(op="describe")["ok"])
        self.assertEqual(self.helper.ask(op="schema")["schema"]["type"], "object")

    def test_huge_scenes_are_refused_at_once(self):
        huge = [scene_samples.changed(scene_samples.BALL, ["bodies", 0, "spacing"], 1e-5),
                scene_samples.changed(scene_samples.BALL, ["grid", "cell"], 1e-12),
                scene_samples.changed(scene_samples.BALL, ["grid", "max"], [1e29, 1e29, 1e29]),
                scene_samples.changed(scene_samples.BLOCK, ["output", "frames", "every"], 1e-29)]
        begin = time.monotonic()
        for scene in huge:
            answer = self.helper.ask(op="check", scene=scene)
            self.assertFalse(answer["ok"])
            self.assertEqual({error["code"] for error in answer["errors"]}, {"limit"})
        self.assertLess(time.monotonic() - begin, 0.5)

    def test_many_entries_are_cheap(self):
        body = scene_samples.BLOCK["bodies"][0]
        bodies = [dict(body, name=f"body{index}") for index in range(1000)]
        scene = scene_samples.changed(scene_samples.BLOCK, ["bodies"], bodies)
        begin = time.monotonic()
        self.assertTrue(self.helper.ask(op="check", scene=scene)["ok"])
        scene = scene_samples.changed(scene_samples.BLOCK, ["bodies"], bodies + [body])
        self.assertFalse(self.helper.ask(op="check", scene=scene)["ok"])
        self.assertLess(time.monotonic() - begin, 5.0)


if __name__ == "__main__":
    WORKER = sys.argv.pop(1)
    unittest.main()
