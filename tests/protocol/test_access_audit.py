# SPDX-License-Identifier: Apache-2.0
"""The audit log: every change with who made it, before its answer; refusals, but not all of a flood."""
import datetime
import http.client
import os
import socket
import unittest

from access_harness import TokenTest, audit_lines, token_daemon, token_of
from talus_harness import PATIENCE, fake_scene, wait_for


class Changes(TokenTest):
    def test_who_did_what(self):
        bob = self.as_("bob")
        job = bob.submit({"seconds": 600})
        path = f"/v1/jobs/{job['id']}"
        bob.request("PATCH", path, {"priority": 3})
        self.as_("carol").post(path + "/cancel")
        self.client.post(path + "/cancel", x_forwarded_for="192.0.2.1")
        self.client.finish(job["id"])
        self.as_("alice").delete(path)
        bob.get("/v1/jobs")
        bob.post("/v1/forecast", {"scene": fake_scene()})
        bob.post("/v1/jobs", {"scene": 7})
        lines = audit_lines(self.daemon)
        told = [(line["who"], line["role"], line["method"], line["target"], line["status"],
                 line.get("job")) for line in lines]
        self.assertEqual(told[-6:], [
            ("bob", "submit", "POST", "/v1/jobs", 201, job["id"]),
            ("bob", "submit", "PATCH", path, 200, job["id"]),
            ("carol", "submit", "POST", path + "/cancel", 403, job["id"]),
            ("local", "admin", "POST", path + "/cancel", 200, job["id"]),
            ("alice", "admin", "DELETE", path, 204, job["id"]),
            ("bob", "submit", "POST", "/v1/jobs", 422, None)])
        for line in lines:
            self.assertEqual(line["from"], "127.0.0.1")
            at = datetime.datetime.fromisoformat(line["at"].replace("Z", "+00:00"))
            self.assertLess(abs(at.timestamp() - datetime.datetime.now().timestamp()), 3600)
        self.assertEqual(lines[-3]["forwarded_for"], "192.0.2.1")
        self.assertNotIn("uid", lines[-3])

    def test_no_secrets(self):
        self.client.get("/v1/jobs", authorization="Bearer hunter2-secret")
        self.client.get("/v1/jobs?token=hunter2-secret")
        self.as_("bob").request("DELETE", "/v1/jobs/x")
        wait_for(lambda: len([line for line in audit_lines(self.daemon)
                              if line["status"] in (400, 401)]) >= 2, 20, "the refusals' lines")
        with open(os.path.join(self.daemon.state, "audit.ndjson"), encoding="utf-8") as file:
            text = file.read()
        self.assertNotIn("secret", text)
        self.assertIn('"/v1/jobs/x"', text)
        mode = os.stat(os.path.join(self.daemon.state, "audit.ndjson")).st_mode
        self.assertEqual(mode & 0o007, 0)

    def test_hostile_bytes(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=20 * PATIENCE)
        connection.putrequest("DELETE", '/v1/jobs/a%22%c3%a9' + "y" * 3000)
        connection.putheader("X-Forwarded-For", b'\xff"\\ x')
        connection.endheaders()
        self.assertEqual(connection.getresponse().status, 404)
        connection.close()
        last = audit_lines(self.daemon)[-1]
        self.assertLessEqual(len(last["target"]), 512)
        self.assertEqual(last["forwarded_for"], "(not UTF-8)")


class Malformed(TokenTest):
    """Changes that are refused before any handler sees them are noted like others."""

    KIND = {"Content-Type": "application/json"}

    def told(self, who, count):
        """The lines of a name, when there are so many; those of refusals come within a second."""
        def lines():
            found = [line for line in audit_lines(self.daemon) if line["who"] == who]
            return found if len(found) >= count else None
        return wait_for(lines, 20, f"{count} lines of {who}")

    def test_refused_before_a_handler(self):
        bob = self.as_("bob")
        calls = [("POST", "/v1/jobs", "{", self.KIND, 400),
                 ("POST", "/v1/jobs", "{}", {"Content-Type": "text/plain"}, 415),
                 ("POST", "/v1/studies", "{}", {**self.KIND, "Content-Encoding": "gzip"}, 415),
                 ("DELETE", "/v1/jobs/abc?force=1", None, {}, 422),
                 ("PUT", "/v1/jobs", None, {}, 405),
                 ("POST", "/v1/nothing", None, {}, 404),
                 ("PATCH", "/v1/jobs/%zz", None, {}, 400),
                 ("POST", "/v1/jobs", " " * (17 << 20), self.KIND, 413)]
        for method, path, body, headers, status in calls:
            reply = bob.request(method, path, body, headers)
            self.assertEqual(reply.status, status, (method, path))
        bob.post("/v1/forecast", b"{}", content_type="text/plain")
        bob.get("/v1/jobs?nothing=1")
        bob.request("HEAD", "/v1/nothing")
        bob.delete("/v1/jobs/last")
        # Who calls is not looked at where the target itself makes no sense.
        known = [call for call in calls if call[1] != "/v1/jobs/%zz"]
        lines = self.told("bob", len(known) + 1)
        self.assertEqual(sorted((line["method"], line["target"], line["status"]) for line in lines),
                         sorted([(method, path.split("?")[0], status)
                                 for method, path, _, _, status in known]
                                + [("DELETE", "/v1/jobs/last", 404)]))
        self.assertEqual({line["role"] for line in lines}, {"submit"})
        self.assertEqual([line["job"] for line in lines if line["status"] == 422], ["abc"])
        nobody = self.told("", 1)
        self.assertEqual([(line["method"], line["target"], line["status"]) for line in nobody],
                         [("PATCH", "/v1/jobs/%zz", 400)])

    def test_a_body_that_grows(self):
        """Its length is not announced, so it is refused while it comes."""
        def pieces():
            for _ in range(17):
                yield b" " * (1 << 20)
        connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=20 * PATIENCE)
        headers = {**self.KIND, "Authorization": "Bearer " + token_of("carol")}
        connection.request("POST", "/v1/jobs", pieces(), headers, encode_chunked=True)
        self.assertEqual(connection.getresponse().status, 413)
        connection.close()
        line = self.told("carol", 1)[0]
        self.assertEqual((line["method"], line["target"], line["status"]),
                         ("POST", "/v1/jobs", 413))


