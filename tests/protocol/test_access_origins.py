# SPDX-License-Identifier: Apache-2.0
"""By which names the daemon may be called and from which pages: Host, Origin and CORS."""
import json
import os
import socket
import unittest

from talus_harness import PATIENCE, Daemon, DaemonTest, fake_scene, free_port

PAGE = "https://page.example:8443"


class Hosts(DaemonTest):
    """A proxy on this machine serves the daemon under other names."""
    config = {"hosts": ["talus.example", "192.0.2.7", "[2001:db8::7]"]}

    def test_hosts(self):
        port = self.daemon.port
        for host in ("talus.example", "TALUS.example:443", "192.0.2.7:8443", "[2001:db8::7]:443",
                     f"localhost:{port}", "[::1]", "[0:0:0:0:0:0:0:1]:80"):
            with self.subTest(host=host):
                self.assertEqual(self.client.get("/v1/version", host=host).status, 200)
        for host in ("evil.example", "talus.example.evil.example", "talus.example:x",
                     "talus.example:99999", "[2001:db8::8]", "[::1", "::1", "[]", "[", "x" * 300):
            with self.subTest(host=host):
                self.assert_problem(self.client.get("/v1/version", host=host), 403)

    def test_pages_of_the_proxy(self):
        for origin, host, status in (
                ("https://talus.example", "talus.example", 200),
                ("http://talus.example", "talus.example", 200),
                ("https://talus.example:8443", "talus.example:8443", 200),
                ("https://talus.example:8443", "talus.example", 403),
                ("https://evil.example", "talus.example", 403),
                ("https://localhost", "localhost", 403)):
            with self.subTest(origin=origin, host=host):
                reply = self.client.get("/v1/version", host=host, origin=origin)
                self.assertEqual(reply.status, status, reply)
                self.assertNotIn("access-control-allow-origin", reply.headers)


class Cors(DaemonTest):
    config = {"cors_origins": [PAGE, "http://localhost:3000"]}

    def preflight(self, path, origin=PAGE, method="POST"):
        return self.client.request("OPTIONS", path, headers={
            "Origin": origin, "Access-Control-Request-Method": method,
            "Access-Control-Request-Headers": "authorization,content-type"})

    def assert_open_to(self, reply, origin):
        self.assertEqual(reply.headers["access-control-allow-origin"], origin)
        self.assertEqual(reply.headers["vary"], "Origin")
        self.assertNotIn("access-control-allow-credentials", reply.headers)

    def test_preflight(self):
        for path, methods in (("/v1/jobs", {"GET", "HEAD", "POST"}),
                              ("/v1/jobs/x", {"GET", "HEAD", "PATCH", "DELETE"}),
                              ("/v1/jobs/x/files/a/b", {"GET", "HEAD"})):
            with self.subTest(path=path):
                reply = self.preflight(path)
                self.assertEqual((reply.status, reply.body), (204, b""), reply)
                self.assert_open_to(reply, PAGE)
                allowed = reply.headers["access-control-allow-methods"]
                self.assertLessEqual(methods, set(allowed.split(", ")))
                fields = reply.headers["access-control-allow-headers"].lower().split(", ")
                for field in ("authorization", "content-type", "idempotency-key", "if-match",
                              "if-none-match", "last-event-id", "range"):
                    self.assertIn(field, fields)
                self.assertGreater(int(reply.headers["access-control-max-age"]), 0)

    def test_preflight_of_others(self):
        for origin in ("https://page.example", "http://page.example:8443", PAGE.upper(), PAGE + "/",
                       "https://evil.example", "null", "*"):
            with self.subTest(origin=origin):
                reply = self.preflight("/v1/jobs", origin)
                self.assert_problem(reply, 403)
                self.assertNotIn("access-control-allow-origin", reply.headers)
        self.assertEqual(self.preflight("/nothing").status, 404)
        plain = self.client.request("OPTIONS", "/v1/jobs")
        self.assert_problem(plain, 405)
        self.assertIn("POST", plain.headers["allow"])

    def test_answers(self):
        reply = self.client.post("/v1/jobs", {"scene": fake_scene()}, origin=PAGE)
        self.assertEqual(reply.status, 201, reply)
        self.assert_open_to(reply, PAGE)
        shown = reply.headers["access-control-expose-headers"].split(", ")
        for field in ("ETag", "Location", "Idempotent-Replayed", "Retry-After"):
            self.assertIn(field, shown)
        events = self.client.get(f"/v1/jobs/{reply.json()['id']}/events", origin=PAGE)
        self.assert_open_to(events, PAGE)
        self.assert_open_to(self.client.get("/v1/jobs/x", origin="http://localhost:3000"),
                            "http://localhost:3000")
        mistake = self.client.post("/v1/jobs", {}, origin=PAGE)
        self.assert_problem(mistake, 422)
        self.assert_open_to(mistake, PAGE)

    def test_answers_without_an_origin(self):
        """A cache must not hand them to a page."""
        reply = self.client.get("/v1/version")
        self.assertEqual(reply.headers["vary"], "Origin")
        self.assertNotIn("access-control-allow-origin", reply.headers)


class UnixSocket(unittest.TestCase):
    def test_names_on_a_unix_socket(self):
        daemon = Daemon(config={"hosts": ["talus.example"], "cors_origins": [PAGE]})
        self.addCleanup(lambda: self.assertEqual(daemon.close(), ""))
        path = os.path.join(daemon.folder, "s")
        daemon.start(listen=f"unix:{path}")
        for fields, status in ((["Host: localhost"], 200), (["Host: talus.example"], 200),
                               (["Host: evil.example"], 403),
                               (["Host: localhost", "Origin: http://localhost"], 200),
                               (["Host: localhost", "Origin: http://evil.example"], 403),
                               (["Host: localhost", f"Origin: {PAGE}"], 200)):
            with self.subTest(fields=fields):
                self.assertEqual(self.ask(path, fields), status)

    @staticmethod
    def ask(path, fields):
        with socket.socket(socket.AF_UNIX) as stream:
            stream.settimeout(20 * PATIENCE)
            stream.connect(path)
            lines = ["GET /v1/version HTTP/1.1", *fields, "Connection: close", "", ""]
            stream.sendall("\r\n".join(lines).encode())
            return int(stream.recv(200).split()[1])


class SixthVersion(unittest.TestCase):
    def test_loopback(self):
        daemon = Daemon()
        self.addCleanup(lambda: self.assertEqual(daemon.close(), ""))
        port = free_port()
        daemon.start(listen=f"[::1]:{port}")
        if daemon.process.poll() is not None and "Address family not supported" in daemon.tail():
            self.skipTest("this machine has no IPv6")
        with socket.create_connection(("::1", port), 20 * PATIENCE) as stream:
            stream.sendall(f"GET /v1/version HTTP/1.1\r\nHost: [::1]:{port}\r\n"
                           "Connection: close\r\n\r\n".encode())
            answer = b"".join(iter(lambda: stream.recv(4096), b""))
        self.assertEqual(int(answer.split()[1]), 200)
        self.assertIn("version", json.loads(answer.split(b"\r\n\r\n")[1]))


if __name__ == "__main__":
    unittest.main()
