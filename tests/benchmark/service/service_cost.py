# SPDX-License-Identifier: Apache-2.0
"""What the daemon and its helpers cost beside the job they run, with one watcher."""
import json

from service_load import LOAD_TIMEOUT, Figure, children, processor_seconds, watch
from talus_harness import FINAL, wait_for

GOAL_PERCENT = 1


def helper_seconds(daemon):
    return sum(processor_seconds(pid) for pid, words in children(daemon.process.pid).items()
               if "helper" in words)


def measure(daemon, client, body):
    """One job from its submission to its end, forecast included."""
    before = processor_seconds(daemon.process.pid) + helper_seconds(daemon)
    reply = client.post("/v1/jobs", body)
    assert reply.status == 201, reply
    job = reply.json()["id"]
    readers = watch(daemon, job, 1, LOAD_TIMEOUT / 2)
    told = json.loads(readers.communicate(timeout=LOAD_TIMEOUT)[0])
    view = wait_for(lambda: (lambda j: j if j["state"] in FINAL else None)(client.job(job)), 60,
                    "the end of the job")
    assert view["state"] == "succeeded", view
    spent = processor_seconds(daemon.process.pid) + helper_seconds(daemon) - before
    used = view["metrics"]["cpu_seconds"]
    frames = len(client.get(f"/v1/jobs/{job}/frames").json())
    return [Figure("cost, processor time of the worker", used, "s"),
            Figure("cost, frames of the job", frames, ""),
            Figure("cost, events to the watcher", told["most"], ""),
            Figure("cost, processor time of talusd and helpers", spent, "s"),
            Figure("cost, share of the job's processor time", 100 * spent / used, "%", GOAL_PERCENT,
                   check=True)]
