# SPDX-License-Identifier: Apache-2.0
"""The files of deploy/ for nginx, Caddy and systemd, as they stand but for ports, certificate and
paths: TLS and tokens, event streams that arrive at once, ranges, sizes, long polls.

Needs nginx and caddy (deploy/install-dependencies.sh --checks). Without them it is skipped with the
exit code 77, and fails where TALUS_PROXIES=required."""
import http.client
import json
import os
import re
import shutil
import socket
import ssl
import subprocess
import sys
import unittest

from access_harness import audit_lines, token_daemon, token_of
from sse_reader import Stream
from talus_harness import PATIENCE, ROOT, Client, fake_scene, free_port, wait_for

DEPLOY = os.path.join(ROOT, "deploy")
NAME = "talus.example.org"
SEARCH = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
PROGRAMS = {name: shutil.which(name, path=SEARCH) for name in ("nginx", "caddy")}
REQUIRED = os.environ.get("TALUS_PROXIES") == "required"


def deploy_text(name):
    with open(os.path.join(DEPLOY, name), encoding="utf-8") as file:
        return file.read()


def substitute(text, pattern, replacement):
    """Replaces what must be there."""
    changed, count = re.subn(pattern, lambda _: replacement, text, flags=re.MULTILINE)
    assert count > 0, f"{pattern} is not in\n{text}"
    return changed


class TlsConnection(http.client.HTTPSConnection):
    """Speaks to this machine and asks for the proxy's name."""

    def __init__(self, port, context, timeout):
        super().__init__(NAME, port, timeout=timeout, context=context)
        self.tls = context

    def connect(self):
        plain = socket.create_connection(("127.0.0.1", self.port), self.timeout)
        self.sock = self.tls.wrap_socket(plain, server_hostname=NAME)


class TlsClient(Client):
    def __init__(self, port, context, token=None):
        super().__init__(port, token=token)
        self.context = context

    def request(self, *arguments, **options):
        if self.connection is None:
            self.connection = TlsConnection(self.port, self.context, self.timeout)
        return super().request(*arguments, **options)


class TlsStream(Stream):
    """An event stream through the proxy."""

    def __init__(self, port, path, context, token):
        self.context = context
        super().__init__(port, path, token=token, timeout=60, host=f"{NAME}:{port}")

    def wrap(self, plain):
        return self.context.wrap_socket(plain, server_hostname=NAME)


