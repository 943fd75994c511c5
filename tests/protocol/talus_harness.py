# SPDX-License-Identifier: Apache-2.0
"""What every black-box test shares: a daemon in a throw-away state folder, a client, a scene.

The environment names the programs: TALUSD, TALUS_WORKER (the real one) and FAKE_WORKER. A test
never imports anything of Talus: it sees what a user sees, bytes over a socket and files.
"""
import hashlib
import http.client
import json
import os
import random
import shutil
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(os.path.dirname(HERE), "contract"))
import contract_proxy  # noqa: E402  (its folder is known only now)

ROOT = os.path.dirname(os.path.dirname(HERE))
FAKE_WORKER = os.path.join(ROOT, "tests", "faults", "fake_worker.py")
BUILD = os.environ.get("TALUS_BUILD", os.path.join(ROOT, "build", "release"))
TALUSD = os.environ.get("TALUSD", os.path.join(BUILD, "bin", "talusd"))
REAL_WORKER = os.environ.get("TALUS_WORKER", os.path.join(BUILD, "bin", "talus-worker"))
# Sanitizers slow the daemon down; every wait scales with this.
PATIENCE = float(os.environ.get("TALUS_PATIENCE", "1"))
FINAL = ("succeeded", "failed", "cancelled")


def wait_for(condition, seconds=10.0, what="condition", every=0.02):
    """Polls until condition() is true and returns its value; fails after `seconds`."""
    end = time.monotonic() + seconds * PATIENCE
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"not within {seconds * PATIENCE:g} s: {what}")
        time.sleep(every)


def free_port():
    """A port below the range that clients are given: one that is in it can be taken by a client
    while the daemon is down."""
    while True:
        port = random.randint(15000, 30000)
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
                return port
            except OSError:
                pass


class Reply:
    """An HTTP answer: status, headers (lower-case names) and body."""

    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def json(self):
        return json.loads(self.body)

    def __repr__(self):
        return f"{self.status} {self.headers} {self.body[:600]!r}"


class Client:
    """One keep-alive connection; not shared between threads."""

    def __init__(self, port, timeout=30.0, token=None):
        self.port, self.timeout, self.token = port, timeout * PATIENCE, token
        self.connection = None

    def close(self):
        if self.connection:
            self.connection.close()
            self.connection = None

    def request(self, method, path, body=None, headers=None):
        headers = dict(headers or {})
        if self.token is not None:
            headers.setdefault("Authorization", f"Bearer {self.token}")
        if body is not None and not isinstance(body, (bytes, str)):
            body = json.dumps(body)
            headers.setdefault("Content-Type", "application/json")
        if contract_proxy.takes(method, path, body, headers):
            status, fields, data = contract_proxy.request(self.port, method, path, body, headers,
                                                          self.timeout)
            return Reply(status, {name.lower(): value for name, value in fields}, data)
        fresh = self.connection is None
        while True:
            if self.connection is None:
                self.connection = http.client.HTTPConnection(
                    "127.0.0.1", self.port, timeout=self.timeout)
            try:
                self.connection.request(method, path, body=body, headers=headers)
                answer = self.connection.getresponse()
                data = answer.read()
                break
            except (http.client.RemoteDisconnected, BrokenPipeError, ConnectionResetError):
                # An idle keep-alive connection may be closed by the server at any time.
                self.close()
                if fresh or method not in ("GET", "HEAD"):
                    raise
                fresh = True
            except Exception:
                self.close()
                raise
        reply = Reply(answer.status, {k.lower(): v for k, v in answer.getheaders()}, data)
        contract_proxy.examine(method, path, reply.status, reply.headers, data)
        if reply.headers.get("connection", "").lower() == "close":
            self.close()
        return reply

    def get(self, path, **headers):
        return self.request("GET", path, headers=dash(headers))

    def post(self, path, body=None, **headers):
        return self.request("POST", path, body, dash(headers))

    def delete(self, path, **headers):
        return self.request("DELETE", path, headers=dash(headers))

    def job(self, job_id):
        reply = self.get(f"/v1/jobs/{job_id}")
        assert reply.status == 200, reply
        return reply.json()

    def step(self, job_id):
        """The step that the progress of a job tells; 0 before the first."""
        return (self.job(job_id).get("progress") or {}).get("step", 0)

    def submit(self, directive=None, **fields):
        """Posts a job for the fake worker and returns it (must be 201)."""
        headers = fields.pop("headers", {})
        reply = self.post("/v1/jobs", dict(fields, scene=fake_scene(directive)), **headers)
        assert reply.status == 201, reply
        return reply.json()

    def finish(self, job_id, seconds=30.0):
        """Waits until the job is final and returns it."""
        end = time.monotonic() + seconds * PATIENCE
        while True:
            reply = self.get(f"/v1/jobs/{job_id}?wait=5")
            assert reply.status == 200, reply
            job = reply.json()
            if job["state"] in FINAL:
                return job
            if time.monotonic() > end:
                raise AssertionError(f"not final: {job}")


