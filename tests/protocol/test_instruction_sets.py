# SPDX-License-Identifier: Apache-2.0
"""Which program talus-worker starts, by processor and by TALUS_ISA. Processors are imitated by
qemu-x86_64; without it these tests are skipped."""
import os
import platform
import re
import shutil
import subprocess
import unittest

from talus_harness import REAL_WORKER

QEMU = shutil.which("qemu-x86_64")
X86_64 = platform.machine() == "x86_64"
LEVELS = ("x86-64-v2", "x86-64-v3", "x86-64-v4")
# The plain program starts itself again if this is not set; qemu would hand that to the real processor.
SETTLED = {"GOMP_SPINCOUNT": "0"}


def program(level):
    return REAL_WORKER if level == "x86-64-v2" else f"{REAL_WORKER}-{level}"


def version(*command, isa=None, **environment):
    """Exit code, instruction set and message of `talus-worker version`."""
    inherited = {name: value for name, value in os.environ.items() if name != "TALUS_ISA"}
    if isa is not None:
        inherited["TALUS_ISA"] = isa
    ended = subprocess.run([*command, "version"], capture_output=True, text=True, timeout=60,
                           env={**inherited, **environment})
    said = "\n".join(line for line in ended.stderr.splitlines() if line.startswith("talus-worker"))
    return ended.returncode, ended.stdout.split()[-1:], said


class Forced(unittest.TestCase):
    def test_unknown_names_are_errors(self):
        for name in ("x86-64", "avx2", "X86-64-V3", "x86-64-v3 ", ""):
            with self.subTest(name):
                code, isa, said = version(REAL_WORKER, isa=name)
                self.assertEqual((code, isa), (1, []))
                self.assertIn(f"TALUS_ISA={name} is unknown", said)

    @unittest.skipUnless(X86_64, "x86-64 only")
    def test_the_plain_program_is_always_there(self):
        self.assertEqual(version(REAL_WORKER, isa="x86-64-v2"), (0, ["x86-64-v2"], ""))

    def test_the_best_one_is_the_last_that_can_be_forced(self):
        code, best, said = version(REAL_WORKER)
        self.assertEqual((code, said), (0, ""))
        forced = [level for level in LEVELS if version(REAL_WORKER, isa=level)[0] == 0]
        for level in forced:
            self.assertEqual(version(REAL_WORKER, isa=level), (0, [level], ""))
        if X86_64:
            self.assertEqual(best, forced[-1:])

    @unittest.skipUnless(os.path.exists(program("x86-64-v3")), "built for one instruction set")
    def test_another_program_is_not_another_set(self):
        code, isa, said = version(program("x86-64-v3"), isa="x86-64-v2")
        self.assertEqual((code, isa), (1, []))
        self.assertIn("TALUS_ISA=x86-64-v2, but this program is built for x86-64-v3", said)

    @unittest.skipUnless(X86_64, "x86-64 only")
    def test_a_program_that_is_not_there(self):
        folder = os.path.join(os.environ.get("TMPDIR", "/tmp"), f"talus-isa-{os.getpid()}")
        os.mkdir(folder)
        self.addCleanup(shutil.rmtree, folder)
        alone = shutil.copy(REAL_WORKER, folder)
        self.assertEqual(version(alone), (0, ["x86-64-v2"], ""))
        code, isa, said = version(alone, isa="x86-64-v3")
        self.assertEqual((code, isa), (1, []))
        self.assertRegex(said, "TALUS_ISA=x86-64-v3: (there is no program|this processor lacks it)")


@unittest.skipUnless(QEMU and X86_64, "needs qemu-x86_64 (package qemu-user)")
@unittest.skipIf(os.environ.get("TALUS_PATIENCE", "1") != "1", "sanitizers do not run under qemu")
class Processors(unittest.TestCase):
    def run_on(self, processor, *command, **rest):
        return version(QEMU, "-cpu", processor, *command, **SETTLED, **rest)

    def test_too_old_a_processor_is_told(self):
        code, isa, said = self.run_on("Conroe", REAL_WORKER)
        self.assertEqual((code, isa), (1, []))
        self.assertIn("built for x86-64-v2, which this processor lacks", said)

    def test_what_the_processor_lacks_is_not_taken(self):
        self.assertEqual(self.run_on("Nehalem", REAL_WORKER), (0, ["x86-64-v2"], ""))

    def test_what_the_processor_lacks_cannot_be_forced(self):
        for processor, isa in (("Nehalem", "x86-64-v3"), ("Haswell", "x86-64-v4")):
            code, name, said = self.run_on(processor, REAL_WORKER, isa=isa)
            self.assertEqual((code, name), (1, []))
            self.assertRegex(said, re.escape(f"TALUS_ISA={isa}: this processor lacks it"))

    def test_each_program_knows_what_it_needs(self):
        self.assertEqual(self.run_on("Haswell", program("x86-64-v3")), (0, ["x86-64-v3"], ""))
        for processor, isa in (("Nehalem", "x86-64-v3"), ("Haswell", "x86-64-v4")):
            code, name, said = self.run_on(processor, program(isa))
            self.assertEqual((code, name), (1, []))
            self.assertIn(f"built for {isa}, which this processor lacks", said)


if __name__ == "__main__":
    unittest.main()
