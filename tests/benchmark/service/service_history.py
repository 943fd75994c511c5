# SPDX-License-Identifier: Apache-2.0
"""Lists, and everything else, with a long history of jobs."""
import time
from urllib.parse import quote

from service_load import Figure, polls, shipped_scene
from service_seed import seed
from talus_harness import wait_for

GOAL_MS = 20
# What looks at every name: texts that are too short for the index and in no name.
SCANS = ("text of two letters, of none",)
PAGE = 50


def make_originals(daemon, client, count):
    """Jobs that ended in every way, with labels and names, run by the real worker."""
    scene = shipped_scene("column-at-rest", duration=0.002)
    made = []
    for number in range(count):
        body = {"scene": scene, "name": f"run {number} of the campaign",
                "labels": {"campaign": f"c{number % 10}", "number": str(number), "site": "north"}}
        if number % 10 == 8:
            body["limits"] = {"wall_seconds": 0.001}  # fails
            body["scene"] = dict(scene, duration=10)
        reply = client.post("/v1/jobs", body)
        assert reply.status == 201, reply
        made.append(reply.json()["id"])
        if number % 10 == 9:
            client.post(f"/v1/jobs/{made[-1]}/cancel")
    for job in made:
        client.finish(job, 120)
    return made


def start_again(daemon):
    """Seconds from the start of a daemon to its first answer."""
    begin = time.monotonic()
    daemon.start(wait=False)
    wait_for(daemon.answers, 120, "the daemon answers", every=0.002)
    return time.monotonic() - begin


def make_history(daemon, originals, count):
    """The daemon is started again with `count` more jobs, which it has to look at, then twice without
    news: after an orderly end and after a kill. Returns the ids and {name: seconds}."""
    daemon.terminate()
    ids = seed(daemon.state, originals, count)
    starts = {"where all are new": start_again(daemon)}
    daemon.terminate()
    starts["in order"] = start_again(daemon)
    daemon.kill()
    starts["after a kill"] = start_again(daemon)
    return ids, starts


def list_queries(client, count):
    """name -> queries of GET /v1/jobs; deep ones go on from cursors far down."""
    deep = []
    cursor, skipped = None, 0
    while skipped < count // 2:  # into the middle of history, in steps of 500
        page = client.get(f"/v1/jobs?limit=500&fields=id{'&cursor=' + quote(cursor) if cursor else ''}")
        cursor = page.json()["cursor"]
        skipped += 500
        if not cursor:
            break
        deep.append(f"limit={PAGE}&cursor={quote(cursor)}")
    queries = {"first page": [f"limit={PAGE}"],
               "deep pages": deep or [f"limit={PAGE}"],
               "state=succeeded": [f"limit={PAGE}&state=succeeded"],
               "state=failed": [f"limit={PAGE}&state=failed"],
               "state=running (none)": [f"limit={PAGE}&state=running"],
               "label": [f"limit={PAGE}&label={quote(f'campaign:c{n}')}" for n in range(10)],
               "label of few": [f"limit={PAGE}&label={quote(f'number:{n}')}" for n in range(10)],
               "label of none": [f"limit={PAGE}&label={quote('campaign:none')}"],
               "label and state": [f"limit={PAGE}&label={quote('campaign:c8')}&state=failed"],
               "label, deep": [f"{q}&label={quote('campaign:c3')}" for q in deep[-20:] or [f"limit={PAGE}"]],
               "study (none)": [f"limit={PAGE}&study=none"],
               "text": [f"limit={PAGE}&text={quote('campaign')}"],
               "text of few": [f"limit={PAGE}&text={quote(f'run {n} ')}" for n in range(10)],
               "text of none": [f"limit={PAGE}&text={quote('nowhere at all')}"],
               "text of none, its parts in all": [f"limit={PAGE}&text={quote('of the of')}"],
               "text of two letters": [f"limit={PAGE}&text=un"],
               "text of two letters, of none": [f"limit={PAGE}&text=zz"],
               "text and state": [f"limit={PAGE}&text=campaign&state=failed"],
               "text, deep": [f"{q}&text=campaign" for q in deep[-20:] or [f"limit={PAGE}"]],
               "ids of 100": ["limit=100&fields=id,state"]}
    # What this build does not know yet is left out, not counted as an error.
    return {name: [f"/v1/jobs?{query}" for query in list_of] for name, list_of in queries.items()
            if client.get(f"/v1/jobs?{list_of[0]}").status == 200}


def measure_lists(daemon, client, count, seconds):
    figures, medians = [], {}
    for name, paths in list_queries(client, count).items():
        load = polls(daemon, paths[:200], 1, 1, seconds)
        label = f"list of {count}, {name}"
        medians[name] = load["p50_ms"]
        figures += [Figure(f"{label}: p50", load["p50_ms"], "ms"),
                    Figure(f"{label}: p99", load["p99_ms"], "ms", GOAL_MS),
                    Figure(f"{label}: not answered", load["failures"], "", 0, check=True)]
    return figures, medians


def measure_single(daemon, client, ids, seconds):
    """Single jobs all over history, and how long a stream needs to begin."""
    paths = [f"/v1/jobs/{job}" for job in ids[::max(1, len(ids) // 1000)]]
    load = polls(daemon, paths, 1, 1, seconds)
    waits = []
    for job in ids[::max(1, len(ids) // 100)]:
        begin = time.monotonic()
        reply = client.get(f"/v1/jobs/{job}/events")
        waits.append(1e3 * (time.monotonic() - begin))
        assert b"event: done" in reply.body, reply
    waits.sort()
    name = f"with {len(ids)} jobs"
    return [Figure(f"{name}, single jobs: p50", load["p50_ms"], "ms"),
            Figure(f"{name}, single jobs: p99", load["p99_ms"], "ms", GOAL_MS),
            Figure(f"{name}, whole story of an ended job: p50", waits[len(waits) // 2], "ms"),
            Figure(f"{name}, whole story of an ended job: p99", waits[int(0.99 * len(waits))], "ms")]
