# SPDX-License-Identifier: Apache-2.0
"""The command-line client against a scripted server."""
import hashlib
import json
import os
import pty
import shutil
import subprocess
import sys
import tempfile
import unittest

import scripted_server

TALUS = ""
JOB = {"id": "01j", "name": "impact", "state": "succeeded", "labels": {"case": "mast-7.4"},
       "created_at": "2026-01-01T00:00:00Z", "attempts": [{}], "metrics": {"reaction.wall.peak": 171e3},
       "forecast": {"particles": 1000, "steps": 7000, "memory_bytes": 2e6, "disk_bytes": 5e7,
                    "wall_seconds": {"low": 50, "expected": 80, "high": 130}}}


class ClientTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def serve(self, answer, **options):
        server = scripted_server.start(answer, **options)
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        return server

    def talus(self, *arguments, server=None, **options):
        environment = {**os.environ, "TALUS_SERVER": "http://127.0.0.1:1", "LC_ALL": "C.UTF-8"}
        environment.pop("TALUS_TOKEN", None)
        if server is not None:
            environment["TALUS_SERVER"] = server.url
        environment.update(options.pop("environment", {}))
        return subprocess.run([TALUS, *arguments], capture_output=True, text=True, check=False,
                              env=environment, cwd=self.folder, timeout=60, **options)

    def scene(self, text='{"dimension": "solid"}'):
        path = os.path.join(self.folder, "scene.json")
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
        return path

    def expect(self, result, code, output="", error=""):
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertIn(output, result.stdout)
        self.assertIn(error, result.stderr)


