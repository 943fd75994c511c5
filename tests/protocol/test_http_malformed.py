# SPDX-License-Identifier: Apache-2.0
"""Bytes that are no good HTTP or no good JSON: refused with the right 4xx, and the daemon lives."""
import json
import socket
import time
import unittest

from talus_harness import DaemonTest, PATIENCE, fake_scene

GOOD = json.dumps({"scene": fake_scene()})


class RawTest(DaemonTest):
    def raw(self, data, timeout=10.0, half_close=False):
        """Sends bytes; returns (list of statuses, everything that came) until the server closes
        or stays silent after an answer."""
        with socket.create_connection(("127.0.0.1", self.daemon.port),
                                      timeout=timeout * PATIENCE) as stream:
            try:
                stream.sendall(data)
                if half_close:
                    stream.shutdown(socket.SHUT_WR)
            except (BrokenPipeError, ConnectionResetError):
                pass
            got = b""
            while True:
                try:
                    piece = stream.recv(65536)
                except (ConnectionResetError, TimeoutError):
                    break
                if not piece:
                    break
                got += piece
                if b"\r\n\r\n" in got:
                    stream.settimeout(0.5 * PATIENCE)
        statuses = [int(part.split()[0]) for part in got.split(b"HTTP/1.1 ")[1:]]
        return statuses, got

    def head(self, line, *headers, host=True):
        lines = [line] + ([f"Host: 127.0.0.1:{self.daemon.port}"] if host else []) + list(headers)
        return ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1")

    def refused(self, data, allowed, **more):
        """Every answer is out of `allowed` (None means: closed without a word), so that what came
        behind the bad request was not taken for another one. libmicrohttpd 0.9.75 sends the head
        of its own refusals twice, so two refusals are fine."""
        statuses, got = self.raw(data, **more)
        for status in statuses or [None]:
            self.assertIn(status, allowed, got[:500])
        self.assertEqual(self.client.get("/healthz").status, 200)