class Refusals(TokenTest):
    access = {"require_token": True}

    def refusals(self):
        return [line for line in audit_lines(self.daemon) if line["status"] in (401, 403)]

    def test_a_flood_is_counted(self):
        """300 in far less than the 30 s that they would take at ten a second; on a machine so busy
        that it takes longer the lines still add up."""
        for _ in range(300):
            self.assertEqual(self.client.get("/v1/jobs").status, 401)
        self.assertEqual(self.as_("dave").post("/v1/jobs", {}).status, 403)

        def counted():
            lines = self.refusals()
            total = len(lines) + sum(line.get("suppressed", 0) for line in lines)
            # What is suppressed after the last line is told by the next one.
            self.assertEqual(self.client.get("/v1/jobs").status, 401)
            return lines if total >= 301 else None

        lines = wait_for(counted, 30, "all refusals", every=0.2)
        self.assertLess(len(lines), 301)
        self.assertEqual(lines[0]["who"], "")
        self.assertEqual(lines[0]["role"], "none")


class Crashes(unittest.TestCase):
    def daemon(self, config=None):
        daemon = token_daemon(config)
        self.addCleanup(lambda: self.assertEqual(daemon.close(), ""))
        return daemon

    def test_every_answered_change_survives_a_kill(self):
        daemon = self.daemon().start()
        bob = daemon.client(token=token_of("bob"))
        ids = [bob.submit({"seconds": 0})["id"] for _ in range(5)]
        daemon.kill()
        self.assertEqual([line["job"] for line in audit_lines(daemon)], ids)
        # A line that a power cut has torn is cut off.
        with open(os.path.join(daemon.state, "audit.ndjson"), "a", encoding="utf-8") as file:
            file.write('{"at": "2026-')
        daemon.start()
        ids.append(daemon.client(token=token_of("bob")).submit()["id"])
        self.assertEqual([line["job"] for line in audit_lines(daemon)], ids)

    def test_rotation(self):
        daemon = self.daemon({"audit_bytes": 65536, "audit_files": 2}).start()
        client = daemon.client(token=token_of("alice"))
        count = 0
        while len(audit_lines(daemon, 2)) == 0:
            self.assertEqual(client.delete(f"/v1/jobs/{count:06d}" + "z" * 400).status, 404)
            count += 1
            self.assertLess(count, 2000)
        first_kept = int(audit_lines(daemon, 2)[0]["job"][:6])
        self.assertEqual(first_kept, 0)
        numbers = [int(line["job"][:6]) for number in (2, 1, None)
                   for line in audit_lines(daemon, number)]
        self.assertEqual(numbers, list(range(count)))
        for _ in range(400):
            client.delete(f"/v1/jobs/{count:06d}" + "z" * 400)
            count += 1
        self.assertFalse(os.path.exists(os.path.join(daemon.state, "audit.ndjson.3")))
        numbers = [int(line["job"][:6]) for number in (2, 1, None)
                   for line in audit_lines(daemon, number)]
        self.assertEqual(numbers, list(range(numbers[0], count)))
        self.assertGreater(numbers[0], 0)

    def test_unix_socket_tells_the_user(self):
        daemon = self.daemon()
        path = os.path.join(daemon.folder, "s")
        daemon.start(listen=f"unix:{path}")
        with socket.socket(socket.AF_UNIX) as stream:
            stream.settimeout(20 * PATIENCE)
            stream.connect(path)
            stream.sendall(b"DELETE /v1/jobs/x HTTP/1.1\r\nHost: localhost\r\n"
                           b"Connection: close\r\n\r\n")
            self.assertEqual(int(stream.recv(200).split()[1]), 404)
        line = audit_lines(daemon)[-1]
        self.assertEqual((line["from"], line["who"], line["uid"]), ("unix", "local", os.getuid()))


if __name__ == "__main__":
    unittest.main()