class CommandLine(ClientTest):
    def test_help_and_usage(self):
        self.expect(self.talus("--help"), 0, "submit")
        self.expect(self.talus("--version"), 0, "talus 0.")
        self.expect(self.talus(), 2, error="usage")
        self.expect(self.talus("subbmit"), 2, error="unknown command 'subbmit'")
        for command in ("submit", "list", "show", "watch", "reactions", "fetch", "cancel",
                        "resume", "delete", "study"):
            self.expect(self.talus(command, "--help"), 0, f"usage: talus {command}")
        self.expect(self.talus("show"), 2, error="usage: talus show")
        self.expect(self.talus("show", "a", "b"), 2, error="usage: talus show")
        self.expect(self.talus("list", "--colour"), 2, error="colour")
        self.expect(self.talus("list", "--limit", "-3"), 2, error="--limit")
        self.expect(self.talus("study", "x.json"), 2, error="unknown action 'x.json'")
        self.expect(self.talus("study", "show"), 2, error="usage: talus study [OPTIONS] show ID")
        self.expect(self.talus("show", "a", "--server", "ftp://x"), 2, error="ftp://x")

    def test_no_server(self):
        self.expect(self.talus("list"), 4, error="no answer from http://127.0.0.1:1")
        self.expect(self.talus("watch", "a"), 4, error="no answer")
        self.expect(self.talus("submit", self.scene()), 4, error="no answer")
        self.expect(self.talus("list", "--server", f"unix:{self.folder}/none"), 4,
                    error="no answer")

    def test_unix_socket_token_and_escaping(self):
        server = self.serve(lambda handler: handler.send(200, JOB),
                            socket_path=os.path.join(self.folder, "socket"))
        result = self.talus("show", "../a b?", "--json", server=server,
                            environment={"TALUS_TOKEN": "secret"})
        self.expect(result, 0)
        self.assertEqual(json.loads(result.stdout), JOB)
        method, path, headers, _ = server.requests[0]
        self.assertEqual((method, path), ("GET", "/v1/jobs/..%2Fa%20b%3F"))
        self.assertEqual(headers["Authorization"], "Bearer secret")

    def test_token_file(self):
        server = self.serve(lambda handler: handler.send(200, JOB))
        path = os.path.join(self.folder, "token")
        environment = {"TALUS_TOKEN": "other"}
        for content, mode, said in (("secret\nmore\n", 0o600, ""), ("secret", 0o600, ""),
                                    ("s" * 512 + "\n", 0o644, "everyone can read")):
            with open(path, "w", encoding="utf-8") as stream:
                stream.write(content)
            os.chmod(path, mode)
            result = self.talus("show", "x", "--token-file", path, server=server,
                                environment=environment)
            self.expect(result, 0)
            self.assertEqual(said in result.stderr, True)
            self.assertEqual(said == "", result.stderr == "")
            self.assertEqual(server.requests[-1][2]["Authorization"],
                             "Bearer " + content.split("\n")[0])
        self.talus("show", "x", server=server, environment={"TALUS_TOKEN": ""})
        self.assertNotIn("Authorization", server.requests[-1][2])
        count = len(server.requests)
        for content in ("", "\n", "a b\n", "s" * 514):
            with open(path, "w", encoding="utf-8") as stream:
                stream.write(content)
            self.assertEqual(self.talus("show", "x", "--token-file", path, server=server).returncode, 2)
        for arguments, variables in ((["--token-file", path + "-none"], {}),
                                     ([], {"TALUS_TOKEN": "a\nHost: evil"})):
            result = self.talus("show", "x", *arguments, server=server, environment=variables)
            self.assertEqual(result.returncode, 2)
            self.assertNotIn("evil", result.stderr)
        self.assertEqual(len(server.requests), count)

    def test_show_and_actions(self):
        server = self.serve(lambda handler: handler.send(
            204 if handler.command == "DELETE" else 200,
            b"" if handler.command == "DELETE" else {**JOB, "state": "queued"}))
        self.expect(self.talus("show", "01j", server=server), 0, "case=mast-7.4")
        self.expect(self.talus("resume", "01j", server=server), 0, "01j queued")
        self.expect(self.talus("delete", "a", "b", server=server), 0, "a deleted\nb deleted")
        self.assertEqual([request[:2] for request in server.requests[1:]],
                         [("POST", "/v1/jobs/01j/resume"), ("DELETE", "/v1/jobs/a"),
                          ("DELETE", "/v1/jobs/b")])

    def test_list_follows_the_cursor(self):
        def answer(handler):
            last = "cursor=c%26d" in handler.path
            handler.send(200, {"jobs": [{**JOB, "id": "02" if last else "01"}],
                               "cursor": None if last else "c&d"})
        server = self.serve(answer)
        result = self.talus("list", "--label", "case=a b", "--json", server=server)
        self.expect(result, 0)
        self.assertEqual([job["id"] for job in json.loads(result.stdout)], ["01", "02"])
        self.assertIn("label=case%3Aa%20b", server.requests[0][1])


