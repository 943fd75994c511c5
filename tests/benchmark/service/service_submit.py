# SPDX-License-Identifier: Apache-2.0
"""From POST to the worker's first step, and where the time goes."""
import datetime
import json
import os
import time

from service_load import Figure
from talus_harness import wait_for

# name of a part -> (from, to)
PARTS = {"POST to 201": ("sent", "answered"),
         "POST to running": ("sent", "running"),
         "running to the worker's start (scene read, seeded)": ("running", "started"),
         "worker's start to its first step": ("started", "stepped"),
         "POST to first step": ("sent", "stepped")}


def moment(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp()


def events_of(folder):
    with open(os.path.join(folder, "events.ndjson"), encoding="utf-8") as file:
        return [json.loads(line) for line in file if line.endswith("\n")]


def moments_of(folder):
    """When a job's parts happened; None until it has made a step."""
    found = {}
    for line in events_of(folder):
        if line["event"] == "state" and line["state"] == "running":
            found["running"] = moment(line["at"])
        elif line["event"] == "started":
            found["started"] = moment(line["at"])
        elif line["event"] == "progress" and line["step"] > 0:
            found.setdefault("stepped", moment(line["at"]))
    return found if len(found) == 3 else None


def one_job(daemon, client, body):
    sent = time.time()
    reply = client.post("/v1/jobs", body)
    answered = time.time()
    assert reply.status == 201, reply
    job = reply.json()["id"]
    folder = daemon.job_folder(job)
    found = wait_for(lambda: moments_of(folder), 60, "the first step")
    client.post(f"/v1/jobs/{job}/cancel")
    client.finish(job)
    return dict(found, sent=sent, answered=answered)


def percentile(values, share):
    return sorted(values)[round(share * (len(values) - 1))]


def measure(daemon, client, body, count, name="submit"):
    one_job(daemon, client, body)  # starts the helper
    jobs = [one_job(daemon, client, body) for _ in range(count)]
    figures = []
    for part, (begin, end) in PARTS.items():
        times = [1e3 * (job[end] - job[begin]) for job in jobs]
        figures += [Figure(f"{name}, {part}: p50", percentile(times, 0.5), "ms"),
                    Figure(f"{name}, {part}: p99", percentile(times, 0.99), "ms")]
    return figures
