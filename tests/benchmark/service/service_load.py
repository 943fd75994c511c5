# SPDX-License-Identifier: Apache-2.0
"""What the measurements share: the load program, processor time of processes, figures."""
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
sys.path.insert(0, os.path.join(ROOT, "tests", "protocol"))
from talus_harness import BUILD  # noqa: E402

LOADGEN = os.environ.get("TALUS_LOADGEN", os.path.join(BUILD, "bin", "talus-loadgen"))
# Beside it a measurement has nothing to wait for; the load ends by itself long before.
LOAD_TIMEOUT = 900


class Figure:
    """One measured value. `goal` is what it must stay under (or, with at_least, reach); None: it is
    only told. A `check` holds on any machine, however busy; the other goals are for a quiet one."""

    def __init__(self, name, value, unit, goal=None, at_least=False, check=False):
        self.name, self.value, self.unit = name, value, unit
        self.goal, self.at_least, self.check = goal, at_least, check

    @property
    def verdict(self):
        if self.goal is None:
            return ""
        holds = self.value >= self.goal if self.at_least else self.value <= self.goal
        return "pass" if holds else "FAIL"

    def row(self):
        return {"figure": self.name, "value": float(f"{self.value:.6g}"), "unit": self.unit,
                "goal": "" if self.goal is None else f"{'>=' if self.at_least else '<='} {self.goal:g}",
                "verdict": self.verdict, "kind": "check" if self.check else "speed"}


def polls(daemon, paths, connections=1, active=0, seconds=5.0, rate=0.0):
    """Runs `talus-loadgen polls`; its answer, with the daemon's processor time a request [us]."""
    before = processor_seconds(daemon.process.pid)
    answer = json.loads(subprocess.run(
        [LOADGEN, "polls", "--port", str(daemon.port), "--connections", str(connections), "--active",
         str(active or connections), "--seconds", str(seconds), "--rate", str(rate), *paths],
        stdout=subprocess.PIPE, timeout=LOAD_TIMEOUT, check=True).stdout)
    spent = processor_seconds(daemon.process.pid) - before
    answer["processor_us"] = 1e6 * spent / max(answer["requests"] + connections, 1)
    return answer


def watch(daemon, job, watchers, seconds):
    """Starts `talus-loadgen watch` and returns its process once all its streams have begun."""
    process = subprocess.Popen(
        [LOADGEN, "watch", "--port", str(daemon.port), "--watchers", str(watchers), "--seconds",
         str(seconds), "--lines", os.path.join(daemon.job_folder(job), "events.ndjson"),
         f"/v1/jobs/{job}/events"], stdout=subprocess.PIPE, text=True)
    line = process.stdout.readline()
    if line != "ready\n":
        process.kill()
        raise AssertionError(f"the watchers did not get their streams: {process.wait()}")
    return process


def processor_seconds(process):
    """What a process has used so far [s], of all its threads, in nanoseconds where Linux tells."""
    total = 0
    for task in os.listdir(f"/proc/{process}/task"):
        try:
            with open(f"/proc/{process}/task/{task}/schedstat", encoding="ascii") as file:
                total += int(file.read().split()[0]) * 1e-9
        except (FileNotFoundError, ProcessLookupError):
            continue
    return total


def children(process):
    """{pid: command line} of the processes that a process has started and that live."""
    found = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8") as file:
                parent = int(file.read().rsplit(")", 1)[1].split()[1])
            with open(f"/proc/{name}/cmdline", encoding="utf-8") as file:
                words = file.read().split("\0")
        except OSError:
            continue
        if parent == process:
            found[int(name)] = words
    return found


def shipped_scene(name, **changes):
    """One of clients/scenes; a shorter one has no means over its end."""
    with open(os.path.join(ROOT, "clients", "scenes", name + ".json"), encoding="utf-8") as file:
        scene = dict(json.load(file), **changes)
    if "duration" in changes:
        for probe in scene.get("probes", []):
            probe.pop("mean_from", None)
        scene.pop("references", None)
    return scene
