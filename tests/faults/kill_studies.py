# SPDX-License-Identifier: Apache-2.0
"""The daemon is killed with -9 at random points while studies run, are cancelled and deleted.

An answer of 2xx means that the study is on disk; every row becomes one job at most and runs to one
end; a study that nobody cancelled or deleted ends with all of its rows; one that is deleted is gone
with its jobs and their folders; one that is cancelled ends so, unless it had ended before.

TALUS_KILLS: how many kills (12; with TALUS_FULL=1 200). TALUS_SEED: repeats a run."""
import os
import random
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "protocol"))
from client_threads import BROKEN, ClientThreads  # noqa: E402
from sse_reader import read_all  # noqa: E402
from talus_harness import Daemon, FINAL, PATIENCE, fake_scene, wait_for  # noqa: E402

FULL = os.environ.get("TALUS_FULL") == "1"
KILLS = int(os.environ.get("TALUS_KILLS", "200" if FULL else os.environ.get("TALUS_KILLS_DEFAULT", "12")))
SEED = int(os.environ.get("TALUS_SEED", str(int(time.time()))))
ROWS = (1, 4, 9, 16)
PAGE = 500


class Promises(ClientThreads):
    """acknowledged: {key: (id, rows)} of every 201; the sets hold ids. `asked` was sent, whatever
    became of it; the other two were answered with 2xx."""

    rest = 0.3

    def __init__(self, daemon):
        super().__init__(daemon, SEED, (self.submit, self.submit, self.end_one, self.end_one))
        self.acknowledged, self.bodies = {}, {}
        self.cancel_asked, self.delete_asked = set(), set()
        self.cancelled, self.deleted = set(), set()

    def submit(self, client, source, key):
        rows = source.choice(ROWS)
        scene = fake_scene({"seconds": source.choice((0.01, 0.05, 0.3)), "rows": 3},
                           probes=[{"name": "runout", "kind": "front", "along": [1, 0]}])
        # Every row has to run: the jobs of deleted studies are gone, others' must not stand in.
        body = {"name": key, "scene": scene, "reuse": False, "metrics": ["probe.runout.max"],
                "design": {"grid": {"parameters": {"duration": list(range(1, rows + 1))},
                                    "set": {"/duration": "duration"}}}}
        self.bodies[key] = body
        while not self.stopping.is_set():
            try:
                reply = client.post("/v1/studies", body, idempotency_key=key)
            except BROKEN:  # whether it got there is what the key is for
                client.close()
                time.sleep(0.02)
                continue
            if reply.status == 201:
                self.acknowledged[key] = (reply.json()["id"], rows)
            elif reply.status not in (429, 503):
                self.failures.append(f"study {key}: {reply}")
            return

    def end_one(self, client, source, key):
        """Cancels or deletes a study; one that runs has to be cancelled before it can be deleted."""
        if not self.acknowledged:
            return
        study, _ = source.choice(list(self.acknowledged.values()))
        if source.random() < 0.5:
            self.cancel_asked.add(study)
            reply = client.post(f"/v1/studies/{study}/cancel")
            allowed, done = (200, 202, 404, 409), self.cancelled
        else:
            self.delete_asked.add(study)
            reply = client.delete(f"/v1/studies/{study}")
            allowed, done = (200, 204, 404, 409), self.deleted
        if reply.status // 100 == 2:
            done.add(study)
        elif reply.status not in allowed + (503,):
            self.failures.append(f"{key} of {study}: {reply}")


def everything(client, what, query=""):
    """All of a list, page by page."""
    found, cursor = [], ""
    while True:
        page = client.get(f"/v1/{what}?limit={PAGE}{query}{cursor}").json()
        found += page[what]
        if not page["cursor"]:
            return found
        cursor = "&cursor=" + page["cursor"]


def settle(daemon, check):
    """Waits until every study and every job has ended; returns both by id."""
    client = daemon.client()

    def ended():
        return all(study["state"] != "running" for study in everything(client, "studies")) and \
            all(job["state"] in FINAL for job in everything(client, "jobs"))

    try:
        wait_for(ended, 90, "every study has ended", 0.2)
    except AssertionError as error:
        check(False, str(error))
    return ({study["id"]: study for study in everything(client, "studies")},
            {job["id"]: job for job in everything(client, "jobs")})


def check_rows(client, study, count, jobs, check):
    """Every row once, with a job of its own or none; all of them ran unless somebody cancelled."""
    where = f"study {study['id']} ({study['state']})"
    rows = client.get(f"/v1/studies/{study['id']}/results").json()["rows"]
    check([row["row"] for row in rows] == list(range(count)), f"{where}: rows {rows}")
    check(study["counts"]["total"] == count, f"{where}: {study['counts']}")
    for state in ("succeeded", "failed", "cancelled"):
        told = sum(row["state"] == state for row in rows)
        check(told == study["counts"][state], f"{where}: {told} {state}, {study['counts']}")
    own = {row["job"]: row for row in rows if row["job"] is not None}
    check(len(own) == sum(row["job"] is not None for row in rows), f"{where}: a job of two rows")
    made = {job["id"]: job for job in jobs.values() if job["study"] == study["id"]}
    check(set(own) == set(made), f"{where}: jobs {set(own) ^ set(made)}")
    for job_id, row in own.items():
        if job_id in made:
            check(made[job_id]["study_row"] == row["row"], f"{where}: row of {job_id}")
            check(made[job_id]["state"] == row["state"], f"{where}: {row} {made[job_id]['state']}")
        if row["state"] == "succeeded":
            check(row["metrics"]["probe.runout.max"] == row["parameters"]["duration"],
                  f"{where}: metrics of {row}")
    return rows


