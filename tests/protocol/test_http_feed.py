# SPDX-License-Identifier: Apache-2.0
"""/v1/events: the transitions of all jobs, in order, for late-comers, for those who come again and
for many at once; progress for those who listen."""
import resource
import time
import unittest

from sse_reader import Stream, read_all
from talus_harness import Daemon, DaemonTest, PATIENCE, wait_for


def until(stream, condition, seconds=30):
    """Events up to and with the first that meets a condition."""
    found, end = [], time.monotonic() + seconds * PATIENCE
    for event in stream:
        found.append(event)
        if condition(event):
            return found
        if time.monotonic() > end:
            break
    raise AssertionError(f"did not come: {found[-5:]}")


def is_done(job):
    return lambda event: event.name == "done" and event.data["job"] == job


def states(events, job):
    return [event.data["state"] for event in events
            if event.name == "state" and event.data["job"] == job]


def events_of(stream):
    """One iterator for the whole stream: a second one would lose what the first has read."""
    return iter(stream.open())


class Feed(DaemonTest):
    def stream(self, query="", **options):
        stream = Stream(self.daemon.port, "/v1/events" + query, **options).open()
        self.addCleanup(stream.close)
        self.assertEqual(stream.status, 200)
        self.assertEqual(stream.headers["content-type"], "text/event-stream")
        return events_of(stream)

    def test_the_life_of_jobs(self):
        stream = self.stream()
        good = self.client.submit()["id"]
        bad = self.client.submit({"fail": {"reason": "unstable", "exit": 11}})["id"]
        events = until(stream, is_done(good))
        if not any(is_done(bad)(event) for event in events):
            events += until(stream, is_done(bad))
        self.assertEqual(states(events, good), ["queued", "running", "succeeded"])
        self.assertEqual(states(events, bad), ["queued", "running", "failed"])
        last = [event for event in events if is_done(bad)(event)][0]
        self.assertEqual((last.data["reason"], last.data["state"]), ("unstable", "failed"))
        self.assertTrue(last.data["detail"] and last.data["at"] and last.data["attempt"] == 1)
        rows = [int(event.id) for event in events if event.id is not None]
        self.assertEqual(rows, sorted(rows))
        self.assertTrue(all(event.id is None for event in events if event.name == "progress"))
        again = self.story(until=rows[-1])
        self.assertEqual([e for e in events if e.id is not None], again)

    def story(self, until, query=""):
        found = []
        for event in self.stream(query):
            if event.id is not None:
                found.append(event)
            if found and int(found[-1].id) >= until and event.name == "done":
                return found
        return found

    def test_going_on(self):
        jobs = [self.client.submit()["id"] for _ in range(5)]
        for job in jobs:
            self.client.finish(job)
        last = until(self.stream(), is_done(jobs[-1]))
        rows = sorted({int(event.id) for event in last if event.id is not None})
        whole = self.story(rows[-1])
        for place in (1, len(rows) // 2, len(rows) - 2):
            after = rows[place]
            rest = [event for event in whole if int(event.id) > after]
            self.assertEqual(self.story(rows[-1], f"?after={after}"), rest)
            stream = self.stream(last_id=str(after))
            self.assertEqual([next(stream)], rest[:1])

    def test_from_now_on(self):
        job = self.client.submit()["id"]
        self.client.finish(job)
        stream = self.stream("?after=latest")
        new = self.client.submit()["id"]
        events = until(stream, is_done(new))
        self.assertEqual({event.data["job"] for event in events}, {new})

    def test_progress_of_what_runs(self):
        stream = self.stream("?after=latest")
        job = self.client.submit({"seconds": 1.0, "rows": 40})["id"]
        events = until(stream, is_done(job))
        steps = [event.data["step"] for event in events if event.name == "progress"]
        self.assertGreater(len(steps), 2)
        self.assertEqual(steps, sorted(steps))
        self.assertEqual({event.data["job"] for event in events}, {job})
        late = until(self.stream(), is_done(job))
        self.assertNotIn("progress", [event.name for event in late])

    def test_queued_again_and_cancelled(self):
        stream = self.stream("?after=latest")
        job = self.client.submit({"crash": {"row": 6}})["id"]
        self.client.finish(job)
        other = self.client.submit({"seconds": 60})["id"]
        wait_for(lambda: self.client.job(other)["state"] == "running", 20, "running")
        self.client.post(f"/v1/jobs/{other}/cancel")
        events = until(stream, is_done(other))
        self.assertEqual(states(events, job),
                         ["queued", "running", "queued", "running", "succeeded"])
        self.assertEqual(states(events, other)[-1], "cancelled")

    def test_deleted_jobs_leave_no_hole_to_fall_into(self):
        jobs = [self.client.submit()["id"] for _ in range(3)]
        for job in jobs:
            self.client.finish(job)
        last = [e for e in until(self.stream(), is_done(jobs[-1])) if e.id is not None][-1].id
        for job in jobs:
            self.client.delete(f"/v1/jobs/{job}")
        self.daemon.restart()
        self.client.close()
        stream = self.stream(last_id=last)
        new = self.client.submit()["id"]
        events = until(stream, is_done(new))
        self.assertEqual({event.data["job"] for event in events}, {new})

    def test_bad_ids(self):
        for query in ("?after=x", "?after=-1", "?after=1.5", "?after=99999999", "?after=3-0", "?x=1"):
            with self.subTest(query=query):
                self.assert_problem(self.client.get("/v1/events" + query), 422)


class Watchers(unittest.TestCase):
    def setUp(self):
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, (soft, hard))
        self.daemon = Daemon(workers=2).start()
        self.client = self.daemon.client()

    def tearDown(self):
        self.assertEqual(self.daemon.close(), "")

    def test_many(self):
        """1000 readers all get the same, and the daemon does not grow by a buffer for each."""
        job = self.client.submit()["id"]
        self.client.finish(job)
        before = self.daemon.memory()
        streams = [Stream(self.daemon.port, "/v1/events?after=latest", timeout=60).open()
                   for _ in range(1000)]
        self.assertEqual({stream.status for stream in streams}, {200})
        new = self.client.submit()["id"]
        told = set()
        for stream in streams:
            events = until(events_of(stream), is_done(new), 60)
            told.add(tuple(event for event in events if event.id is not None))
            stream.close()
        self.assertEqual(len(told), 1)
        # 64 KiB of the HTTP library a connection, and something for what we keep.
        self.assertLess(self.daemon.memory() - before, 1000 * 100_000)

    def test_across_a_kill(self):
        jobs = [self.client.submit({"seconds": 0.4})["id"] for _ in range(6)]
        stream = Stream(self.daemon.port, "/v1/events").open()
        first = until(events_of(stream), lambda event: event.name == "done")
        self.daemon.kill()
        stream.close()
        self.daemon.start()
        self.client.close()
        for job in jobs:
            self.client.finish(job)
        last_id = [event.id for event in first if event.id is not None][-1]
        with Stream(self.daemon.port, "/v1/events", last_id) as stream:
            rest, events = [], events_of(stream)
            while {e.data["job"] for e in first + rest if e.name == "done"} != set(jobs):
                rest += until(events, lambda event: event.name == "done")
        for job in jobs:
            # A kill between the start of an attempt and its worker loses the attempt, and says so.
            own = [event.data["state"] for event in read_all(self.daemon.port, f"/v1/jobs/{job}/events")
                   if event.name == "state"]
            self.assertEqual(states(first + rest, job), own)
            self.assertEqual(own[:2] + own[-1:], ["queued", "running", "succeeded"])


if __name__ == "__main__":
    unittest.main()
