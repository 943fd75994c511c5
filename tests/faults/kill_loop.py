# SPDX-License-Identifier: Apache-2.0
"""The daemon is killed with -9 at random points under load, over and over, and keeps its promise:

an answer of 2xx means that the job is on disk; it runs to exactly one final state; its attempts
never overlap; no result file is ever seen half-written.

TALUS_KILLS: how many kills (100). TALUS_SEED: repeats a run. TALUS_KILL_WORKERS=1: workers are
killed too, alone or together with the daemon.
"""
import json
import os
import random
import signal
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "protocol"))
from load import Load  # noqa: E402
from sse_reader import read_all, series  # noqa: E402
from talus_harness import Daemon, FINAL, PATIENCE, wait_for  # noqa: E402

KILLS = int(os.environ.get("TALUS_KILLS", os.environ.get("TALUS_KILLS_DEFAULT", "100")))
SEED = int(os.environ.get("TALUS_SEED", str(int(time.time()))))
KILL_WORKERS = os.environ.get("TALUS_KILL_WORKERS") == "1"


class Failures:
    def __init__(self):
        self.texts = []

    def __call__(self, condition, text):
        if not condition:
            self.texts.append(text)
        return condition


def kill_some(daemon, load, random_source):
    """The daemon, or (if asked for) workers, or both; half of the time just after every client
    has sent a request, so that it dies over them."""
    if random_source.random() < 0.5:
        load.rush.set()
        time.sleep(random_source.uniform(0, 0.04))
    victims = []
    if KILL_WORKERS and random_source.random() < 0.7:
        live = daemon.live_workers()
        victims = random_source.sample(live, min(len(live), random_source.randint(1, 2)))
    for pid in victims:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
    load.rush.clear()
    if not victims or random_source.random() < 0.5:
        daemon.kill()
        if random_source.random() < 0.3:
            time.sleep(random_source.uniform(0, 0.4))
        begin = time.monotonic()
        daemon.start()
        return time.monotonic() - begin
    return None


def settle(daemon, load, check):
    """Waits until every job is final; returns {id: job}."""
    client = daemon.client()
    jobs = {}

    def all_final():
        jobs.clear()
        cursor = ""
        while True:
            page = client.get(f"/v1/jobs?limit=500{cursor}").json()
            jobs.update((job["id"], job) for job in page["jobs"])
            if not page.get("cursor"):
                break
            cursor = "&cursor=" + page["cursor"]
        return all(job["state"] in FINAL for job in jobs.values())

    try:
        wait_for(all_final, 90, "every job is final", 0.2)
    except AssertionError:
        for job in jobs.values():
            check(job["state"] in FINAL, f"never final: {json.dumps(job)[:400]}")
    return jobs


def check_jobs(daemon, load, jobs, check):
    """Nothing acknowledged is lost, nothing deleted is back, nothing was made twice."""
    for job_id in load.acknowledged.values():
        if job_id in load.deleted:
            check(job_id not in jobs, f"deleted, but back: {job_id}")
        elif job_id not in load.maybe_deleted:
            check(job_id in jobs, f"lost: {job_id}")
    known = {}
    for job in jobs.values():
        key = job["labels"]["key"]
        check(key not in known, f"two jobs for key {key}: {known.get(key)} {job['id']}")
        known[key] = job["id"]
        check(load.acknowledged.get(key, job["id"]) == job["id"], f"key {key} changed its job")
        if job["state"] == "failed":
            check(KILL_WORKERS and job["reason"] in ("crashed",), f"failed: {json.dumps(job)[:600]}")
        if job["state"] == "cancelled":
            check(job["id"] in load.cancelled, f"cancelled by nobody: {job['id']}")
        if job["id"] in load.cancel_acknowledged and job["state"] != "cancelled":
            check(job["state"] in ("succeeded", "failed"), f"cancel ignored: {job['id']}")


def check_runs(daemon, jobs, check):
    """No attempt ran twice, attempts do not overlap, and ids of attempts grow."""
    check(daemon.violations() == "", "violations: " + daemon.violations()[:2000])
    by_job = {}
    for run in daemon.runs():
        by_job.setdefault(run["job"], []).append(run)
    for job_id, runs in by_job.items():
        starts = [run["attempt"] for run in runs if run["what"] == "start"]
        check(starts == sorted(set(starts)), f"attempts of {job_id}: {starts}")
        open_pid = None
        for run in runs:
            if run["what"] == "start":
                open_pid = run["pid"]
            else:
                check(run["pid"] == open_pid, f"runs of {job_id} overlap: {runs}")
                open_pid = None
    for job_id, job in jobs.items():
        if job["state"] == "succeeded":
            runs = by_job.get(job_id, [])
            check(runs, f"succeeded without a run: {job_id}")
            # A worker killed behind its last event no longer reports its end.
            ends = [run for run in runs if run["what"] == "end"]
            if not KILL_WORKERS:
                check(len(ends) == 1, f"ran {len(ends)} times to an end: {job_id}")