def check_story(daemon, study, rows, check):
    """One end, ids that grow, and of every row a story that ends as the row did."""
    where = f"study {study['id']}"
    events = read_all(daemon.port, f"/v1/studies/{study['id']}/events", seconds=20)
    numbers = [int(event.id) for event in events if event.name != "done"]
    check(numbers == sorted(set(numbers)), f"{where}: ids do not grow")
    states = [event.data["state"] for event in events if event.name == "state"]
    check(states[0] == "running" and states[-1] == study["state"], f"{where}: {states}")
    check(sum(event.name == "done" for event in events) == 1, f"{where}: not one `done`")
    for row in rows:
        told = [event.data["state"] for event in events
                if event.name == "row" and event.data["row"] == row["row"]]
        check(told[-1:] == [row["state"]], f"{where}: row {row['row']} {row['state']}, told {told}")
        check(sum(state in FINAL for state in told) == 1, f"{where}: row {row['row']}: {told}")


def check_studies(daemon, promises, studies, jobs, check):
    client = daemon.client()
    for key, (study_id, count) in promises.acknowledged.items():
        if study_id in promises.deleted:
            check(study_id not in studies, f"deleted, but back: {study_id}")
            left = [job["id"] for job in jobs.values() if job["study"] == study_id]
            check(not left, f"jobs of the deleted {study_id}: {left}")
        if study_id not in studies:
            check(study_id in promises.delete_asked, f"lost: {study_id}")
            continue
        study = studies[study_id]
        rows = check_rows(client, study, count, jobs, check)
        check_story(daemon, study, rows, check)
        if study_id not in promises.cancel_asked:
            check(study["state"] == "finished", f"{study_id}: {study['state']}, cancelled by nobody")
            check(study["counts"]["succeeded"] == count, f"{study_id}: {study['counts']}")
        reply = client.post("/v1/studies", promises.bodies[key], idempotency_key=key)
        check(reply.status == 201 and reply.json()["id"] == study_id, f"key {key} again: {reply}")
    strangers = set(studies) - {study_id for study_id, _ in promises.acknowledged.values()}
    # Its answer was lost with the daemon and the client stopped before it could ask again.
    check(all(studies[one]["name"] in promises.bodies for one in strangers), f"strangers: {strangers}")
    names = [study["name"] for study in studies.values()]
    check(len(names) == len(set(names)), "a key made two studies")


def check_runs(daemon, studies, jobs, check):
    """Workers: no attempt twice, none beside another of its job; folders: those of the jobs."""
    check(daemon.violations() == "", "violations: " + daemon.violations()[:2000])
    starts = {}
    for run in daemon.runs():
        if run["what"] == "start":
            starts.setdefault(run["job"], []).append(run["attempt"])
    for job_id, attempts in starts.items():
        check(attempts == sorted(set(attempts)), f"attempts of {job_id}: {attempts}")
    for job in jobs.values():
        check(job["study"] in studies, f"{job['id']} is of {job['study']}, which is not there")
        if job["state"] == "succeeded":
            check(starts.get(job["id"]), f"succeeded without a run: {job['id']}")
    folders = {name for name in os.listdir(os.path.join(daemon.state, "jobs"))}
    check(folders == set(jobs), f"folders and jobs: {folders ^ set(jobs)}")


def main():
    print(f"kill loop of studies: {KILLS} kills, TALUS_SEED={SEED}", flush=True)
    source, failures, begin = random.Random(SEED), [], time.monotonic()
    daemon = Daemon(workers=4).start()
    promises = Promises(daemon)

    def check(condition, text):
        if not condition:
            failures.append(text)
        return condition

    studies, jobs = {}, {}
    promises.start()
    try:
        for _ in range(KILLS):
            time.sleep(source.uniform(0.02, 0.8 * PATIENCE ** 0.5))
            daemon.kill()
            if source.random() < 0.3:
                time.sleep(source.uniform(0, 0.3))
            daemon.start()
        promises.stop()
        studies, jobs = settle(daemon, check)
        check_studies(daemon, promises, studies, jobs, check)
        check_runs(daemon, studies, jobs, check)
    finally:
        promises.stop()
        complaints = daemon.close()
    failures += promises.failures
    check(not complaints, complaints)
    states = [study["state"] for study in studies.values()]
    print(f"{len(promises.acknowledged)} studies acknowledged, {len(promises.deleted)} deleted, "
          f"{len(promises.cancelled)} cancels answered, "
          f"states { {state: states.count(state) for state in set(states)} }, {len(jobs)} jobs, "
          f"{time.monotonic() - begin:.0f} s in all")
    check(len(promises.acknowledged) >= KILLS // 3, "the load was too thin to prove anything")
    for text in failures[:40]:
        print("FAILED:", text)
    print(f"{len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