class Proxy:
    """What every proxy must do; a subclass starts one."""
    program = None

    @classmethod
    def setUpClass(cls):
        if PROGRAMS[cls.program] is None:
            raise unittest.SkipTest(f"{cls.program} is not installed")
        config = json.loads(deploy_text("talusd.json"))
        cls.daemon = token_daemon(config)
        cls.proxy = None
        cls.addClassCleanup(cls.close_all)
        cls.folder = os.path.join(cls.daemon.folder, "proxy")
        os.mkdir(cls.folder)
        cls.port = free_port()
        cls.certificate, cls.key = (os.path.join(cls.folder, name) for name in ("c.pem", "k.pem"))
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                        "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2", "-subj", f"/CN={NAME}",
                        "-addext", f"subjectAltName=DNS:{NAME}", "-keyout", cls.key, "-out",
                        cls.certificate], check=True, capture_output=True, timeout=60 * PATIENCE)
        cls.context = ssl.create_default_context(cafile=cls.certificate)
        cls.daemon.start()
        command, environment = cls.prepare()
        cls.log = os.path.join(cls.folder, "log")
        with open(cls.log, "wb") as log:
            cls.proxy = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                         env=environment)
        wait_for(cls.answers, 30, f"{cls.program} up")

    @classmethod
    def answers(cls):
        if cls.proxy.poll() is not None:
            with open(cls.log, encoding="utf-8", errors="replace") as log:
                raise AssertionError(f"{cls.program} ended: {log.read()[-3000:]}")
        client = TlsClient(cls.port, cls.context)
        try:
            return client.get("/healthz").status == 200
        except OSError:
            return False
        finally:
            client.close()

    @classmethod
    def close_all(cls):
        if cls.proxy is not None:
            cls.proxy.terminate()
            cls.proxy.wait(30 * PATIENCE)
        complaints = cls.daemon.close()
        if complaints:
            raise AssertionError(complaints)

    def client(self, name=None):
        client = TlsClient(self.port, self.context, None if name is None else token_of(name))
        self.addCleanup(client.close)
        return client

    def test_tokens(self):
        bob = self.client("bob")
        job = bob.submit({"steps": 3}, headers={"x_forwarded_for": "198.51.100.9"})
        self.assertEqual(job["owner"], "bob")
        line = next(line for line in audit_lines(self.daemon) if line.get("job") == job["id"])
        self.assertEqual((line["who"], line["from"]), ("bob", "127.0.0.1"))
        self.assertEqual(line["forwarded_for"], "127.0.0.1")
        refused = self.client().get("/v1/jobs")
        self.assertEqual(refused.status, 401)
        self.assertEqual(refused.headers["www-authenticate"], 'Bearer realm="talusd"')
        self.assertEqual(refused.headers["content-type"], "application/problem+json")
        self.assertEqual(refused.json()["type"], "urn:talus:problem:token_missing")
        self.assertEqual(self.client("dave").delete(f"/v1/jobs/{job['id']}").status, 403)

    def test_pages_of_the_proxy(self):
        bob = self.client("bob")
        self.assertEqual(bob.get("/v1/version", origin=f"https://{NAME}:{self.port}").status, 200)
        self.assertEqual(bob.get("/v1/version", origin="https://evil.example").status, 403)

    def test_events_arrive_at_once(self):
        """The run goes on for minutes, so its events can only come through a proxy that holds none
        back; the end of the story comes when it is cancelled."""
        job = self.client("bob").submit({"seconds": 600, "rows": 600})
        path = f"/v1/jobs/{job['id']}"
        names = []
        with TlsStream(self.port, path + "/events", self.context, token_of("bob")) as stream:
            for event in stream:
                names.append(event.name)
                if len(names) == 3:
                    self.assertNotIn("done", names)
                    self.assertEqual(self.client("bob").job(job["id"])["state"], "running")
                    self.assertEqual(self.client("bob").post(path + "/cancel").status, 200)
        self.assertEqual(stream.status, 200)
        self.assertEqual(names[-1], "done")
        self.assertTrue(stream.ended)

    def test_ranges(self):
        bob = self.client("bob")
        job = bob.submit({"steps": 3})
        bob.finish(job["id"])
        path = f"/v1/jobs/{job['id']}/files/scene.json"
        whole = bob.get(path)
        part = bob.get(path, range="bytes=10-29", if_range=whole.headers["etag"])
        self.assertEqual((part.status, part.body), (206, whole.body[10:30]))
        self.assertEqual(part.headers["content-range"], f"bytes 10-29/{len(whole.body)}")
        head = bob.request("HEAD", path)
        self.assertEqual((head.status, int(head.headers["content-length"])), (200, len(whole.body)))
        self.assertEqual(bob.get(path, if_none_match=whole.headers["etag"]).status, 304)

    def test_long_polls(self):
        bob = self.client("bob")
        job = bob.submit({"seconds": 600})
        path = f"/v1/jobs/{job['id']}"
        self.assertEqual(bob.get(path + "?wait=2").json()["id"], job["id"])
        self.assertEqual(bob.post(path + "/cancel").status, 200)
        self.assertEqual(bob.finish(job["id"])["state"], "cancelled")

    def test_sizes(self):
        """Beyond the proxy's own limit of 1 MiB, and beyond the daemon's of 16 MiB."""
        bob = self.client("bob")
        padded = json.dumps({"scene": fake_scene()}).encode() + b" " * (4 << 20)
        kind = {"Content-Type": "application/json"}
        self.assertEqual(bob.request("POST", "/v1/jobs", padded, kind).status, 201)
        status, answer = self.send_large(b" " * (17 << 20))
        self.assertEqual(status, 413)
        self.assertEqual(answer["type"], "urn:talus:problem:too_large")

    def send_large(self, body):
        """A server may answer and close before all is sent; only a plain client reads that answer."""
        data = os.path.join(self.folder, "large")
        with open(data, "wb") as file:
            file.write(body)
        done = self.curl("--http1.1", "--data-binary", f"@{data}", "--header",
                         "Content-Type: application/json", "/v1/jobs")
        return int(done[-1]), json.loads(done[0])

    def curl(self, *arguments):
        """[body, version, status]; the token does not stand on the command line."""
        *options, path = arguments
        done = subprocess.run(
            ["curl", "--silent", "--noproxy", "*", "--cacert", self.certificate, "--resolve",
             f"{NAME}:{self.port}:127.0.0.1", "--config", "-", "--write-out",
             "\n%{http_version}\n%{http_code}", *options, f"https://{NAME}:{self.port}{path}"],
            input=f'header = "Authorization: Bearer {token_of("bob")}"\n', capture_output=True,
            text=True, timeout=60 * PATIENCE, check=False)
        return done.stdout.rsplit("\n", 2)

    def test_second_version(self):
        body, version, status = self.curl("--http2", "/v1/version")
        self.assertEqual((version, status), ("2", "200"))
        self.assertEqual(json.loads(body)["name"], "talus")

    def test_the_daemon_is_away(self):
        self.daemon.terminate()
        try:
            reply = self.client("bob").get("/v1/jobs")
            self.assertEqual(reply.status, 503, reply)
            self.assertEqual(reply.headers["content-type"], "application/problem+json")
            self.assertEqual(reply.headers["retry-after"], "5")
            self.assertEqual(reply.json()["type"], "urn:talus:problem:unreachable")
        finally:
            self.daemon.start()
        wait_for(lambda: self.client("bob").get("/v1/jobs").status == 200, 60, "the daemon again")


