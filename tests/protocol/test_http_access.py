# SPDX-License-Identifier: Apache-2.0
"""Who may talk to the daemon: Host and Origin on loopback, no other address without tokens."""
import http.client
import os
import socket
import subprocess
import tempfile
import unittest

from talus_harness import Daemon, DaemonTest, PATIENCE, TALUSD, fake_scene, free_port, wait_for


class HostAndOrigin(DaemonTest):
    def test_host(self):
        port = self.daemon.port
        for host in (f"127.0.0.1:{port}", f"localhost:{port}", f"LOCALHOST:{port}"):
            with self.subTest(host=host):
                self.assertEqual(self.client.get("/v1/version", host=host).status, 200)
        for host in ("evil.example", f"evil.example:{port}", f"127.0.0.1.evil.example:{port}",
                     f"localhost.evil.example:{port}", f"127.0.0.1:{port}@evil.example", "",
                     f"127.0.0.1:{port} evil.example", f"[::1]evil:{port}"):
            with self.subTest(host=host):
                reply = self.client.get("/v1/version", host=host)
                self.assertIn(reply.status, (400, 403, 421), reply)
                self.assert_problem(reply, reply.status)

    def test_host_missing_or_twice(self):
        for hosts in ([], [f"127.0.0.1:{self.daemon.port}", "evil.example"]):
            with self.subTest(hosts=hosts):
                connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port,
                                                        timeout=10 * PATIENCE)
                connection.putrequest("GET", "/v1/version", skip_host=True)
                for host in hosts:
                    connection.putheader("Host", host)
                connection.endheaders()
                self.assertIn(connection.getresponse().status, (400, 403, 421))
                connection.close()

    def test_origin(self):
        port = self.daemon.port
        for origin in ("http://evil.example", "null", f"http://evil.example:{port}",
                       f"https://127.0.0.1:{port}", f"http://127.0.0.1:{port + 1}", "x"):
            with self.subTest(origin=origin):
                for method, path, body in (("POST", "/v1/jobs", {"scene": fake_scene()}),
                                           ("DELETE", "/v1/jobs/x", None)):
                    reply = self.client.request(method, path, body, {"Origin": origin})
                    self.assert_problem(reply, 403)
        same = self.client.post("/v1/jobs", {"scene": fake_scene()}, origin=f"http://127.0.0.1:{port}")
        self.assertEqual(same.status, 201, same)

    def test_no_cross_origin_headers(self):
        reply = self.client.request("OPTIONS", "/v1/jobs", headers={
            "Origin": "http://evil.example", "Access-Control-Request-Method": "POST"})
        self.assertNotIn("access-control-allow-origin", reply.headers)
        self.assertIn(reply.status, (204, 403, 404, 405))


class Listening(unittest.TestCase):
    def test_unix_socket(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "s")
            daemon = Daemon()
            command = [TALUSD, "--state", daemon.state, "--listen", f"unix:{path}",
                       "--worker-program", daemon.program]
            with open(daemon.log, "ab") as log:
                daemon.process = subprocess.Popen(command, stdout=log, stderr=log)
            try:
                wait_for(lambda: os.path.exists(path), 20, daemon.tail())
                wait_for(lambda: self.ask(path), 10, "answer over the socket")
            finally:
                self.assertEqual(daemon.close(), "")

    @staticmethod
    def ask(path):
        with socket.socket(socket.AF_UNIX) as stream:
            stream.settimeout(5 * PATIENCE)
            try:
                stream.connect(path)
            except OSError:
                return False
            stream.sendall(b"GET /v1/version HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            return stream.recv(100).startswith(b"HTTP/1.1 200")

    def refused(self, *arguments, folder=None):
        """talusd must end by itself with an error and say why."""
        with tempfile.TemporaryDirectory() as fresh:
            process = subprocess.run([TALUSD, "--state", folder or os.path.join(fresh, "state"), *arguments],
                                     capture_output=True, timeout=20 * PATIENCE, text=True)
        self.assertNotEqual(process.returncode, 0)
        self.assertGreater(process.returncode, 0, "died of a signal")
        self.assertTrue(process.stderr.strip())

    def test_every_address_needs_tokens(self):
        self.refused("--listen", f"0.0.0.0:{free_port()}")

    def test_nonsense(self):
        for arguments in (["--listen", "nonsense"], ["--listen", "127.0.0.1:99999"], ["--workers", "0x"],
                          ["--workers", "-1"], ["--wrokers", "2"], ["--listen"], ["stray"]):
            with self.subTest(arguments=arguments):
                self.refused(*arguments)

    def test_a_state_folder_has_one_daemon(self):
        daemon = Daemon().start()
        try:
            self.refused("--listen", f"127.0.0.1:{free_port()}", folder=daemon.state)
            self.assertEqual(daemon.client().get("/healthz").status, 200)
        finally:
            self.assertEqual(daemon.close(), "")

    def test_a_port_in_use(self):
        daemon = Daemon().start()
        try:
            self.refused("--listen", f"127.0.0.1:{daemon.port}")
        finally:
            self.assertEqual(daemon.close(), "")


if __name__ == "__main__":
    unittest.main()