class Submit(ClientTest):
    def test_body_and_key(self):
        server = self.serve(lambda handler: handler.send(201, {**JOB, "state": "queued"}))
        result = self.talus("submit", self.scene('{"a": 1.5e-3, "b": 7}'), "--name", "n", "--label",
                            "k=v=w", "--label", "l=", "--priority", "-5", "--threads", "2",
                            "--idempotency-key", "K", server=server)
        self.expect(result, 0, "01j queued\nforecast   1000 particles")
        _, path, headers, body = server.requests[0]
        self.assertEqual(path, "/v1/jobs")
        self.assertEqual(headers["Idempotency-Key"], "K")
        self.assertEqual(headers["Content-Type"], "application/json")
        self.assertEqual(json.loads(body), {
            "scene": {"a": 0.0015, "b": 7}, "name": "n", "labels": {"k": "v=w", "l": ""},
            "priority": -5, "threads": 2})

    def test_lost_answer_is_asked_for_again_with_the_same_key(self):
        def answer(handler):
            if len(server.requests) == 1:
                handler.close_connection = True
                handler.connection.close()
            else:
                handler.send(201, JOB, Idempotent_Replayed="true")
        server = self.serve(answer)
        self.expect(self.talus("submit", self.scene(), server=server), 0, "(submitted before)")
        keys = [request[2]["Idempotency-Key"] for request in server.requests]
        self.assertEqual(len(keys), 2)
        self.assertEqual(keys[0], keys[1])
        self.assertGreaterEqual(len(keys[0]), 32)

    def test_problem_document(self):
        problem = {"type": "about:blank", "title": "Invalid", "status": 422, "detail": "2 mistakes",
                   "errors": [{"pointer": "/scene/grid/cell", "code": "range", "detail": "too small",
                               "given": -1, "allowed": "> 0"},
                              {"pointer": "/scene/soler", "code": "unknown_key",
                               "detail": "did you mean solver?"}]}
        server = self.serve(lambda handler: handler.send(
            422, problem, content_type="application/problem+json"))
        result = self.talus("submit", self.scene(), server=server)
        self.expect(result, 3, error="2 mistakes (422)")
        for text in ("/scene/grid/cell: too small [range]", "given: -1", 'allowed: "> 0"',
                     "/scene/soler: did you mean solver?"):
            self.assertIn(text, result.stderr)

    def test_other_refusals(self):
        server = self.serve(lambda handler: handler.send(502, b"<html>bad gateway", "text/html"))
        self.expect(self.talus("list", server=server), 3, error="502: <html>bad gateway")

    def test_local_mistakes(self):
        self.expect(self.talus("submit", "none.json"), 2, error="none.json")
        self.expect(self.talus("submit", self.scene('{"a": \n 1,}')), 2, error="line 2")
        self.expect(self.talus("submit", self.scene('{"a": 1, "a": 2}')), 2, error="duplicate")
        self.expect(self.talus("submit", self.scene(), "--label", "x"), 2, error="KEY=VALUE")
        self.expect(self.talus("submit", self.scene(), "--priority", "101"), 2, error="100")


def force(component, times, values):
    return {"name": f"reaction.wall.force.{component}", "time": times, "value": values}


class Watch(ClientTest):
    """The stream breaks after every third event and within one."""
    EVENTS = [
        ("state", {"event": "state", "at": "T0", "state": "queued"}),
        ("state", {"event": "state", "at": "T1", "state": "running"}),
        ("progress", {"fraction": 0.25, "time": 0.5, "step": 10, "eta_seconds": 75,
                      "particle_steps_per_second": 3e6}),
        ("reaction", force("x", [0.1, 0.2], [3e3, 60e3])),
        ("reaction", force("y", [0.1, 0.2], [4e3, 80e3])),
        ("warning", {"pointer": "/boundaries/0", "detail": "snapped"}),
        ("rewind", {"row": 1, "time": 0.15, "frame": 1}),
        ("reaction", force("x", [0.2], [30e3])),
        ("reaction", force("y", [0.2], [40e3])),
        ("progress", {"fraction": 1, "time": 2, "step": 40, "particle_steps_per_second": 3e6}),
        ("state", {"event": "state", "at": "T2", "state": "succeeded"}),
        ("done", {}),
    ]

    def answer(self, handler):
        path = handler.path
        if path.endswith("/series"):
            handler.send(200, [{"name": "reaction.wall.force.x", "unit": "N/m"}])
        elif path.endswith("/events"):
            after = int(handler.headers.get("Last-Event-ID", "0-0").split("-")[0])
            if after == 3 and not self.refused:
                self.refused = True
                handler.send(503, b"{}", Retry_After="1")
                return
            handler.begin_stream()
            for number in range(after + 1, min(after + 3, len(self.EVENTS)) + 1):
                handler.send_event(f"{number}-0", *self.EVENTS[number - 1])
            handler.wfile.write(b"id: 99-0\nevent: progress\ndata: {\"frac")
        else:
            handler.send(200, {**JOB, "state": self.state, "reason": "unstable", "detail": "at 1 s"})

    def start(self, state="succeeded"):
        self.refused, self.state = False, state
        return self.serve(self.answer)

    def test_plain(self):
        server = self.start()
        result = self.talus("watch", "01j", server=server)
        self.expect(result, 0, "T0  queued\nT1  running\n")
        for text in ("25.0 %", "warning: /boundaries/0: snapped", "checkpoint at t = 0.15 s",
                     "T2  succeeded", "reaction.wall.peak"):
            self.assertIn(text, result.stdout)
        ids = [request[2].get("Last-Event-ID") for request in server.requests
               if request[1].endswith("/events")]
        self.assertEqual(ids, [None, "3-0", "3-0", "6-0", "9-0"])

    def test_json_tells_every_event_once(self):
        result = self.talus("watch", "01j", "--json", server=self.start())
        self.expect(result, 0)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([(line["event"], line["data"]) for line in lines], self.EVENTS)

    def test_failed_job(self):
        self.expect(self.talus("watch", "01j", server=self.start("failed")), 1,
                    "failed: unstable\ndetail     at 1 s")
        self.expect(self.talus("watch", "01j", server=self.start("cancelled")), 1)

    def test_terminal(self):
        master, slave = pty.openpty()
        server = self.start()
        with subprocess.Popen([TALUS, "watch", "01j", "--server", server.url], stdout=slave,
                              stderr=slave) as process:
            os.close(slave)
            output = b""
            while True:
                try:
                    piece = os.read(master, 65536)
                except OSError:
                    break
                if not piece:
                    break
                output += piece
        os.close(master)
        self.assertEqual(process.returncode, 0)
        text = output.decode()
        self.assertIn("wall: (30.0, 40.0) kN/m, peak 50 kN/m at 0.200 s", text)
        self.assertIn("\x1b[", text)

    def test_unknown_job(self):
        server = self.serve(lambda handler: handler.send(404, {"title": "Not found"}))
        self.expect(self.talus("watch", "x", server=server), 3, error="Not found (404)")

    def test_all_is_known_already(self):
        def answer(handler):
            handler.send(204 if handler.path.endswith("/events") else 200,
                         b"" if handler.path.endswith("/events") else JOB)
        self.expect(self.talus("watch", "x", server=self.serve(answer)), 0, "succeeded")

    def test_submit_and_watch(self):
        def answer(handler):
            if handler.command == "POST":
                handler.send(201, {**JOB, "state": "queued"})
            else:
                self.answer(handler)
        self.refused, self.state = False, "succeeded"
        self.expect(self.talus("submit", self.scene(), "--watch", server=self.serve(answer)), 0,
                    "T2  succeeded")