def dash(headers):
    """if_none_match=... -> If-None-Match: ..."""
    return {name.replace("_", "-").title(): value for name, value in headers.items()}


def fake_scene(directive=None, **changes):
    """A valid scene whose title tells the fake worker what to do (see fake_worker.py)."""
    scene = {
        "title": "fake " + json.dumps(directive or {}, sort_keys=True),
        "dimension": "plane_strain",
        "duration": 1.0,
        "grid": {"cell": 0.1, "min": [0, 0], "max": [1, 1]},
        "materials": {"rubber": {"model": "linear_elastic", "density": 1000,
                                 "young_modulus": 1e5, "poisson_ratio": 0.3}},
        "bodies": [{"name": "block", "material": "rubber",
                    "box": {"min": [0.2, 0.2], "max": [0.6, 0.6]},
                    "particles_per_cell": [2, 2]}],
    }
    scene.update(changes)
    return scene


class Daemon:
    """A talusd on a loopback port. `side` is where the fake worker reports (ran.log, violations)."""

    def __init__(self, workers=2, real=False, config=None):
        self.folder = tempfile.mkdtemp(prefix="talus-test-")
        self.state = os.path.join(self.folder, "state")
        self.side = os.path.join(self.folder, "side")
        os.makedirs(self.side, exist_ok=True)
        self.log = os.path.join(self.folder, "talusd.log")
        self.port = free_port()
        self.workers = workers
        self.config = os.path.join(self.folder, "config.json")
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(dict({"stop_seconds": 2 * PATIENCE}, **(config or {})), file)
        self.program = REAL_WORKER if real else self.fake_program()
        self.process = None
        self.clients = []

    def fake_program(self):
        """A wrapper, so that the side folder does not depend on the environment of workers."""
        path = os.path.join(self.folder, "fake-worker")
        with open(path, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\nexec "{sys.executable}" -IS "{FAKE_WORKER}" "{self.side}" "$@"\n')
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        return path

    def start(self, wait=True, listen=None):
        """Returns when it is ready or, at another address than its loopback port, when it listens
        or has ended."""
        address = listen or f"127.0.0.1:{self.port}"
        command = [TALUSD, "--state", self.state, "--listen", address,
                   "--workers", str(self.workers), "--worker-program", self.program,
                   "--config", self.config]
        # What the address sanitizer keeps of freed memory would count as the daemon's.
        environment = dict(os.environ, ASAN_OPTIONS="quarantine_size_mb=4")
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                            env=environment, start_new_session=True)
        if listen:
            wait_for(lambda: "listening on" in self.tail() or self.process.poll() is not None, 30,
                     f"daemon up: {self.tail()}")
        elif wait:
            wait_for(self.answers, 30, f"daemon up: {self.tail()}")
        return self

    def answers(self):
        if self.process.poll() is not None:
            raise AssertionError(f"talusd ended with {self.process.returncode}: {self.tail()}")
        try:
            client = Client(self.port, 5)
            status = client.get("/readyz").status
            client.close()
            return status == 200
        except OSError:
            return False

    def client(self, timeout=30.0, token=None):
        client = Client(self.port, timeout, token)
        self.clients.append(client)
        return client

    def tail(self, size=4000):
        try:
            with open(self.log, "rb") as file:
                return file.read()[-size:].decode("utf-8", "replace")
        except OSError:
            return ""

    def kill(self):
        """kill -9 of the daemon alone: its workers go on."""
        self.process.kill()
        self.process.wait()

    def terminate(self, seconds=20):
        """SIGTERM; returns the exit code."""
        self.process.terminate()
        return self.process.wait(seconds * PATIENCE)

    def restart(self):
        if self.process.poll() is None:
            self.terminate()
        return self.start()

    def memory(self):
        """Resident bytes of the daemon."""
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def job_folder(self, job_id):
        for path, folders, _ in os.walk(self.state):
            if job_id in folders:
                return os.path.join(path, job_id)
        return None

    # ---- what the fake worker reports ----
    def runs(self):
        """[{"what": "start" or "end", "job", "attempt", "pid", "at"}] in order of writing."""
        try:
            with open(os.path.join(self.side, "ran.log"), encoding="utf-8") as file:
                return [json.loads(line) for line in file]
        except FileNotFoundError:
            return []

    def started(self, job_id):
        return [run for run in self.runs() if run["what"] == "start" and run["job"] == job_id]

    def violations(self):
        try:
            with open(os.path.join(self.side, "violations"), encoding="utf-8") as file:
                return file.read()
        except FileNotFoundError:
            return ""

    def switch(self, name, value="1"):
        """Switches a misbehaviour of the helper on (a file in the side folder)."""
        with open(os.path.join(self.side, name), "w", encoding="utf-8") as file:
            file.write(value)

    def switch_off(self, name):
        path = os.path.join(self.side, name)
        if os.path.exists(path):
            os.unlink(path)

    def live_workers(self):
        """Process ids of runs that have not ended."""
        live = {}
        for run in self.runs():
            live[run["pid"]] = run["what"] == "start"
        return [pid for pid, runs in live.items() if runs and pid in self.stray_workers()]

    def stray_workers(self):
        """Process ids of workers that this daemon's program left behind."""
        found = []
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{pid}/cmdline", "rb") as file:
                    words = file.read().split(b"\0")
            except OSError:
                continue
            if self.state.encode() in b" ".join(words) or self.side.encode() in words:
                if int(pid) != self.process.pid:
                    found.append(int(pid))
        return found

    def close(self):
        """Stops everything; returns what is wrong with the way it ended ('' if nothing)."""
        complaints = []
        for client in self.clients:
            client.close()
        if self.process and self.process.poll() is None:
            try:
                code = self.terminate()
                if code != 0:
                    complaints.append(f"talusd exit code {code}")
            except subprocess.TimeoutExpired:
                complaints.append("talusd did not end within 20 s of SIGTERM")
                self.kill()
        for pid in self.stray_workers():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        log = self.tail(1 << 20)
        for word in ("AddressSanitizer", "LeakSanitizer", "runtime error:", "Assertion"):
            if word in log:
                complaints.append(f"{word} in the log of talusd:\n{log[-6000:]}")
                break
        if self.violations():
            complaints.append("worker: " + self.violations())
        if not os.environ.get("TALUS_KEEP"):
            shutil.rmtree(self.folder, ignore_errors=True)
        return "\n".join(complaints)


