# SPDX-License-Identifier: Apache-2.0
"""/metrics: well formed (by promtool too, where it is installed), and counting what happens."""
import re
import shutil
import subprocess
import unittest

from sse_reader import Stream
from talus_harness import DaemonTest, wait_for

PROMTOOL = shutil.which("promtool")
LINE = re.compile(r'^(talus_[a-z_]+)(?:\{((?:[a-z_]+="[^"\\\n]*",?)*)\})? (\S+)$')


def samples(text):
    """{(name, labels): value}; every sample belongs to the HELP and TYPE before it, once."""
    found, types, current = {}, {}, None
    for line in text.splitlines():
        if line.startswith("# HELP "):
            current = line.split()[2]
            assert current not in types, f"{current} comes twice"
        elif line.startswith("# TYPE "):
            assert line.split()[2] == current
            types[current] = line.split()[3]
        else:
            name, labels, value = LINE.match(line).groups()
            base = re.sub("_(bucket|sum|count)$", "", name) if types[current] == "histogram" else name
            assert base == current, line
            assert (types[current] == "counter") == base.endswith("_total"), line
            key = (name, labels or "")
            assert key not in found, line
            found[key] = float(value)
    return found


class Metrics(DaemonTest):
    workers = 2

    def read(self):
        reply = self.client.get("/metrics")
        self.assertEqual(reply.status, 200)
        self.assertTrue(reply.headers["content-type"].startswith("text/plain; version=0.0.4"))
        self.text = reply.body.decode()
        return samples(self.text)

    def value(self, name, labels=""):
        return self.read()[(name, labels)]

    def test_jobs_and_attempts(self):
        before = self.read()
        good = self.client.submit()["id"]
        crashed = self.client.submit({"crash": {"row": 6}})["id"]
        for job in (good, crashed):
            self.client.finish(job)
        failed = self.client.submit({"fail": {"reason": "unstable", "exit": 11}})["id"]
        self.client.finish(failed)

        def all_counted():
            after = self.read()
            rise = {key: value - before.get(key, 0) for key, value in after.items()}
            return rise if rise[("talus_attempts_ended_total", 'end="failed"')] == 1 else None

        rise = wait_for(all_counted, 10, "counted")
        self.assertEqual(rise[("talus_jobs", 'state="succeeded"')], 2)
        self.assertEqual(rise[("talus_jobs", 'state="failed"')], 1)
        self.assertEqual(rise[("talus_attempts_begun_total", "")], 4)
        self.assertEqual(rise[("talus_restarts_total", "")], 1)
        self.assertEqual(rise[("talus_attempts_ended_total", 'end="succeeded"')], 2)
        self.assertEqual(rise[("talus_attempts_ended_total", 'end="crashed"')], 1)
        self.assertGreater(rise[("talus_store_commits_total", "")], 0)
        self.assertGreater(rise[("talus_worker_cpu_seconds_total", "")], 0)

    def test_threads_and_queue(self):
        jobs = [self.client.submit({"seconds": 60})["id"] for _ in range(3)]
        wait_for(lambda: self.value("talus_threads_busy") == 2, 20, "two run")
        now = self.read()
        self.assertEqual(now[("talus_threads", "")], 2)
        self.assertEqual(now[("talus_queue_depth", "")], 1)
        self.assertEqual(now[("talus_jobs", 'state="running"')], 2)
        for job in jobs[::-1]:
            self.client.post(f"/v1/jobs/{job}/cancel")
            self.client.finish(job)
        wait_for(lambda: self.value("talus_threads_busy") == 0, 20, "none runs")

    def test_requests(self):
        labels = 'method="GET",route="/v1/jobs/*",status="404"'
        name = "talus_http_request_duration_seconds"
        before = self.read().get((name + "_count", labels), 0)
        for _ in range(7):
            self.client.get("/v1/jobs/" + "0" * 26)
        self.client.get("/nowhere")
        after = self.read()
        self.assertEqual(after[(name + "_count", labels)] - before, 7)
        self.assertEqual(after[(name + "_bucket", labels + ',le="+Inf"')],
                         after[(name + "_count", labels)])
        self.assertGreater(after[(name + "_sum", labels)], 0)
        self.assertGreaterEqual(
            after[(name + "_count", 'method="other",route="none",status="404"')], 1)
        bounds = {}
        for (which, where), value in after.items():
            if which == name + "_bucket":
                series, bound = where.rsplit(",", 1)
                bounds.setdefault(series, []).append((float(bound[4:-1]), value))
        for series, values in bounds.items():
            self.assertEqual(values, sorted(values), series)
            self.assertEqual([v for _, v in values], sorted(v for _, v in values), series)

    def test_event_readers(self):
        with Stream(self.daemon.port, "/v1/events?after=latest") as stream:
            stream.open()
            wait_for(lambda: self.value("talus_event_readers") == 1, 10, "a reader")
        # That a reader is gone shows when something is sent to it.
        def gone():
            self.client.finish(self.client.submit()["id"])
            return self.value("talus_event_readers") == 0

        wait_for(gone, 60, "no reader")

    def test_what_is_there(self):
        now = self.read()
        self.assertGreater(now[("talus_disk_free_bytes", "")], 1e6)
        self.assertGreater(now[("talus_uptime_seconds", "")], 0)
        self.assertEqual(now[("talus_store_healthy", "")], 1)
        self.assertEqual([value for (name, _), value in now.items() if name == "talus_build_info"],
                         [1])

    @unittest.skipUnless(PROMTOOL, "promtool (Debian package prometheus) is not installed")
    def test_promtool(self):
        self.read()
        done = subprocess.run([PROMTOOL, "check", "metrics"], input=self.text, text=True,
                              capture_output=True, check=False)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))


if __name__ == "__main__":
    unittest.main()
