# SPDX-License-Identifier: Apache-2.0
"""Server-Sent Events: the whole story once, from wherever a reader comes."""
import threading
import time
import unittest

from sse_reader import Stream, read_all, series
from talus_harness import DaemonTest, PATIENCE, wait_for


class Events(DaemonTest):
    def events(self, job, last_id=None, **more):
        return read_all(self.daemon.port, f"/v1/jobs/{job}/events", last_id, **more)

    def check_rows(self, events, rows):
        """Every row of every series exactly once, in order."""
        found = series(events)
        self.assertEqual(set(found), {"energy.kinetic", "reaction.wall.force.x", "probe.runout"})
        times = [k / rows for k in range(rows + 1)]
        for name, (time_list, value_list) in found.items():
            self.assertEqual(time_list, times, name)
            self.assertEqual(len(value_list), rows + 1)
        self.assertEqual(found["probe.runout"][1], [2.0 * k for k in range(rows + 1)])

    def check_ids(self, events):
        """Ids are BYTES-NUMBER and grow."""
        keys = []
        for event in events:
            if event.id is not None:
                offset, _, number = event.id.partition("-")
                keys.append((int(offset), int(number)))
        self.assertEqual(keys, sorted(set(keys)), "ids must grow")

    def states(self, events):
        return [event.data["state"] for event in events if event.name == "state"]

    def test_live_from_the_start(self):
        job = self.client.submit({"seconds": 1.0, "rows": 50, "warnings": 2})["id"]
        with Stream(self.daemon.port, f"/v1/jobs/{job}/events") as stream:
            stream.open()
            self.assertEqual(stream.status, 200)
            self.assertEqual(stream.headers["content-type"].split(";")[0], "text/event-stream")
            self.assertRegex(stream.headers["cache-control"], "no-cache|no-store")
            begin, arrival, events = time.monotonic(), [], []
            for event in stream:
                events.append(event)
                arrival.append(time.monotonic() - begin)
            self.assertTrue(stream.ended)
        self.assertGreater(arrival[-1] - arrival[0], 0.4, "events must come while the job runs")
        self.check_rows(events, 50)
        self.check_ids(events)
        self.assertEqual(self.states(events), ["queued", "running", "succeeded"])
        self.assertEqual(events[-1].name, "done")
        self.assertEqual([e.name for e in events].count("done"), 1)
        self.assertEqual([e.name for e in events].count("warning"), 2)
        self.assertEqual([e.data["n"] for e in events if e.name == "frame"], [0, 1, 2])
        self.assertTrue(any(e.name == "progress" for e in events))
        names = {"state", "progress", "reaction", "probe", "energy", "frame", "warning", "log",
                 "rewind", "gap", "done"}
        self.assertLessEqual({e.name for e in events}, names)

    def test_latecomer_gets_the_story(self):
        job = self.client.submit({"rows": 30})["id"]
        self.client.finish(job)
        events = self.events(job)
        self.check_rows(events, 30)
        self.check_ids(events)
        self.assertEqual(self.states(events), ["queued", "running", "succeeded"])
        self.assertLessEqual([e.name for e in events].count("progress"), 1)
        self.assertEqual(events, self.events(job), "a second reading gives the same")

    def test_resume_at_every_id(self):
        job = self.client.submit({"rows": 12, "warnings": 1, "flush": 3})["id"]
        self.client.finish(job)
        whole = self.events(job)
        strip = [e for e in whole if e.name != "progress"]
        for index, event in enumerate(whole):
            if event.id is None:
                continue
            with self.subTest(after=event):
                rest = self.events(job, event.id)
                expected = [e for e in whole[index + 1:] if e.name != "progress"]
                self.assertEqual([e for e in rest if e.name != "progress"], expected)
        after = read_all(self.daemon.port, f"/v1/jobs/{job}/events?after={strip[2].id}")
        self.assertEqual([e for e in after if e.name != "progress"], strip[3:])

    def test_resume_while_it_runs_across_a_daemon_kill(self):
        rows = 120
        job = self.client.submit({"rows": rows, "seconds": 3.0})["id"]
        events, last_id, cuts = [], None, 0
        while not events or events[-1].name != "done":
            try:
                with Stream(self.daemon.port, f"/v1/jobs/{job}/events", last_id, timeout=10) as stream:
                    for count, event in enumerate(stream):
                        events.append(event)
                        last_id = event.id or last_id
                        if count > 12 and cuts < 6:
                            break
            except (OSError, EOFError):
                pass
            cuts += 1
            if cuts in (2, 4):
                self.daemon.kill()
                self.daemon.start()
            self.assertLess(cuts, 50)
        self.check_rows(events, rows)
        self.check_ids(events)
        self.assertEqual(self.states(events), ["queued", "running", "succeeded"])
        self.assertEqual(len(self.daemon.started(job)), 1)

    def test_rewind_after_a_crash(self):
        job = self.client.submit({"rows": 40, "checkpoint": 10, "frames": 4,
                                  "crash": {"row": 27, "signal": 9}})["id"]
        done = self.client.finish(job)
        self.assertEqual((done["state"], len(done["attempts"])), ("succeeded", 2))
        events = self.events(job)
        rewinds = [e.data for e in events if e.name == "rewind"]
        self.assertEqual([r["row"] for r in rewinds], [20])
        self.check_rows(events, 40)
        self.check_ids(events)
        self.assertEqual(self.states(events)[-1], "succeeded")
        self.assertEqual([e.name for e in events].count("done"), 1)
        series_reply = self.client.get(f"/v1/jobs/{job}/series/probe.runout").json()
        self.assertEqual(series_reply["value"], [2.0 * k for k in range(41)])
        for index, event in enumerate(events):
            if event.id and index % 7 == 0:
                rest = [e for e in self.events(job, event.id) if e.name != "progress"]
                self.assertEqual(rest, [e for e in events[index + 1:] if e.name != "progress"])

    def test_rewind_to_the_start(self):
        job = self.client.submit({"rows": 20, "checkpoint": 0, "crash": {"row": 9}})["id"]
        self.assertEqual(self.client.finish(job)["state"], "succeeded")
        events = self.events(job)
        self.assertEqual([e.data["row"] for e in events if e.name == "rewind"], [0])
        self.check_rows(events, 20)

    def test_a_resumed_job_goes_on_with_its_story(self):
        job = self.client.submit({"fail": {"reason": "unstable", "exit": 11, "row": 9,
                                           "attempts": [1]}, "rows": 20})["id"]
        self.client.finish(job)
        first = self.events(job)
        self.assertEqual(first[-1].name, "done")
        self.client.post(f"/v1/jobs/{job}/resume")
        self.client.finish(job)
        rest = self.events(job, first[-1].id or first[-2].id)
        self.assertEqual([e.name for e in rest].count("done"), 1)
        self.assertEqual(self.states(rest), ["queued", "running", "succeeded"])
        self.check_rows(first + rest, 20)

    def test_after_the_end_nothing_is_left(self):
        job = self.client.submit()["id"]
        self.client.finish(job)
        whole = self.events(job)
        last = [e.id for e in whole if e.id][-1]
        rest = self.events(job, last)
        self.assertLessEqual({e.name for e in rest}, {"done", "progress"})

    def test_bad_ids(self):
        job = self.client.submit()["id"]
        self.client.finish(job)
        for last_id in ("x", "-1-0", "99999999-0", "5", "1-2-3", "99999999999999999999999-1", "0x10-0"):
            with self.subTest(last_id=last_id):
                with Stream(self.daemon.port, f"/v1/jobs/{job}/events", last_id) as stream:
                    self.assertIn(stream.open().status, (200, 400, 409, 422))
                    if stream.status == 200:
                        events = list(stream)
                        self.assertTrue(stream.ended)
                        self.assertEqual(events, self.events(job))

    def test_many_histories_go_out_together(self):
        job = self.client.submit({"rows": 5000, "flush": 1000, "seconds": 0.2, "checkpoint": 0})["id"]
        self.client.finish(job)
        self.check_rows(self.events(job), 5000)

    def test_cancelled_story(self):
        job = self.client.submit({"seconds": 30})["id"]
        wait_for(lambda: self.daemon.started(job), 10, "started")
        got = []
        reader = threading.Thread(target=lambda: got.extend(self.events(job)))
        reader.start()
        self.client.post(f"/v1/jobs/{job}/cancel")
        reader.join(30 * PATIENCE)
        self.assertFalse(reader.is_alive())
        self.assertEqual(self.states(got)[-1], "cancelled")
        self.assertEqual(got[-1].name, "done")

    def test_a_deleted_job_ends_its_streams(self):
        job = self.client.submit()["id"]
        self.client.finish(job)
        self.client.delete(f"/v1/jobs/{job}")
        with Stream(self.daemon.port, f"/v1/jobs/{job}/events") as stream:
            self.assertEqual(stream.open().status, 404)

    def test_readers_of_every_kind_at_once(self):
        job = self.client.submit({"seconds": 1.5, "rows": 60})["id"]
        results = []

        def reader(delay):
            time.sleep(delay)
            results.append(self.events(job))

        threads = [threading.Thread(target=reader, args=(0.05 * k,)) for k in range(30)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 30)
        reference = [e for e in results[0] if e.name not in ("progress",)]
        for events in results:
            self.check_rows(events, 60)
            self.assertEqual([e.data for e in events if e.name in ("state", "frame", "done")],
                             [e.data for e in reference if e.name in ("state", "frame", "done")])


