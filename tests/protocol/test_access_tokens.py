# SPDX-License-Identifier: Apache-2.0
"""Tokens and roles: who may do what, and that a token taken away stops at once."""
import http.client
import json
import os
import subprocess
import threading
import unittest

from access_harness import (TOKENS, TokenTest, audit_lines, reload, token_daemon, token_lines,
                            token_of, write_tokens)
from sse_reader import Stream
from talus_harness import PATIENCE, TALUSD, DaemonTest, fake_scene, free_port, wait_for


class Local(DaemonTest):
    """Loopback without a token file: everyone is a local user."""

    def test_everything_is_allowed(self):
        job = self.client.submit()
        self.assertEqual(job["owner"], "")
        self.client.finish(job["id"])
        self.assertEqual(self.client.delete(f"/v1/jobs/{job['id']}").status, 204)

    def test_a_token_that_is_sent_must_be_valid(self):
        reply = self.client.get("/v1/jobs", authorization="Bearer nothing")
        problem = self.assert_problem(reply, 401)
        self.assertEqual(problem["type"], "urn:talus:problem:token_invalid")
        self.assertIn("Bearer", reply.headers["www-authenticate"])

    def test_other_schemes_are_for_others(self):
        self.assertEqual(self.client.get("/v1/jobs", authorization="Basic YTpi").status, 200)


class Optional(TokenTest):
    """Loopback with a token file: a token names its user, no token is a local user."""

    def test_owner(self):
        self.assertEqual(self.as_("bob").submit()["owner"], "bob")
        self.assertEqual(self.as_(None).submit()["owner"], "")

    def test_wrong_tokens(self):
        for value in ("Bearer wrong", "Bearer", "Bearer ", "bearer x" * 300, "Bearer a b",
                      "Bearer " + token_of("bob") + "x", "Bearer \u00e9"):
            with self.subTest(value=value[:40]):
                reply = self.client.get("/v1/jobs", authorization=value.encode("latin-1"))
                self.assert_problem(reply, 401)
                self.assertNotIn(b"secret", reply.body)

    def test_scheme_in_any_case(self):
        for scheme in ("bearer", "BEARER"):
            reply = self.client.get("/v1/jobs", authorization=f"{scheme}  {token_of('dave')}")
            self.assertEqual(reply.status, 200, reply)

    def test_roles_hold(self):
        reply = self.as_("dave").post("/v1/jobs", {"scene": fake_scene()})
        self.assert_problem(reply, 403)

    def test_two_tokens_are_refused(self):
        raw = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=20 * PATIENCE)
        raw.putrequest("GET", "/v1/jobs")
        for name in ("alice", "dave"):
            raw.putheader("Authorization", f"Bearer {token_of(name)}")
        raw.endheaders()
        self.assertEqual(raw.getresponse().status, 400)
        raw.close()


