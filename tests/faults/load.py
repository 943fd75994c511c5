# SPDX-License-Identifier: Apache-2.0
"""Clients that keep a daemon busy while it is being killed, and remember what they were promised."""
import hashlib
import json
import struct
import threading
import time

from client_threads import BROKEN, ClientThreads
from sse_reader import Stream
from talus_harness import fake_scene


class Load(ClientThreads):
    """acknowledged: {key: job id} of every 201. cancelled: jobs somebody asked to cancel;
    cancel_acknowledged: those with an answer of 2xx. deleted: DELETE was answered;
    maybe_deleted: it was sent, the answer never came."""

    def __init__(self, daemon, seed, with_crashes):
        super().__init__(daemon, seed,
                         [self.submit] * 3 + [self.cancel, self.remove, self.watch, self.download])
        self.with_crashes = with_crashes
        self.acknowledged, self.bodies = {}, {}
        self.cancelled, self.cancel_acknowledged = set(), set()
        self.deleted, self.maybe_deleted = set(), set()
        self.downloads = self.watched = 0
        self.rush = threading.Event()  # while it is set, nobody rests between requests

    def complain(self, text):
        if len(self.failures) < 100:
            self.failures.append(text)

    def submit(self, client, source, name):
        """One job, with the same key until it is acknowledged."""
        key = f"key-{name}"
        rows = source.choice((5, 20, 60))
        directive = {"seconds": source.choice((0.02, 0.1, 0.5)), "rows": rows,
                     "checkpoint": source.choice((0, 3)), "frame_bytes": source.choice((500, 50000))}
        if self.with_crashes and source.random() < 0.3:
            directive.update(crash={"row": source.randint(1, rows)}, torn=True)
        body = {"scene": fake_scene(directive), "labels": {"key": key, "rows": str(rows)},
                "retries": 50 if self.with_crashes else 2}
        self.bodies[key] = body
        while True:
            try:
                reply = client.post("/v1/jobs", body, idempotency_key=key)
            except BROKEN:
                client.close()
                if self.stopping.is_set():
                    return
                time.sleep(0.02)
                continue
            if reply.status == 201:
                self.acknowledged[key] = reply.json()["id"]
                break
            if reply.status not in (429, 503):
                self.complain(f"submission answered {reply}")
                return
            time.sleep(0.05)
        # About as fast as they are run: the queue stays short, so that jobs of all states are met.
        self.rush.wait(source.uniform(0.02, 0.25))

    def pick(self, source):
        ids = [job for job in list(self.acknowledged.values()) if job not in self.deleted]
        return source.choice(ids[-20:]) if ids else None

    def cancel(self, client, source, _):
        self.rush.wait(source.uniform(0.02, 0.25))
        job = self.pick(source)
        if job:
            self.cancelled.add(job)
            reply = client.post(f"/v1/jobs/{job}/cancel")
            if reply.status in (200, 202):
                self.cancel_acknowledged.add(job)
            elif reply.status not in (404, 409, 503):
                self.complain(f"cancel answered {reply}")

    def remove(self, client, source, _):
        self.rush.wait(source.uniform(0.05, 0.4))
        job = self.pick(source)
        if job:
            self.maybe_deleted.add(job)
            reply = client.delete(f"/v1/jobs/{job}")
            if reply.status in (200, 204):
                self.deleted.add(job)
            else:
                if reply.status == 409:
                    self.maybe_deleted.discard(job)
                elif reply.status not in (404, 503):
                    self.complain(f"delete answered {reply}")

    def watch(self, client, source, _):
        """Reads a stream across kills, by Last-Event-ID: ids grow, states are numbered."""
        job = self.pick(source)
        if not job:
            time.sleep(0.1)
            return
        last_id, numbers, begin = None, [], time.monotonic()
        while not self.stopping.is_set() and time.monotonic() - begin < 10:
            try:
                with Stream(self.daemon.port, f"/v1/jobs/{job}/events", last_id, timeout=5) as stream:
                    if stream.open().status != 200:
                        return
                    for event in stream:
                        if event.id:
                            if last_id and self.key(event.id) <= self.key(last_id):
                                self.complain(f"{job}: id {event.id} after {last_id}")
                            last_id = event.id
                        if event.name == "state":
                            numbers.append(event.data["number"])
                        if event.name == "done":
                            if numbers != list(range(numbers[0], numbers[0] + len(numbers))):
                                self.complain(f"{job}: states seen {numbers}")
                            self.watched += 1
                            return
            except BROKEN:
                time.sleep(0.05)

    @staticmethod
    def key(identity):
        return tuple(map(int, identity.split("-")))

    def download(self, client, source, _):
        """Whatever file is visible is whole."""
        job = self.pick(source)
        if not job:
            time.sleep(0.1)
            return
        reply = client.get(f"/v1/jobs/{job}/files")
        if reply.status != 200:
            time.sleep(0.05)
            return
        listing = reply.json()
        listing = listing["files"] if isinstance(listing, dict) else listing
        for file in listing:
            name = file["name"]
            if name.endswith((".part", ".tmp")):
                self.complain(f"{job}: {name} is listed")
            if not name.startswith("frames/frame_") and name not in ("receipt.json", "scene.json"):
                continue
            reply = client.get(f"/v1/jobs/{job}/files/{name}")
            if reply.status == 200:
                self.downloads += 1
                self.check_content(job, name, reply.body)
        time.sleep(0.05)

    def check_content(self, job, name, body):
        if name.endswith(".hdf"):
            size, = struct.unpack_from("<Q", body) if len(body) >= 40 else (0,)
            if size == 0 or len(body) != 40 + size or hashlib.sha256(body[40:]).digest() != body[8:40]:
                self.complain(f"{job}: half of {name}")
        elif name.endswith(".json"):
            try:
                json.loads(body)
            except ValueError:
                self.complain(f"{job}: half of {name}")