class DaemonTest(unittest.TestCase):
    """A test class with one daemon for all its tests."""
    workers = 2
    real = False
    config = None

    @classmethod
    def setUpClass(cls):
        cls.daemon = Daemon(cls.workers, cls.real, cls.config)
        cls.addClassCleanup(cls.close_daemon)
        cls.daemon.start()

    @classmethod
    def close_daemon(cls):
        complaints = cls.daemon.close()
        if complaints:
            raise AssertionError(complaints)

    def setUp(self):
        self.client = self.daemon.client()

    def tearDown(self):
        self.client.close()
        self.assertIsNone(self.daemon.process.poll(), f"talusd died: {self.daemon.tail()}")

    def assert_problem(self, reply, status, code=None, pointer=None):
        """The answer is RFC 9457 and names code and pointer, if given; returns its JSON."""
        self.assertEqual(reply.status, status, reply)
        self.assertEqual(reply.headers["content-type"].split(";")[0], "application/problem+json")
        problem = reply.json()
        for key in ("type", "title", "status", "detail", "instance"):
            self.assertIn(key, problem)
        self.assertEqual(problem["status"], status)
        self.assertTrue(problem["title"] and isinstance(problem["title"], str))
        errors = problem.get("errors", [])
        self.assertLessEqual(len(errors), 50)
        for error in errors:
            self.assertTrue(error["pointer"] == "" or error["pointer"].startswith("/"), error)
            self.assertTrue(error["code"] and error["detail"], error)
        if pointer is not None:
            self.assertIn(pointer, [error["pointer"] for error in errors], problem)
        if code is not None:
            self.assertIn(code, [e["code"] for e in errors
                                 if pointer is None or e["pointer"] == pointer], problem)
        return problem


def sha256(data):
    return hashlib.sha256(data).hexdigest()