class SlowReaders(DaemonTest):
    def test_a_reader_that_does_not_read_costs_no_memory(self):
        job = self.client.submit({"rows": 60000, "flush": 100, "checkpoint": 0, "seconds": 1})["id"]
        self.client.finish(job, 60)
        before = self.daemon.memory()
        path = f"/v1/jobs/{job}/events"
        streams = [Stream(self.daemon.port, path, receive_buffer=4096).open() for _ in range(20)]
        time.sleep(2)
        self.assertEqual(self.client.get("/healthz").status, 200)
        grown = self.daemon.memory() - before
        for stream in streams:
            stream.close()
        self.assertLess(grown, 60 << 20, "20 stalled readers")

    def test_a_stalled_reader_of_a_running_job_delays_nobody(self):
        job = self.client.submit({"rows": 20000, "flush": 50, "checkpoint": 0, "seconds": 3})["id"]
        path = f"/v1/jobs/{job}/events"
        stalled = [Stream(self.daemon.port, path, receive_buffer=4096).open() for _ in range(5)]
        begin = time.monotonic()
        good = read_all(self.daemon.port, path, seconds=40)
        self.assertLess(time.monotonic() - begin, 15 * PATIENCE)
        values = series(good)["probe.runout"][1]
        self.assertEqual(values, [2.0 * k for k in range(20001)])
        for stream in stalled:
            stream.close()


class Heartbeat(DaemonTest):
    def test_a_comment_every_fifteen_seconds(self):
        job = self.client.submit({"seconds": 60, "rows": 1})["id"]
        with Stream(self.daemon.port, f"/v1/jobs/{job}/events", timeout=25) as stream:
            begin = time.monotonic()
            reader = threading.Thread(target=self.drain, args=(stream,))
            reader.start()
            wait_for(lambda: stream.comments, 18, "a comment line")
            self.assertLess(time.monotonic() - begin, 18 * PATIENCE)
            self.client.post(f"/v1/jobs/{job}/cancel")
            reader.join(20 * PATIENCE)
            self.assertFalse(reader.is_alive())

    @staticmethod
    def drain(stream):
        for _ in stream:
            pass


if __name__ == "__main__":
    unittest.main()