def check_story(daemon, job, check):
    """The events of a job tell one story: numbered states, one end, every row once."""
    where = f"{job['id']} ({job['state']})"
    try:
        events = read_all(daemon.port, f"/v1/jobs/{job['id']}/events", seconds=10)
    except (OSError, AssertionError, EOFError) as error:
        check(False, f"{where}: its story has no end: {error!r}")
        return
    states = [event.data for event in events if event.name == "state"]
    numbers = [state["number"] for state in states]
    check(numbers == list(range(numbers[0], numbers[0] + len(numbers))), f"{where}: states {states}")
    names = [state["state"] for state in states]
    check(names[0] == "queued", f"{where}: begins with {names[0]}")
    check(names[-1] == job["state"], f"{where}: story ends with {names}")
    check(sum(name in FINAL for name in names) == 1, f"{where}: {names}")
    done = [event for event in events if event.name == "done"]
    check(len(done) == 1 and events[-1].name == "done", f"{where}: done {done}")
    keys = [tuple(map(int, event.id.split("-"))) for event in events if event.id]
    check(keys == sorted(set(keys)), f"{where}: ids do not grow")
    rows = int(job["labels"]["rows"])
    if job["state"] == "succeeded":
        for name, (time_list, _) in series(events).items():
            check(time_list == [k / rows for k in range(rows + 1)], f"{where}: rows of {name}")


def check_file(daemon, job, check):
    """events.ndjson on disk: whole lines of JSON."""
    path = os.path.join(daemon.job_folder(job["id"]), "events.ndjson")
    with open(path, "rb") as file:
        text = file.read()
    check(text.endswith(b"\n"), f"{job['id']}: torn events.ndjson")
    for line in text.splitlines():
        try:
            json.loads(line)
        except ValueError:
            check(False, f"{job['id']}: bad line {line[:100]!r}")


def check_keys(daemon, load, jobs, check):
    """Every key still answers with its job."""
    client = daemon.client()
    for key, job_id in load.acknowledged.items():
        if job_id not in jobs:
            continue
        reply = client.post("/v1/jobs", load.bodies[key], idempotency_key=key)
        if check(reply.status == 201, f"replay of {key}: {reply}"):
            check(reply.json()["id"] == job_id, f"key {key}: {job_id} became {reply.json()['id']}")
            check(reply.headers.get("idempotent-replayed") == "true", f"key {key} made a job again")


def check_folders(daemon, jobs, check):
    """No folder without its job, no job without its folder."""
    folders = set()
    for path, names, _ in os.walk(daemon.state):
        if any(job_id in names for job_id in jobs):
            folders = set(names)
            break
    check(set(jobs) <= folders, f"jobs without folder: {set(jobs) - folders}")
    strays = {name for name in folders - set(jobs) if len(name) == len(next(iter(jobs), ""))}
    check(not strays, f"folders without job: {strays}")


def main():
    print(f"kill loop: {KILLS} kills, TALUS_SEED={SEED}, workers too: {KILL_WORKERS}", flush=True)
    random_source = random.Random(SEED)
    daemon, check = Daemon(workers=4).start(), Failures()
    load = Load(daemon, SEED, KILL_WORKERS)
    begin = time.monotonic()
    load.start()
    restarts = []
    try:
        for _ in range(KILLS):
            time.sleep(random_source.uniform(0.02, 0.8 * PATIENCE ** 0.5))
            restarts.append(kill_some(daemon, load, random_source))
        load.stop()
        jobs = settle(daemon, load, check)
        check_jobs(daemon, load, jobs, check)
        check_runs(daemon, jobs, check)
        for job in jobs.values():
            if job["state"] in FINAL and len(check.texts) < 40:
                check_story(daemon, job, check)
            check_file(daemon, job, check)
        check_keys(daemon, load, jobs, check)
        check_folders(daemon, jobs, check)
    finally:
        load.stop()
        check.texts += load.failures
        complaints = daemon.close()
    check(not complaints, complaints)
    states = {}
    for job in jobs.values():
        states[job["state"]] = states.get(job["state"], 0) + 1
    took = [seconds for seconds in restarts if seconds is not None]
    print(f"{len(load.acknowledged)} jobs acknowledged, {len(load.deleted)} deleted, states {states}, "
          f"{load.downloads} files and {load.watched} streams read, "
          f"{len(took)} restarts of {max(took, default=0):.2f} s at most, "
          f"{time.monotonic() - begin:.0f} s in all")
    check(len(load.acknowledged) >= KILLS // 2, "the load was too thin to prove anything")
    for text in check.texts[:40]:
        print("FAILED:", text)
    print(f"{len(check.texts)} failures")
    sys.exit(1 if check.texts else 0)


if __name__ == "__main__":
    main()