class Fetch(ClientTest):
    FILES = {"scene.json": b"{}\n", "frames/frame_000000.hdf": bytes(range(256)) * 4000,
             "frames/frame_000001.hdf": b""}

    def answer(self, handler):
        if handler.path.endswith("/files"):
            handler.send(200, [{"name": name, "bytes": len(content),
                                "sha256": hashlib.sha256(content).hexdigest()}
                               for name, content in self.listed.items()])
            return
        content = self.FILES[handler.path.split("/files/")[1]]
        begin = 0
        if "Range" in handler.headers and self.ranges:
            begin = int(handler.headers["Range"].removeprefix("bytes=").removesuffix("-"))
        if self.cuts > 0 and len(content) > 1000:
            self.cuts -= 1
            handler.send_response(206 if begin else 200)
            handler.send_header("Content-Length", str(len(content) - begin))
            handler.end_headers()
            handler.wfile.write(content[begin:begin + 300000])
            handler.close_connection = True
            return
        handler.send(206 if begin else 200, content[begin:], "application/octet-stream")

    def start(self, cuts=0, ranges=True, listed=None):
        self.cuts, self.ranges = cuts, ranges
        self.listed = self.FILES if listed is None else listed
        return self.serve(self.answer)

    def read(self, *parts):
        with open(os.path.join(self.folder, *parts), "rb") as stream:
            return stream.read()

    def test_everything_and_again(self):
        server = self.start()
        self.expect(self.talus("fetch", "01j", "--into", "out", server=server), 0, "scene.json")
        for name, content in self.FILES.items():
            self.assertEqual(self.read("out", name), content)
        before = len(server.requests)
        self.expect(self.talus("fetch", "01j", "--into", "out", server=server), 0, "already there")
        self.assertEqual(len(server.requests), before + 1)

    def test_some(self):
        server = self.start()
        self.expect(self.talus("fetch", "01j", "frames/*0.hdf", server=server), 0)
        self.assertEqual(os.listdir(os.path.join(self.folder, "01j", "frames")),
                         ["frame_000000.hdf"])
        self.expect(self.talus("fetch", "01j", "none.txt", server=server), 3, error="no such file")
        self.expect(self.talus("fetch", "01j", "--list", server=server), 0, "1.0 MB")

    def test_broken_connections_are_taken_up(self):
        server = self.start(cuts=3)
        self.expect(self.talus("fetch", "01j", "--into", "out", server=server), 0)
        self.assertEqual(self.read("out", "frames/frame_000000.hdf"),
                         self.FILES["frames/frame_000000.hdf"])
        ranges = [request[2].get("Range") for request in server.requests
                  if request[1].endswith("000000.hdf")]
        self.assertEqual(ranges, [None, "bytes=300000-", "bytes=600000-", "bytes=900000-"])

    def test_what_an_earlier_call_left(self):
        for ranges in (True, False):  # a server may send the whole instead
            os.makedirs(os.path.join(self.folder, "out", "frames"), exist_ok=True)
            with open(os.path.join(self.folder, "out/frames/frame_000000.hdf.part"), "wb") as part:
                part.write(self.FILES["frames/frame_000000.hdf"][:1234])
            self.expect(self.talus("fetch", "01j", "frames/frame_000000.hdf", "--into", "out",
                                   server=self.start(ranges=ranges)), 0)
            self.assertEqual(self.read("out", "frames/frame_000000.hdf"),
                             self.FILES["frames/frame_000000.hdf"])
            shutil.rmtree(os.path.join(self.folder, "out"))

    def test_wrong_content_is_not_kept(self):
        server = self.start(listed={**self.FILES, "scene.json": b"{}x"})
        self.expect(self.talus("fetch", "01j", "scene.json", "--into", "out", server=server), 3,
                    error="SHA-256")
        self.assertEqual(os.listdir(os.path.join(self.folder, "out")), [])

    def test_names_that_leave_the_folder(self):
        for name in ("../evil", "/etc/evil", "a/../../evil", "a//b", "."):
            server = self.start(listed={name: b"x"})
            self.expect(self.talus("fetch", "01j", "--into", "out", server=server), 2, error=name)
        self.assertEqual(os.listdir(self.folder), [])