class Malformed(RawTest):
    def test_lengths_that_conflict(self):
        body = GOOD.encode()
        length = len(body)
        smuggled = b"GET /v1/version HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
        for headers in ((f"Content-Length: {length}", f"Content-Length: {length + 3}"),
                        (f"Content-Length: {length}", "Transfer-Encoding: chunked"),
                        ("Transfer-Encoding: chunked", f"Content-Length: {length}"),
                        (f"Content-Length: {length}, {length + 1}",),
                        ("Content-Length: 0", f"Content-Length: {length}"),
                        ("Content-Length: -5",), ("Content-Length: +5",), ("Content-Length: 5x",),
                        ("Content-Length: 0x10",), ("Content-Length: ",),
                        ("Content-Length: 99999999999999999999999",),
                        ("Transfer-Encoding: xchunked",), ("Transfer-Encoding: chunked, identity",),
                        ("Transfer-Encoding: chunked", "Transfer-Encoding: identity"),
                        ("Transfer-Encoding : chunked",), (f"Content-Length : {length}",)):
            with self.subTest(headers=headers):
                data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json", *headers)
                self.refused(data + body + smuggled, (400, 411, 413, 501, None))

    def test_one_length_given_twice_alike(self):
        body = GOOD.encode()
        data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                         f"Content-Length: {len(body)}", f"Content-Length: {len(body)}")
        statuses, _ = self.raw(data + body)
        self.assertIn(statuses, ([400], [201]))

    def test_targets(self):
        for target, allowed in (("/v1/jobs%00", (400, 404)), ("/v1/%00jobs", (400, 404)),
                                ("/v1/../v1/version", (400, 404)), ("/..", (400, 404)),
                                ("/../../../etc/passwd", (400, 404)), ("//v1/version", (400, 404)),
                                ("/v1//version", (400, 404)), ("/v1/./version", (400, 404)),
                                ("/v1/%2e%2e/v1/version", (400, 404)), ("/v1%2fversion", (400, 404)),
                                ("/v1/version%", (400, 404)), ("/v1/version%zz", (400, 404)),
                                ("/v1/version%c0%af", (400, 404)), ("/v1/jobs?limit=%00", (400, 422)),
                                ("/v1/jobs?state=%ff%fe", (400, 422)), ("v1/version", (400, 404)),
                                ("*", (400, 404, 405)), ("/v1/version\x01", (400, 404)),
                                ("/v1/version#x", (400, 404)), ("/v1/version/", (400, 404))):
            with self.subTest(target=target):
                self.refused(self.head(f"GET {target} HTTP/1.1", "Connection: close"), allowed)

    def test_request_lines(self):
        for line, allowed in (("GET /v1/version", (400, None, 200, 505)),
                              ("GET /v1/version HTTP/9.9", (400, 505, None)),
                              ("GET  /v1/version  HTTP/1.1", (400, 404, None)),
                              ("G\x00T /v1/version HTTP/1.1", (400, 405, 501, None)),
                              ("nonsense", (400, None, 501)), ("\x16\x03\x01\x02\x00\x01", (400, None, 501)),
                              ("BREW /v1/version HTTP/1.1", (400, 405, 501)),
                              ("TRACE /v1/version HTTP/1.1", (400, 405, 501)),
                              ("CONNECT 127.0.0.1:80 HTTP/1.1", (400, 404, 405, 501))):
            with self.subTest(line=line):
                self.refused(self.head(line, "Connection: close"), allowed)

    def test_headers(self):
        for header in ("no colon here", ": empty name", "X-Null: a\x00b", " X-Folded: first"):
            with self.subTest(header=header):
                self.refused(self.head("GET /v1/version HTTP/1.1", "Connection: close", header),
                             (400, 200, None))

    def test_sizes(self):
        self.refused(self.head("GET /v1/" + "a" * 9000 + " HTTP/1.1"), (404, 414, 431))
        self.refused(self.head("GET /v1/" + "a" * 200000 + " HTTP/1.1"), (414, 431, None))
        self.refused(self.head("GET /v1/version HTTP/1.1", "X-Big: " + "a" * 100000), (431, None))
        many = [f"X-{index}: {index}" for index in range(20000)]
        self.refused(self.head("GET /v1/version HTTP/1.1", *many), (431, None))

    def test_bodies_over_a_megabyte(self):
        # The announced length alone is enough to refuse.
        data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                         f"Content-Length: {1 << 40}")
        self.refused(data, (413,))
        before = self.daemon.memory()
        big = b'{"scene": "' + b"x" * (80 << 20) + b'"}'
        data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                         f"Content-Length: {len(big)}")
        self.refused(data + big, (413, None))
        chunk = b"100000\r\n" + b"x" * 0x100000 + b"\r\n"
        data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                         "Transfer-Encoding: chunked")
        self.refused(data + chunk * 80 + b"0\r\n\r\n", (413, None))
        self.assertLess(self.daemon.memory() - before, 48 << 20)

    def test_a_body_of_a_megabyte_is_taken(self):
        scene = fake_scene({"pad": ""})
        scene["title"] = "fake " + json.dumps({"pad": "x" * 900_000})
        reply = self.client.post("/v1/jobs", {"scene": scene})
        self.assertIn(reply.status, (201, 413, 422))

    def test_chunked_body(self):
        body = GOOD.encode()
        data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                         "Transfer-Encoding: chunked", "Connection: close")
        half = len(body) // 2
        for piece in (body[:half], body[half:], b""):
            data += f"{len(piece):x}\r\n".encode() + piece + b"\r\n"
        statuses, got = self.raw(data)
        self.assertEqual(statuses, [201], got[:300])

    def test_chunks_that_lie(self):
        for body in (b"zz\r\nabc\r\n0\r\n\r\n", b"-1\r\n\r\n", b"ffffffffffffffffff\r\nabc\r\n",
                     b"5\r\nabcdefgh\r\n0\r\n\r\n"):
            with self.subTest(body=body):
                data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                                 "Transfer-Encoding: chunked")
                self.refused(data + body, (400, 413, None), half_close=True)

    def test_half_a_request(self):
        data = self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                         f"Content-Length: {len(GOOD)}") + GOOD[:40].encode()
        for _ in range(20):
            with socket.create_connection(("127.0.0.1", self.daemon.port)) as stream:
                stream.sendall(data)
        self.refused(data, (400, 408, None), half_close=True, timeout=1)

    def test_expect_continue(self):
        body = GOOD.encode()
        with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=10 * PATIENCE) as stream:
            stream.sendall(self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                                     f"Content-Length: {len(body)}", "Expect: 100-continue",
                                     "Connection: close"))
            self.assertTrue(stream.recv(1000).startswith(b"HTTP/1.1 100"))
            stream.sendall(body)
            self.assertTrue(stream.recv(1000).startswith(b"HTTP/1.1 201"))

    def test_pipelined_requests(self):
        one = self.head("GET /v1/version HTTP/1.1")
        last = self.head("GET /v1/version HTTP/1.1", "Connection: close")
        statuses, _ = self.raw(one * 9 + last)
        self.assertEqual(statuses, [200] * 10)

    def test_media_types(self):
        for media in ("text/plain", "application/x-www-form-urlencoded", "application/jsonx",
                      "multipart/form-data; boundary=x", ""):
            with self.subTest(media=media):
                reply = self.client.request("POST", "/v1/jobs", GOOD, {"Content-Type": media})
                self.assert_problem(reply, 415)
        for media in ("application/json; charset=utf-8", "Application/JSON", "application/json;charset=UTF-8"):
            with self.subTest(media=media):
                reply = self.client.request("POST", "/v1/jobs", GOOD, {"Content-Type": media})
                self.assertEqual(reply.status, 201, reply)