class Required(TokenTest):
    """Behind a proxy: nothing but liveness and readiness without a token."""
    access = {"require_token": True}

    def test_without_a_token(self):
        for path in ("/v1/jobs", "/v1/version", "/v1/schema/scene", "/v1/jobs/x", "/nothing"):
            with self.subTest(path=path):
                reply = self.client.get(path)
                problem = self.assert_problem(reply, 401)
                self.assertEqual(problem["type"], "urn:talus:problem:token_missing")
                self.assertEqual(reply.headers["www-authenticate"], 'Bearer realm="talusd"')
        self.assert_problem(self.client.post("/v1/jobs", {"scene": fake_scene()}), 401)
        for path in ("/healthz", "/readyz"):
            self.assertEqual(self.client.get(path).status, 200)

    def test_missing_paths_are_missing_for_those_who_may_know(self):
        self.assert_problem(self.as_("dave").get("/nothing"), 404)
        self.assert_problem(self.as_("dave").request("PUT", "/v1/jobs"), 405)

    def test_never_in_a_url(self):
        for query in (f"token={token_of('alice')}", f"access_token={token_of('alice')}",
                      f"limit=1&Access%5FToken={token_of('alice')}"):
            for client in (self.client, self.as_("alice")):
                reply = client.get(f"/v1/jobs?{query}".replace("~+/=", ""))
                problem = self.assert_problem(reply, 400)
                self.assertEqual(problem["type"], "urn:talus:problem:token_in_url")
                self.assertNotIn(b"secret", reply.body)
        self.assertNotIn("secret", self.daemon.tail())

    def test_read(self):
        job = self.as_("bob").submit({"steps": 5})
        bob, dave = self.as_("bob"), self.as_("dave")
        bob.finish(job["id"])
        for path in ("/v1/jobs", f"/v1/jobs/{job['id']}", f"/v1/jobs/{job['id']}/files",
                     f"/v1/jobs/{job['id']}/series", "/v1/version"):
            with self.subTest(path=path):
                self.assertEqual(dave.get(path).status, 200)
                self.assertEqual(dave.request("HEAD", path).status, 200)
        path = f"/v1/jobs/{job['id']}"
        for method, target, body in (("POST", "/v1/jobs", {"scene": fake_scene()}),
                                     ("POST", "/v1/forecast", {"scene": fake_scene()}),
                                     ("PATCH", path, {"priority": 1}),
                                     ("POST", path + "/cancel", None),
                                     ("POST", path + "/resume", None), ("DELETE", path, None)):
            with self.subTest(method=method, target=target):
                reply = dave.request(method, target, body)
                problem = self.assert_problem(reply, 403)
                self.assertEqual(problem["type"], "urn:talus:problem:role")
                self.assertIn("insufficient_scope", reply.headers["www-authenticate"])
        self.assertEqual(bob.get(path).status, 200)

    def test_submit_changes_its_own_jobs_only(self):
        bob, carol, alice = (self.as_(name) for name in ("bob", "carol", "alice"))
        self.assertEqual(bob.post("/v1/forecast", {"scene": fake_scene()}).status, 200)
        job = bob.submit({"seconds": 600})
        path = f"/v1/jobs/{job['id']}"
        for method, target, body in (("PATCH", path, {"priority": 1}),
                                     ("POST", path + "/cancel", None),
                                     ("POST", path + "/resume", None), ("DELETE", path, None)):
            with self.subTest(method=method, target=target):
                problem = self.assert_problem(carol.request(method, target, body), 403)
                self.assertEqual(problem["type"], "urn:talus:problem:owner")
        self.assertEqual(carol.get(path).status, 200)
        self.assertEqual(bob.request("PATCH", path, {"priority": 1}).status, 200)
        self.assertEqual(bob.post(path + "/cancel").status, 200)
        bob.finish(job["id"])
        self.assertEqual(bob.post(path + "/resume").status, 200)
        self.assertEqual(alice.post(path + "/cancel").status, 200)
        alice.finish(job["id"])
        self.assertEqual(bob.delete(path).status, 204)
        self.assert_problem(carol.post("/v1/jobs/no-such-job/cancel"), 404)

    def test_studies_belong_to_a_token(self):
        bob, carol, alice = (self.as_(name) for name in ("bob", "carol", "alice"))
        design = {"list": {"rows": [{"/duration": 1}, {"/duration": 2}]}}
        body = {"name": "x", "scene": fake_scene({"seconds": 600}), "design": design,
                "metrics": ["wall_seconds"], "reuse": False}
        self.assert_problem(self.as_("dave").post("/v1/studies", body), 403)
        reply = bob.post("/v1/studies", body)
        self.assertEqual(reply.status, 201, reply)
        path = f"/v1/studies/{reply.json()['id']}"
        for method, target in (("POST", path + "/cancel"), ("DELETE", path)):
            problem = self.assert_problem(carol.request(method, target), 403)
            self.assertEqual(problem["type"], "urn:talus:problem:owner")
        self.assertEqual(self.as_("dave").get(path + "/results").status, 200)
        self.assert_problem(carol.post("/v1/studies/no-such-study/cancel"), 404)
        self.assertEqual(bob.post(path + "/cancel").status, 200)
        wait_for(lambda: alice.get(path).json()["state"] == "cancelled", 60, "the study's end")
        self.assertEqual(alice.delete(path).status, 204)
        told = [(line["who"], line["method"], line["status"]) for line in audit_lines(self.daemon)
                if line.get("study") == reply.json()["id"]]
        self.assertEqual(told, [("bob", "POST", 201), ("carol", "POST", 403),
                                ("carol", "DELETE", 403), ("bob", "POST", 200),
                                ("alice", "DELETE", 204)])

    def test_idempotency_keys_belong_to_a_token(self):
        body = {"scene": fake_scene({"steps": 3})}
        replies = [self.as_(name).post("/v1/jobs", body, idempotency_key="same")
                   for name in ("bob", "carol", "bob")]
        self.assertEqual([reply.status for reply in replies], [201, 201, 201])
        ids = [reply.json()["id"] for reply in replies]
        self.assertEqual(ids[0], ids[2])
        self.assertNotEqual(ids[0], ids[1])

    def test_a_large_body_without_a_token(self):
        """The answer comes, and nothing of the body is kept."""
        reply = self.client.request("POST", "/v1/jobs", b'"' + b"x" * (4 << 20) + b'"',
                                    {"Content-Type": "application/json"})
        self.assert_problem(reply, 401)


