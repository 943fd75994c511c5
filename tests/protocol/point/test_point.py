# SPDX-License-Identifier: Apache-2.0
"""talus-worker point: what it prints, and how it answers mistakes."""
import copy
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

WORKER = ""
ELASTIC = {"model": "linear_elastic", "density": 2000, "young_modulus": 1e6, "poisson_ratio": 0.25}
UNIAXIAL = {"material": ELASTIC,
            "path": [{"strain": {"xx": 0.01}, "stress": {"yy": 0, "zz": 0}, "steps": 4}]}


def run_text(text):
    """Exit code and the JSON lines."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        file.write(text)
        file.flush()
        output = subprocess.run([WORKER, "point", file.name], capture_output=True)
    return output.returncode, [json.loads(line) for line in output.stdout.splitlines()]


def run(document):
    return run_text(json.dumps(document))


def changed(**entries):
    document = copy.deepcopy(UNIAXIAL)
    document.update(entries)
    return document


class Output(unittest.TestCase):
    def test_one_line_a_step(self):
        code, lines = run(UNIAXIAL)
        self.assertEqual(code, 0)
        self.assertEqual([line["step"] for line in lines], [1, 2, 3, 4])
        for line in lines:
            strain = 0.01 * line["step"] / 4
            self.assertAlmostEqual(line["strain"][0], strain, delta=1e-15)
            self.assertAlmostEqual(line["strain"][1], -0.25 * strain, delta=1e-12)
            self.assertAlmostEqual(line["stress"][0], 1e6 * strain, delta=1e-6)
            self.assertAlmostEqual(line["p"], 1e6 * strain / 3, delta=1e-6)
            self.assertAlmostEqual(line["q"], 1e6 * strain, delta=1e-6)
            self.assertAlmostEqual(line["volumetric_strain"], 0.5 * strain, delta=1e-12)
            self.assertEqual((line["plastic_strain"], line["state"]), (0, {}))
        self.assertGreaterEqual(lines[0]["iterations"], 1)

    def test_kept_components_and_segments(self):
        code, lines = run(changed(path=[{"strain": {"xy": 0.02}, "steps": 1},
                                        {"strain": {"xx": 0.01}, "steps": 2}]))
        self.assertEqual(code, 0)
        self.assertEqual(lines[-1]["strain"], [0.01, 0, 0, 0.02, 0, 0])
        self.assertEqual(lines[-1]["iterations"], 0)

    def test_finite_strain(self):
        """Hencky: Kirchhoff stress is linear in the logarithmic strain; a rotation turns it."""
        stretch, angle = 1.5, 0.7
        c, s = math.cos(angle), math.sin(angle)
        gradient = [stretch, 0, 0, 0, 1, 0, 0, 0, 1]
        turned = [c * stretch, -s, 0, s * stretch, c, 0, 0, 0, 1]
        document = changed(strain="finite", path=[{"deformation_gradient": gradient, "steps": 7},
                                                  {"deformation_gradient": turned, "steps": 1}])
        code, lines = run(document)
        modulus = 1e6 * 0.75 / (1.25 * 0.5)
        stress = modulus * math.log(stretch) / stretch
        self.assertEqual(code, 0)
        self.assertAlmostEqual(lines[6]["stress"][0], stress, delta=1e-8)
        self.assertAlmostEqual(lines[6]["stress"][1], stress / 3, delta=1e-8)
        self.assertAlmostEqual(lines[7]["stress"][3], c * s * stress * 2 / 3, delta=1e-8)
        self.assertAlmostEqual(lines[7]["strain"][0], math.log(stretch), delta=1e-14)

    def test_initial_stress(self):
        code, lines = run(changed(initial_stress=[-5, -6, -7, 1, 2, 3],
                                  path=[{"strain": {}, "steps": 1}]))
        self.assertEqual(code, 0)
        for value, expected in zip(lines[0]["stress"], [-5, -6, -7, 1, 2, 3]):
            self.assertAlmostEqual(value, expected, delta=1e-12)


class Mistakes(unittest.TestCase):
    def refuse(self, document, *expected, code=10):
        status, lines = run(document)
        self.assertEqual(status, code)
        found = [(error["pointer"], error["code"]) for error in lines[-1]["errors"]]
        self.assertEqual(sorted(found), sorted(expected))

    def segment(self, **entries):
        return changed(path=[dict({"steps": 1}, **entries)])

    def material(self, **entries):
        return changed(material=dict(ELASTIC, **entries))

    def test_document(self):
        self.refuse({}, ("/material", "required"), ("/path", "required"))
        self.refuse(changed(colour=1), ("/colour", "unknown_key"))
        self.refuse(changed(strain="large"), ("/strain", "unknown_value"))
        self.refuse(changed(initial_stress=[0, 0]), ("/initial_stress", "length"))
        self.refuse(changed(initial_stress=[0, 0, 0, 0, 0, "a"]), ("/initial_stress/5", "type"))
        self.refuse(changed(path=[]), ("/path", "length"))
        self.refuse([], ("", "type"))

    def test_path(self):
        self.refuse(self.segment(strain={"xx": 1}, stress={"xx": 1}),
                    ("/path/0/stress/xx", "contradiction"))
        self.refuse(self.segment(strain={"yx": 1}), ("/path/0/strain/yx", "unknown_key"))
        self.refuse(self.segment(steps=0), ("/path/0/steps", "range"))
        self.refuse(self.segment(steps=1.5), ("/path/0/steps", "type"))
        self.refuse(self.segment(duration=0), ("/path/0/duration", "range"))
        self.refuse(changed(path=[{"strain": {"xx": 1}}]), ("/path/0/steps", "required"))
        gradient = [1, 0, 0, 0, 1, 0, 0, 0, 1]
        self.refuse(self.segment(deformation_gradient=gradient),
                    ("/path/0/deformation_gradient", "contradiction"))
        finite = self.segment(deformation_gradient=gradient, stress={"xx": 1})
        finite["strain"] = "finite"
        self.refuse(finite, ("/path/0/deformation_gradient", "contradiction"))
        finite = self.segment(deformation_gradient=[1, 0, 0, 0, -1, 0, 0, 0, 1])
        finite["strain"] = "finite"
        self.refuse(finite, ("/path/0/deformation_gradient", "range"))

    def test_material(self):
        self.refuse(changed(material={"model": "jelly"}), ("/material/model", "unknown_value"))
        self.refuse(self.material(poisson_ratio=0.5), ("/material/poisson_ratio", "range"))
        self.refuse(self.material(density=0), ("/material/density", "range"))
        self.refuse(self.material(friction_angle=3), ("/material/friction_angle", "unknown_key"))
        cap = {"model": "drucker_prager_cap", "density": 2000, "young_modulus": 1e6,
               "poisson_ratio": 0.3, "friction_angle": 20, "cone_strength": 10}
        self.refuse(changed(material=dict(cap, cohesion=1)),
                    ("/material/cone_strength", "alternative"))
        self.refuse(changed(material=dict(cap, dilation_angle=25)),
                    ("/material/dilation_angle", "limit"))
        nakai = {"model": "matsuoka_nakai", "density": 2000, "young_modulus": 1e6,
                 "poisson_ratio": 0.3, "friction": {"a0": 30, "a5": 1}}
        self.refuse(changed(material=dict(nakai, potential="mohr_coulomb")),
                    ("/material/potential", "unknown_value"))
        cone = {"model": "drucker_prager", "density": 2000, "young_modulus": 1e6,
                "poisson_ratio": 0.3, "friction_angle": 20}
        self.refuse(changed(material=dict(cone, cone_slope=0.2)),
                    ("/material/cone_slope", "alternative"))
        self.refuse(changed(material=dict(cone, dilation_angle=25)),
                    ("/material/dilation_angle", "limit"))
        self.refuse(changed(material=dict(cone, isotropic_hardening=-1)),
                    ("/material/isotropic_hardening", "range"))
        self.refuse(changed(material=dict(nakai, dilation_angle=3)),
                    ("/material/dilation_angle", "contradiction"))
        self.refuse(changed(material=dict(nakai, friction={"a1": 3})),
                    ("/material/friction/a0", "required"))
        fluid = {"model": "newtonian_fluid", "density": 1000, "bulk_modulus": 1e6}
        self.refuse(changed(material=dict(fluid, exponent=7)), ("/material/exponent", "contradiction"))

    def test_stress_that_cannot_be_carried(self):
        fluid = {"model": "newtonian_fluid", "density": 1000, "bulk_modulus": 1e6}
        document = changed(material=fluid, path=[{"strain": {"xx": -0.01}, "steps": 2},
                                                 {"stress": {"xy": 1e3}, "steps": 1}])
        self.refuse(document, ("/path/1", "no_convergence"), code=11)
        self.assertEqual(len(run(document)[1]), 3)  # what came before is printed

    def test_files(self):
        code, lines = run_text('{"material": ')
        self.assertEqual((code, lines[0]["errors"][0]["code"]), (10, "json"))
        output = subprocess.run([WORKER, "point", "/nowhere.json"], capture_output=True)
        self.assertEqual(output.returncode, 10)
        output = subprocess.run([WORKER, "point"], capture_output=True)
        self.assertEqual(output.returncode, 1)
        with open("/dev/full", "w") as full, tempfile.NamedTemporaryFile("w") as file:
            json.dump(UNIAXIAL, file)
            file.flush()
            output = subprocess.run([WORKER, "point", file.name], stdout=full)
            self.assertEqual(output.returncode, 1)


if __name__ == "__main__":
    WORKER = os.path.abspath(sys.argv.pop(1))
    unittest.main()
