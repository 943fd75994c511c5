# SPDX-License-Identifier: Apache-2.0
"""Events to many watchers of one running job: how late, and whether any is lost."""
import json
import os

from service_load import LOAD_TIMEOUT, Figure, processor_seconds, watch
from talus_harness import wait_for

# Lines of events.ndjson that a watcher who was there from the start is told one by one.
TOLD = ("state", "progress", "frame", "warning", "log", "rewind")
CHUNK_ROWS = 512  # rows of history that one event holds at most


def expected_count(folder):
    """How many events the story of a job has, out of its files."""
    with open(os.path.join(folder, "history.json"), encoding="utf-8") as file:
        columns = len(json.load(file)["columns"]) - 1
    count, rows = 1, 0  # `done`
    with open(os.path.join(folder, "events.ndjson"), encoding="utf-8") as file:
        for line in map(json.loads, file):
            count += line["event"] in TOLD
            if line["event"] == "history" and line["rows"] > rows:
                count += columns * -(-(line["rows"] - rows) // CHUNK_ROWS)
                rows = line["rows"]
    return count


def measure(daemon, client, body, watchers):
    """`watchers` readers are there before the job of `body` begins (the daemon runs one at a time)."""
    blocker = client.post("/v1/jobs", dict(body, priority=100)).json()["id"]
    wait_for(lambda: client.job(blocker)["state"] == "running", 60, "the first job runs")
    job = client.post("/v1/jobs", body).json()["id"]
    before = processor_seconds(daemon.process.pid)
    readers = watch(daemon, job, watchers, LOAD_TIMEOUT / 2)
    client.post(f"/v1/jobs/{blocker}/cancel")
    told = json.loads(readers.communicate(timeout=LOAD_TIMEOUT)[0])
    spent = processor_seconds(daemon.process.pid) - before
    wanted = expected_count(daemon.job_folder(job))
    lost = abs(wanted - told["fewest"]) + abs(told["most"] - wanted)
    name = f"events to {watchers} watchers"
    return [
        Figure(f"{name}: streams not whole", watchers - told["complete"], "", 0, check=True),
        Figure(f"{name}: events lost or told twice", lost, "", 0, check=True),
        Figure(f"{name}: stories that differ", told["different"], "", 0, check=True),
        Figure(f"{name}: events of a story", wanted, ""),
        Figure(f"{name}: delivered", told["per_second"], "1/s"),
        Figure(f"{name}: lag, p50", told["p50_ms"], "ms"),
        Figure(f"{name}: lag, p99", told["p99_ms"], "ms"),
        Figure(f"{name}: lag, longest", told["max_ms"], "ms"),
        Figure(f"{name}: processor time of talusd an event", 1e6 * spent / (wanted * watchers), "us"),
    ]