class Reload(unittest.TestCase):
    def setUp(self):
        self.daemon = token_daemon({"require_token": True}).start()
        self.addCleanup(lambda: self.assertEqual(self.daemon.close(), ""))

    def client(self, name):
        return self.daemon.client(token=token_of(name))

    def test_revoked_and_new(self):
        bob = self.client("bob")
        job = bob.submit({"seconds": 600})
        self.assertEqual(bob.get("/v1/jobs").status, 200)
        roles = {name: role for name, role in TOKENS.items() if name != "bob"}
        write_tokens(self.daemon.tokens, token_lines(dict(roles, erin="submit", dave="submit")))
        self.assertEqual(self.client("erin").get("/v1/jobs").status, 401)
        reload(self.daemon)
        self.assertEqual(bob.get("/v1/jobs").status, 401)
        self.assertEqual(self.client("erin").get("/v1/jobs").status, 200)
        self.assertEqual(self.client("dave").submit()["owner"], "dave")
        self.assertEqual(self.client("alice").job(job["id"])["owner"], "bob")
        self.assertIn("reload", [line.get("action") for line in audit_lines(self.daemon)])

    def test_streams_of_a_revoked_token_end(self):
        job = self.client("bob").submit({"seconds": 600})
        begun, ended = set(), {}
        threads = [threading.Thread(target=self.follow, args=(job["id"], name, begun, ended),
                                    daemon=True) for name in ("bob", "alice")]
        for thread in threads:
            thread.start()
        wait_for(lambda: begun == {"bob", "alice"}, 20, "both streams")
        write_tokens(self.daemon.tokens, token_lines({"alice": "admin"}))
        reload(self.daemon)
        wait_for(lambda: "bob" in ended, 20, "the end of the stream of the revoked token")
        self.assertNotIn("done", ended["bob"])
        self.assertNotIn("alice", ended)
        self.assertEqual(self.client("alice").post(f"/v1/jobs/{job['id']}/cancel").status, 200)
        wait_for(lambda: "alice" in ended, 20, "the end of the job's story")
        self.assertIn("done", ended["alice"])

    def follow(self, job_id, name, begun, ended):
        seen = []
        path = f"/v1/jobs/{job_id}/events"
        with Stream(self.daemon.port, path, token=token_of(name), timeout=60) as stream:
            for event in stream:
                seen.append(event.name)
                begun.add(name)
        if stream.ended:
            ended[name] = seen

    def test_a_broken_file_changes_nothing(self):
        write_tokens(self.daemon.tokens, token_lines({"alice": "admin"}) + "bob:boss:x\nsecret\n")
        reload(self.daemon)
        self.assertEqual(self.client("bob").get("/v1/jobs").status, 200)
        log = self.daemon.tail()
        self.assertIn("line 2: the roles are", log)
        self.assertIn("line 3: NAME:ROLE:SHA256", log)
        self.assertNotIn("secret", log)
        self.assertIn("token", self.daemon.client().get("/readyz").json()["warnings"][0])
        self.assertEqual(self.metrics(), {"talus_tokens": 4, "talus_tokens_stale": 1})
        self.assertEqual([line["outcome"] for line in audit_lines(self.daemon)
                          if line.get("action") == "reload"], ["kept"])
        write_tokens(self.daemon.tokens, token_lines({"alice": "admin"}))
        reload(self.daemon)
        self.assertEqual(self.daemon.client().get("/readyz").json()["warnings"], [])
        self.assertEqual(self.metrics(), {"talus_tokens": 1, "talus_tokens_stale": 0})
        self.assertEqual(self.client("bob").get("/v1/jobs").status, 401)

    def metrics(self):
        """What /metrics says of tokens."""
        lines = self.client("alice").get("/metrics").body.decode().splitlines()
        return {name: float(value) for name, value in (line.split() for line in lines
                                                       if line.startswith("talus_tokens"))}

    def test_reloads_under_load(self):
        """Requests by a token that stays never fail while others come and go."""
        stop, wrong = threading.Event(), []

        def ask():
            client = self.client("alice")
            while not stop.is_set():
                status = client.get("/v1/jobs?limit=1").status
                if status != 200:
                    wrong.append(status)

        threads = [threading.Thread(target=ask) for _ in range(2)]
        for thread in threads:
            thread.start()
        try:
            for count in range(10):
                write_tokens(self.daemon.tokens,
                             token_lines(dict({"alice": "admin"}, **{f"n{count}": "read"})))
                reload(self.daemon)
        finally:
            stop.set()
            for thread in threads:
                thread.join()
        self.assertEqual(wrong, [])