class Reactions(ClientTest):
    def answer(self, handler):
        series = {"reaction.wall.force.x": [0, 100e3, 50e3, 40e3, 40e3],
                  "reaction.wall.force.y": [0, 0, 0, 30e3, 30e3], "probe.front": [1] * 5}
        path = handler.path
        if path.endswith("/series"):
            handler.send(200, [{"name": name, "unit": "N"} for name in series])
        elif "/series/" in path:
            name = path.split("/series/")[1]
            handler.send(200, {"name": name, "unit": "N", "time": [0, 1, 2, 3, 4],
                               "value": series[name]})
        else:
            handler.send(200, {**JOB, "metrics": self.metrics})

    def test_finished(self):
        self.metrics = {"reaction.wall.peak": 171e3, "reaction.wall.peak_time": 1.3}
        server = self.serve(self.answer)
        self.expect(self.talus("reactions", "01j", server=server), 0, "171 kN at 1.3 s")
        result = self.talus("reactions", "01j", "--json", "--from", "1.5", server=server)
        self.expect(result, 0)
        (wall,) = json.loads(result.stdout)
        # Intervals [1, 2] (half of it), [2, 3] and [3, 4].
        self.assertAlmostEqual(wall["steady"][0], (0.5 * 50e3 + 40e3 + 40e3) / 2.5)
        self.assertAlmostEqual(wall["steady"][1], (30e3 + 30e3) / 2.5)
        self.assertEqual((wall["force"], wall["peak"]), ([40e3, 30e3], 171e3))

    def test_running(self):
        self.metrics = None
        server = self.serve(self.answer)
        self.expect(self.talus("reactions", "01j", server=server), 0,
                    "100 kN at 1 s (largest sample so far)")


if __name__ == "__main__":
    TALUS = sys.argv.pop(1)
    unittest.main()
