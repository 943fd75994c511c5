# SPDX-License-Identifier: Apache-2.0
"""The JSON Schema and the reader agree: what one accepts or refuses, so does the other."""
import sys
import unittest

import mini_schema
import scene_samples

WORKER = ""

# Mistakes that a schema can see, as (scene, keys, value); REMOVE takes the key away.
REMOVE = object()
MISTAKES = [
    ("block", ["dimension"], "plane"),
    ("block", ["dimension"], "plane_stresses"),
    ("block", ["duration"], 0),
    ("block", ["duration"], REMOVE),
    ("block", ["bodys"], []),
    ("block", ["grid", "cel"], 1),
    ("block", ["grid", "cell"], [0.5, -1]),
    ("block", ["grid", "outside"], "ignore"),
    ("block", ["solver"], {"shape": "gimp3"}),
    ("block", ["solver"], {"time_step": "now"}),
    ("block", ["solver"], {"theta": 1.5}),
    ("block", ["solver"], {"tolerance": 1}),
    ("block", ["materials", "soil", "model"], "mud"),
    ("block", ["materials", "soil", "model"], REMOVE),
    ("block", ["materials", "soil", "density"], REMOVE),
    ("block", ["materials", "soil", "cone_slope"], 0.3),
    ("block", ["materials", "soil", "friction_angle"], REMOVE),
    ("block", ["materials", "soil", "shear_modulus"], REMOVE),
    ("block", ["bodies"], []),
    ("block", ["bodies", 0, "box"], REMOVE),
    ("block", ["bodies", 0, "sphere"], {"centre": [1, 1], "radius": 1}),
    ("block", ["bodies", 0, "polygon"], {"vertices": []}),
    ("block", ["bodies", 0, "name"], "my heap"),
    ("block", ["bodies", 0, "spacing"], 1),
    ("block", ["bodies", 0, "velocity"], {"rotation": {}}),
    ("block", ["bodies", 0, "initial_stress"], "lithostatic"),
    ("block", ["bodies", 0, "initial_stress"], [1, 2]),
    ("block", ["bodies", 0, "initial_stress"], {"geostatic": {"k0": "jakey"}}),
    ("block", ["boundaries", 0, "condition"], "slide"),
    ("block", ["boundaries", 0, "friction_coefficient"], 0.1),
    ("block", ["boundaries", 0, "plane"], REMOVE),
    ("block", ["boundaries", 1, "faces"], {"left": {"condition": "slip"}}),
    ("block", ["boundaries", 1, "tension_release"], "yes"),
    ("block", ["probes", 0, "kind"], "runout"),
    ("block", ["probes", 2, "field"], "stres"),
    ("block", ["references", 0, "value"], 1),
    ("block", ["references", 0, "curve"], [[0, 1]]),
    ("block", ["output", "frames", "fields"], ["velocity", "velocity"]),
    ("block", ["output", "history"], {"every": 0}),
    ("ball", ["boundaries", 0, "face", "max"], REMOVE),
    ("ball", ["audits"], {"energy": 1}),
    ("ball", ["materials", "rubber", "poisson_ratio"], 0.5),
    ("water", ["materials", "water", "exponent"], 0.5),
    ("water", ["bodies", 0, "count"], [12, 2.5]),
    ("sand", ["materials", "sand", "friction", "a0"], REMOVE),
    ("sand", ["materials", "sand", "friction_angle"], 30),
]


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.helper = scene_samples.Helper(WORKER)
        cls.schema = cls.helper.ask(op="schema")["schema"]

    @classmethod
    def tearDownClass(cls):
        cls.helper.close()

    def test_both_accept_what_is_right(self):
        for name, scene in scene_samples.SCENES.items():
            answer = self.helper.ask(op="check", scene=scene)
            self.assertTrue(answer["ok"], (name, answer.get("errors")))
            self.assertTrue(mini_schema.accepts(self.schema, scene), name)
            self.assertTrue(mini_schema.accepts(self.schema, answer["effective"]), name)

    def test_both_refuse_what_is_wrong(self):
        for name, keys, value in MISTAKES:
            scene = scene_samples.changed(scene_samples.SCENES[name], keys, value,
                                          remove=value is REMOVE)
            self.assertFalse(self.helper.ask(op="check", scene=scene)["ok"], (name, keys))
            self.assertFalse(mini_schema.accepts(self.schema, scene), (name, keys))

    def test_what_is_missing_from_the_build_is_missing_from_the_schema(self):
        text = str(self.schema)
        for word in ("quasi_static", "composite", "recovery", "stiffness", "element", "phases",
                     "max_iterations"):
            self.assertNotIn(f"'{word}'", text)


if __name__ == "__main__":
    WORKER = sys.argv.pop(1)
    unittest.main()