class Starting(unittest.TestCase):
    """What the daemon says before it serves, and that it refuses what is not safe."""

    def setUp(self):
        self.daemon = token_daemon()
        self.addCleanup(lambda: self.assertEqual(self.daemon.close(), ""))

    def run_refused(self, *arguments, **config):
        path = os.path.join(self.daemon.folder, "refused.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(config, file)
        process = subprocess.run(
            [TALUSD, "--state", self.daemon.state, "--worker-program", self.daemon.program,
             "--config", path, *arguments], capture_output=True, timeout=30 * PATIENCE, text=True,
            check=False)
        self.assertEqual(process.returncode, 2, process)
        return process.stderr

    def test_refused_configurations(self):
        local = ["--listen", f"127.0.0.1:{free_port()}"]
        everywhere = ["--listen", f"0.0.0.0:{free_port()}"]
        self.assertIn("--tokens", self.run_refused(*everywhere))
        self.assertIn("--tokens", self.run_refused("--listen", f"[::]:{free_port()}"))
        self.assertIn("--tokens", self.run_refused(*local, require_token=True))
        for key, value in (("require_token", 1), ("hosts", "talus.example"),
                           ("hosts", ["https://talus.example"]), ("hosts", ["talus.example:443"]),
                           ("hosts", ["*"]), ("hosts", [""]), ("cors_origins", ["*"]),
                           ("cors_origins", ["null"]), ("cors_origins", ["https://page.example/"]),
                           ("cors_origins", ["page.example"]), ("cors_origins", [7]),
                           ("tokens", 7)):
            with self.subTest(key=key, value=value):
                self.assertIn(key, self.run_refused(*local, **{key: value}))
        write_tokens(self.daemon.tokens, "alice\n\nbob:read\n")
        said = self.run_refused(*local, "--tokens", self.daemon.tokens)
        self.assertIn("line 1:", said)
        self.assertIn("line 3:", said)

    def test_beyond_loopback(self):
        port = self.daemon.port
        os.chmod(self.daemon.tokens, 0o644)
        with open(self.daemon.log, "ab") as log:
            self.daemon.process = subprocess.Popen(
                [TALUSD, "--state", self.daemon.state, "--listen", f"0.0.0.0:{port}",
                 "--worker-program", self.daemon.program, "--tokens", self.daemon.tokens],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        wait_for(self.daemon.answers, 30, "daemon up")
        self.assertEqual(self.daemon.client().get("/v1/version").status, 401)
        alice = self.daemon.client(token=token_of("alice"))
        for host in ("talus.example", f"10.0.0.7:{port}"):
            self.assertEqual(alice.get("/v1/version", host=host).status, 200)
        for host in ("a b", "[", "]", "[]", "[x]", ":", "a:b", "x" * 300):
            self.assertEqual(alice.get("/v1/version", host=host).status, 403, host)
        log = self.daemon.tail()
        self.assertIn("everyone can read the token file", log)
        self.assertIn("plain HTTP beyond this machine", log)

    def test_the_documented_way_to_make_a_token(self):
        """The commands of the documentation, as they stand there."""
        documentation = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "access.md")
        with open(documentation, encoding="utf-8") as file:
            block = file.read().split("```sh make-a-token\n")[1].split("```")[0]
        script = block.replace("/etc/talus", self.daemon.folder)
        made = subprocess.run(["bash", "-euc", script], capture_output=True, text=True, check=True,
                              timeout=30 * PATIENCE, cwd=self.daemon.folder,
                              env=dict(os.environ, HOME=self.daemon.folder))
        self.assertEqual(made.stdout, "")
        with open(os.path.join(self.daemon.folder, ".config/talus/token"), encoding="utf-8") as file:
            token = file.read().strip()
        self.daemon.start()
        client = self.daemon.client(token=token)
        self.assertEqual(client.submit()["owner"], "frank")


if __name__ == "__main__":
    unittest.main()