class BadJson(DaemonTest):
    def post(self, text):
        return self.client.request("POST", "/v1/jobs", text, {"Content-Type": "application/json"})

    def test_line_and_column(self):
        reply = self.post('{\n  "scene": {},\n  "name": nonsense\n}')
        problem = self.assert_problem(reply, 400)
        text = json.dumps(problem)
        self.assertRegex(text, r"line[^0-9]{1,6}3")
        self.assertRegex(text, r"column[^0-9]{1,6}\d+")

    def test_not_json(self):
        for text in ("", " ", "{", "}", "[1,", '{"scene": }', "nul", "{'scene': 1}", '{"scene": {}} x',
                     '{"scene": NaN}', '{"scene": Infinity}', '{"scene": 01}', '{"scene": {},}',
                     '{"scene": "\x01"}', '{"a": "\\ud800"}', "// x\n{}"):
            with self.subTest(text=text):
                self.assert_problem(self.post(text), 400)
        for data in (b'{"scene": "\xff\xfe"}', b"\x00", b'{"a\x00b": 1}', b'\xef\xbb\xbf{"scene": 1}',
                     b'{"name": "\xc0\xaf"}', b'{"name": "\xed\xa0\x80"}'):
            with self.subTest(data=data):
                self.assert_problem(self.post(data), 400)

    def test_json_that_is_no_object(self):
        for text in ("[]", "5", '"x"', "null", "true"):
            with self.subTest(text=text):
                reply = self.post(text)
                self.assertIn(reply.status, (400, 422))
                self.assert_problem(reply, reply.status)

    def test_depth(self):
        for text in ("[" * 100_000, '{"scene":' * 50_000, "[" * 100_000 + "]" * 100_000,
                     '{"scene": {"bodies": ' + "[" * 3000 + "]" * 3000 + "}}"):
            with self.subTest(text=text[:20]):
                begin = time.monotonic()
                reply = self.post(text)
                self.assertIn(reply.status, (400, 422))
                self.assertLess(time.monotonic() - begin, 3 * PATIENCE)

    def test_duplicate_keys(self):
        self.assert_problem(self.post('{"name": "a", "name": "b", "scene": {}}'), 400)
        self.assert_problem(self.post('{"scene": {"duration": 1, "duration": 2}}'), 400)

    def test_huge_numbers(self):
        for number in ("1e400", "-1e400", "123456789012345678901234567890", "1e-400", "-0"):
            with self.subTest(number=number):
                reply = self.post('{"scene": {}, "priority": ' + number + "}")
                self.assertIn(reply.status, (400, 422), reply)

    def test_text_that_is_hard_to_quote(self):
        name = 'a"b\\c\u0007\n\u2028<script>\U0001F600'
        job = self.client.post("/v1/jobs", {"scene": fake_scene(), "name": name})
        if job.status == 201:
            self.assertEqual(self.client.job(job.json()["id"])["name"], name)
        else:
            self.assert_problem(job, 422, None, "/name")
        problem = self.assert_problem(self.client.post("/v1/jobs", {"scene": fake_scene(), name: 1}), 422)
        self.assertEqual(len(problem["errors"]), 1)
        reply = self.client.post("/v1/jobs", {"scene": fake_scene(), "a/b~c": 1})
        self.assert_problem(reply, 422, None, "/a~1b~0c")

    def test_null_character_in_text(self):
        reply = self.post('{"scene": {}, "name": "a\\u0000b"}')
        self.assertIn(reply.status, (400, 422))


class SlowClients(RawTest):
    config = {"request_seconds": 3}

    def test_thousands_of_query_parameters(self):
        """libmicrohttpd 0.9.75 runs out of its pool and falls silent; the deadline closes it."""
        query = "&".join(f"a{k}=1" for k in range(3000))
        begin = time.monotonic()
        self.refused(self.head(f"GET /v1/jobs?{query} HTTP/1.1"), (400, 414, 422, 431, None), timeout=12)
        self.assertLess(time.monotonic() - begin, 8 * PATIENCE)

    def assert_drip_is_closed(self, begin_with, byte):
        """A request that begins so, and goes on with a byte now and then, is cut off."""
        begin = time.monotonic()
        with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=1) as stream:
            stream.sendall(begin_with)
            closed = False
            while not closed and time.monotonic() - begin < 12 * PATIENCE:
                try:
                    stream.sendall(byte)
                    stream.settimeout(0.5)
                    closed = stream.recv(1000) == b"" or closed
                except TimeoutError:
                    pass
                except OSError:
                    closed = True
        self.assertTrue(closed, f"without end: {begin_with}")

    def test_slow_loris_is_closed(self):
        """A head that never ends, byte by byte, must not hold a connection for long."""
        self.assert_drip_is_closed(b"GET /v1/version HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: ", b"a")

    def test_slow_body_is_closed(self):
        self.assert_drip_is_closed(
            self.head("POST /v1/jobs HTTP/1.1", "Content-Type: application/json",
                      "Content-Length: 10000"), b" ")

    def test_idle_connections_do_not_block(self):
        idle = [socket.create_connection(("127.0.0.1", self.daemon.port)) for _ in range(200)]
        begin = time.monotonic()
        self.assertEqual(self.client.get("/v1/version").status, 200)
        self.assertLess(time.monotonic() - begin, 2 * PATIENCE)
        for stream in idle:
            stream.close()


if __name__ == "__main__":
    unittest.main()
