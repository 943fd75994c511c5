# SPDX-License-Identifier: Apache-2.0
"""talus-worker helper, op chart: SVG for good tables, errors for others, and it goes on."""
import json
import random
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml

WORKER = ""
SVG = "{http://www.w3.org/2000/svg}"


def row(parameters, metrics, state="succeeded"):
    return {"parameters": parameters, "state": state, "metrics": metrics}


def table(chart, **more):
    rows = [row({"a": a, "b": b, "model": f"m{b}"}, {"m": a * b + 1, "n": a})
            for a in range(1, 5) for b in range(1, 4)]
    return {"op": "chart", "rows": rows, "chart": chart, **more}


class ChartHelper(unittest.TestCase):
    def setUp(self):
        self.helper = subprocess.Popen([WORKER, "helper"], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, text=True, encoding="utf-8")

    def tearDown(self):
        self.helper.stdin.close()
        self.assertEqual(self.helper.wait(60), 0)
        self.helper.stdout.close()

    def ask(self, question):
        self.helper.stdin.write(json.dumps(question) + "\n")
        self.helper.stdin.flush()
        return json.loads(self.helper.stdout.readline())

    def draw(self, question):
        """The root of the chart's SVG, which is well-formed and needs nothing else."""
        answer = self.ask(question)
        self.assertTrue(answer["ok"], answer)
        self.assertNotIn("http://localhost", answer["svg"])
        root = xml.fromstring(answer["svg"])
        self.assertEqual(root.tag, SVG + "svg")
        return root

    def refuse(self, question, pointer, code):
        answer = self.ask(question)
        self.assertFalse(answer["ok"])
        error, = answer["errors"]
        self.assertEqual((error["pointer"], error["code"]), (pointer, code))
        self.assertTrue(error["detail"])

    def test_kinds(self):
        lines = self.draw(table({"x": "a", "y": "m", "series": "model"}, title="Lines & <more>"))
        self.assertEqual(lines.get("viewBox").split()[2], "1000")
        self.draw(table({"x": "n", "y": "m", "series": "model", "log": True},
                        kind="work_precision"))
        contours = self.draw(table({"x": "a", "y": "b", "z": "m"}, width=800))
        self.assertEqual(contours.get("viewBox").split()[2], "800")
        rows = self.draw(table({"x": "a", "y": "n", "z": "m", "series": "model", "log": ["x"]}))
        self.assertGreater(float(rows.get("viewBox").split()[3]),
                           float(contours.get("viewBox").split()[3]))

    def test_the_same_question_has_the_same_answer(self):
        question = table({"x": "a", "y": "b", "z": "m"})
        self.assertEqual(self.ask(question), self.ask(question))

    def test_few_rows(self):
        for rows in [], [row({"a": 1, "b": 2}, {"m": 3})], [row({"a": 1}, {}, "queued")]:
            for z in {}, {"z": "m"}:
                self.draw({"op": "chart", "rows": rows, "chart": {"x": "a", "y": "m", **z}})

    def test_mistakes(self):
        self.refuse({"op": "chart"}, "/chart", "required")
        self.refuse(table({"x": "a"}), "/chart/y", "required")
        self.refuse(table({"x": "a", "y": "m"}, colour="red"), "", "unknown_key")
        self.refuse(table({"x": "model", "y": "b", "z": "m"}), "/chart/x", "type")
        self.refuse(table({"x": "a", "y": "m", "series": "n"}), "/chart/series", "unknown_value")

    def test_broken_questions(self):
        """Members replaced at random: an SVG or an error, never the end of the helper."""
        source = random.Random(1)
        odd = [None, True, 0, -1e308, 10**17, "", "m", "\x7f\u202e\U0001f600", [], {}, [[]],
               {"a": {}}, ["x", "y"], "x" * 5000]
        for _ in range(150):
            question = table({"x": "a", "y": "b", "z": "m", "log": "xz"}, kind="grid", title="t")
            for _ in range(source.randint(1, 3)):
                place = question
                while True:
                    keys = list(place) if isinstance(place, dict) else list(range(len(place)))
                    if not keys:
                        break
                    key = source.choice(keys)
                    if key != "op" and (source.random() < 0.3 or
                                        not isinstance(place[key], (dict, list))):
                        place[key] = source.choice(odd)
                        break
                    if key != "op":
                        place = place[key]
            answer = self.ask(question)
            if answer["ok"]:
                xml.fromstring(answer["svg"])
            else:
                self.assertTrue(answer["errors"][0]["code"])


if __name__ == "__main__":
    WORKER = sys.argv.pop(1)
    unittest.main()
