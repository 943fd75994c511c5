# SPDX-License-Identifier: Apache-2.0
"""What the tests of `talus-worker run` share: scenes for the doubles, runs, and reading results."""
import copy
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SCENE = {
    "title": "particles=50",
    "duration": 1.0,
    "solver": {"time_step": 0.003},
    "probes": [{"name": "h", "mean_from": 0.5}],
    "output": {"frames": {"every": 0.1}, "history": {"every": 0.01}},
}


def worker():
    return os.environ["TALUS_WORKER"]


def scene(**changes):
    made = copy.deepcopy(SCENE)
    made.update(changes)
    return made


class RunTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="talus-run-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write_scene(self, content, name="given.json"):
        path = self.folder / name
        path.write_text(json.dumps(content))
        return path

    def start(self, content, job="job", *options, **popen):
        path = self.write_scene(content, job + ".given.json")
        command = [worker(), "run", str(path), "--out", str(self.folder / job), *options]
        popen.setdefault("stderr", subprocess.PIPE)
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, text=True, **popen)
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        if process.poll() is None:
            process.kill()
            process.wait()

    def run_job(self, content, job="job", *options, expect=0, **popen):
        process = self.start(content, job, *options, **popen)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, expect, errors)
        return errors

    def events(self, job="job", kind=None):
        text = (self.folder / job / "events.ndjson").read_text()
        self.assertTrue(text.endswith("\n"))
        lines = [json.loads(line) for line in text.splitlines()]
        return [line for line in lines if kind is None or line["event"] == kind]

    def wait_for(self, job, kind, count=1):
        """Waits until `count` events of a kind are in the file."""
        path = self.folder / job / "events.ndjson"
        deadline = time.monotonic() + 10
        while time.monotonic() < deadline:
            if path.exists() and path.read_text().count(f'"event":"{kind}"') >= count:
                return
            time.sleep(0.005)
        self.fail(f"no {count} {kind} events came")

    def digest(self, job, name):
        return hashlib.sha256((self.folder / job / name).read_bytes()).hexdigest()

    def frame_names(self, job="job"):
        return sorted(path.name for path in (self.folder / job / "frames").iterdir())

    def assert_same_results(self, job, other):
        """Histories and frames of two jobs are the same to the last bit."""
        self.assertEqual(self.frame_names(job), self.frame_names(other))
        names = ["history.bin", "history.csv", "frames.hdf.series"]
        names += ["frames/" + name for name in self.frame_names(job)]
        for name in names:
            self.assertEqual(self.digest(job, name), self.digest(other, name), name)


def main():
    unittest.main(argv=[sys.argv[0], "-v"])