class Nginx(Proxy, unittest.TestCase):
    program = "nginx"

    @classmethod
    def prepare(cls):
        text = deploy_text("nginx.conf")
        text = substitute(text, r"127\.0\.0\.1:8465", f"127.0.0.1:{cls.daemon.port}")
        text = substitute(text, r"listen 443 ssl", f"listen 127.0.0.1:{cls.port} ssl")
        text = substitute(text, r"^ *listen \[::\]:443 .*$", "")
        text = substitute(text, r"/etc/ssl/talus/certificate\.pem", cls.certificate)
        text = substitute(text, r"/etc/ssl/talus/key\.pem", cls.key)
        site, whole = (os.path.join(cls.folder, name) for name in ("talus.conf", "nginx.conf"))
        with open(site, "w", encoding="utf-8") as file:
            file.write(text)
        places = "".join(f"{kind}_temp_path {cls.folder}/{kind};\n" for kind in (
            "client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        user = "user root;\n" if os.getuid() == 0 else ""
        with open(whole, "w", encoding="utf-8") as file:
            file.write(f"{user}daemon off;\npid {cls.folder}/pid;\nerror_log stderr;\nevents {{}}\n"
                       f"http {{\naccess_log off;\n{places}include {site};\n}}\n")
        return [PROGRAMS["nginx"], "-p", cls.folder, "-c", whole, "-e", "stderr"], dict(os.environ)


class Caddy(Proxy, unittest.TestCase):
    program = "caddy"

    @classmethod
    def prepare(cls):
        text = deploy_text("Caddyfile")
        text = substitute(text, r"127\.0\.0\.1:8465", f"127.0.0.1:{cls.daemon.port}")
        text = substitute(text, rf"^{re.escape(NAME)} \{{$",
                          "{\n\tadmin off\n\tauto_https disable_redirects\n}\n\n"
                          f"https://{NAME}:{cls.port} {{\n\tbind 127.0.0.1\n"
                          f"\ttls {cls.certificate} {cls.key}")
        path = os.path.join(cls.folder, "Caddyfile")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return ([PROGRAMS["caddy"], "run", "--config", path, "--adapter", "caddyfile"],
                dict(os.environ, XDG_DATA_HOME=cls.folder, XDG_CONFIG_HOME=cls.folder,
                     HOME=cls.folder))


class Systemd(unittest.TestCase):
    """The unit is one that systemd takes, and closes what it can."""

    def test_unit(self):
        analyze = shutil.which("systemd-analyze", path=SEARCH)
        if analyze is None:
            self.skipTest("systemd-analyze is not installed")
        text = deploy_text("talusd.service")
        self.assertIn("ExecReload=kill -HUP $MAINPID", text)
        daemon = token_daemon()
        self.addCleanup(daemon.close)
        path = os.path.join(daemon.folder, "talusd.service")
        with open(path, "w", encoding="utf-8") as file:
            file.write(substitute(text, r"/usr/local/bin/talusd", daemon.program))
        done = subprocess.run([analyze, "verify", path], capture_output=True, text=True, check=False,
                              timeout=60 * PATIENCE)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # 10 is wide open; systemd's own word for less than 2.5 is OK.
        done = subprocess.run([analyze, "security", "--offline=true", "--threshold=25", path],
                              capture_output=True, text=True, check=False, timeout=60 * PATIENCE)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])


if __name__ == "__main__":
    absent = [name for name, path in PROGRAMS.items() if path is None]
    if absent and REQUIRED:
        sys.exit(f"not installed: {', '.join(absent)} (deploy/install-dependencies.sh --checks)")
    if len(absent) == len(PROGRAMS):
        print("SKIPPED: nginx and caddy are not installed (deploy/install-dependencies.sh --checks)")
        sys.exit(77)
    unittest.main()
