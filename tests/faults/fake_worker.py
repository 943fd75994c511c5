#!/usr/bin/python3 -IS
# SPDX-License-Identifier: Apache-2.0
"""A worker without physics that speaks the worker protocol (solver/base/protocol.h).

usage: fake_worker.py SIDE run SCENE --out DIR --threads N --attempt A [--resume]
       fake_worker.py SIDE helper

SIDE is a folder in which it reports to the test: `ran.log` (one line at the start and one at the
end of every run, so that double and overlapping runs show) and `violations` (whatever the daemon
did that the protocol forbids). Files in SIDE called `helper-...` switch misbehaviour of the helper
on. The scene's title, "fake {JSON}", says what a run does; see DIRECTIVE.
"""
import fcntl
import hashlib
import json
import os
import signal
import struct
import sys
import time

DIRECTIVE = {
    "seconds": 0.05,       # wall-clock length of a whole run
    "rows": 20,            # rows of history (beyond row 0)
    "frames": 2,           # frames (beyond frame 0)
    "checkpoint": 5,       # a checkpoint every so many rows; 0: none
    "flush": 1,            # a history line every so many rows
    "crash": None,         # {"row": R, "signal": S, "attempts": [1]}: dies by a signal at row R
    "fail": None,          # {"reason": ..., "exit": ..., "row": R}: ends with a failed line; with
                           # "above": D only where the scene's duration is above D
    "exit": None,          # exit code without any last line
    "refuse": None,        # what the helper refuses (fake_helper.py)
    "hang": False,         # stays for ever at the end, ignores SIGTERM
    "ignore_term": False,  # ignores SIGTERM but goes on
    "die_of_term": False,  # SIGTERM kills it at once, without a last line
    "term_delay": 0,       # seconds between SIGTERM and the end
    "orphan": False,       # leaves a child behind that keeps the lock's descriptor open
    "torn": False,         # with crash: half a line is left at the end of events.ndjson
    "noise": 0,            # bytes of output
    "memory": 0,           # bytes to allocate
    "spike": None,         # row in which the force is 1e6
    "linger": 0,           # seconds between the last line and the end of the process
    "warnings": 0,         # so many warning lines at the start
    "frame_bytes": 4000,   # size of a frame
    "garbage": False,      # writes lines that are no events between the good ones
}
COLUMNS = [("time", "s"), ("energy.kinetic", "J"), ("reaction.wall.force.x", "N"),
           ("probe.runout", "m")]


def append(path, text):
    """One write(2) at the end of a file."""
    descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o644)
    os.write(descriptor, text.encode())
    os.close(descriptor)


def replace(path, data):
    """A file that is either the old or the new one, whatever happens."""
    aside = path + ".part"
    descriptor = os.open(aside, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view):]
    os.fsync(descriptor)
    os.close(descriptor)
    os.rename(aside, path)


def now():
    seconds = time.time()
    return time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(seconds)) + f".{int(seconds % 1 * 1e3):03d}Z"


def row_values(index, rows, spike):
    """Row `index`: the time is exact, so that a test can tell rows from it."""
    force = 1e6 if index == spike else float(index % 7)
    return (index / rows, 0.5 * index, force, 2.0 * index)


def frame_bytes(index, size):
    """Begins with its length and SHA-256, so that half a frame is found out."""
    body = (f"frame {index} " * (size // 8 + 1)).encode()[:size]
    return struct.pack("<Q", len(body)) + hashlib.sha256(body).digest() + body


class Run:
    def __init__(self, side, arguments):
        self.side = side
        self.resume = "--resume" in arguments
        words = [word for word in arguments if word != "--resume"]
        self.scene_path = words[0]
        options = dict(zip(words[1::2], words[2::2]))
        self.out, self.attempt = options["--out"], int(options["--attempt"])
        self.threads = int(options["--threads"])
        self.job = os.path.basename(os.path.abspath(self.out))
        self.row = self.frame = 0
        self.terminated = self.told = False
        self.last_row, self.counts, self.steering = None, {}, []

    def violation(self, text):
        append(os.path.join(self.side, "violations"),
               f"{self.job} attempt {self.attempt} pid {os.getpid()}: {text}\n")

    def report(self, what):
        append(os.path.join(self.side, "ran.log"), json.dumps(
            {"what": what, "job": self.job, "attempt": self.attempt, "pid": os.getpid(),
             "threads": self.threads, "at": time.monotonic(), "resume": self.resume}) + "\n")

    def check_lock(self):
        """The inherited descriptor must be job.lock and hold its lock."""
        try:
            descriptor = int(os.environ["TALUS_LOCK_FD"])
            inherited = os.fstat(descriptor)
        except (KeyError, ValueError, OSError) as error:
            self.violation(f"no inherited lock: {error!r}")
            sys.exit(1)
        lock_path = os.path.join(self.out, "job.lock")
        there = os.stat(lock_path)
        if (inherited.st_dev, inherited.st_ino) != (there.st_dev, there.st_ino):
            self.violation("TALUS_LOCK_FD is not job.lock")
            sys.exit(1)
        other = os.open(lock_path, os.O_RDWR)
        try:
            fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
            self.violation("job.lock was not locked when the run began")
            sys.exit(1)
        except BlockingIOError:
            pass
        os.close(other)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self.violation("another process holds job.lock: a double run")
            sys.exit(1)

    def check_events(self):
        """The daemon left whole lines, the last of which says that this attempt runs."""
        with open(self.path("events.ndjson"), "rb") as file:
            text = file.read()
        if not text.endswith(b"\n"):
            self.violation("events.ndjson ends in a torn line")
            return
        last = None
        for line in text.splitlines():
            try:
                last = json.loads(line)
            except ValueError:
                if b"garbage" not in line:
                    self.violation(f"not JSON in events.ndjson: {line[:80]!r}")
        if last["event"] != "state":
            self.violation(f"last line before the run is {last}")

    def path(self, *names):
        return os.path.join(self.out, *names)

    def event(self, name, **members):
        line = {"event": name, "at": now(), "attempt": self.attempt}
        line.update(members)
        os.write(self.events, (json.dumps(line) + "\n").encode())

    def read_directive(self):
        with open(self.scene_path, encoding="utf-8") as file:
            scene = json.load(file)
        title = scene.get("title", "")
        self.duration = scene.get("duration", 1)
        do = dict(DIRECTIVE)
        if title.startswith("fake "):
            do.update(json.loads(title[5:]))
        self.do = do

    def on_term(self, *_):
        self.terminated = True

    def on_told(self, *_):
        self.told = True

    def obey(self):
        """Carries out control.json as the real worker does (docs/files.md)."""
        self.told = False
        try:
            with open(self.path("control.json"), encoding="utf-8") as file:
                orders = json.load(file)
        except FileNotFoundError:
            return
        if "end_time" in orders:
            end = max(self.row, int(orders["end_time"] * self.do["rows"]))
            if end != self.last_row:
                self.last_row = end
                self.steering.append({"what": "end_time", "to": orders["end_time"]})
        for name, act in (("frame_now", self.write_frame), ("checkpoint_now", self.checkpoint)):
            if orders.get(name, 0) > self.counts.get(name, 0):
                self.counts[name] = orders[name]
                self.steering.append({"what": name})
                act()

    def begin(self):
        self.read_directive()
        do = self.do
        handler = self.on_term
        if do["ignore_term"] or do["hang"]:
            handler = signal.SIG_IGN
        elif do["die_of_term"]:
            handler = signal.SIG_DFL
        signal.signal(signal.SIGTERM, handler)
        signal.signal(signal.SIGUSR1, self.on_told)
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        self.check_lock()
        self.check_events()
        self.report("start")
        self.events = os.open(self.path("events.ndjson"), os.O_WRONLY | os.O_APPEND)
        os.makedirs(self.path("frames"), exist_ok=True)
        resumed = self.restore() if self.resume else None
        self.event("started", pid=os.getpid(), threads=self.threads, particles=64,
                   build="fake", isa="none", duration=1.0, resumed_from=resumed)
        replace(self.path("history.json"), json.dumps(
            {"columns": [{"name": n, "unit": u} for n, u in COLUMNS],
             "row_bytes": 8 * len(COLUMNS)}).encode())
        history = self.path("history.bin")
        self.history = os.open(history, os.O_WRONLY | os.O_CREAT, 0o644)
        os.ftruncate(self.history, self.row * 8 * len(COLUMNS))
        os.lseek(self.history, 0, os.SEEK_END)
        if self.attempt > 1:
            self.drop_frames()
            self.event("rewind", row=self.row, time=max(self.row - 1, 0) / do["rows"],
                       frame=self.frame)

    def restore(self):
        """Row and frame to go on from, out of the checkpoint; the step or None."""
        try:
            with open(self.path("checkpoint.h5"), encoding="utf-8") as file:
                point = json.load(file)
        except FileNotFoundError:
            return None
        self.row, self.frame = point["row"], point["frame"]
        self.counts, self.steering = point["counts"], point["steering"]
        return point["step"]

    def drop_frames(self):
        for name in sorted(os.listdir(self.path("frames"))):
            if name.endswith(".part") or int(name[6:12]) >= self.frame:
                os.unlink(self.path("frames", name))

    def checkpoint(self):
        point = {"row": self.row, "frame": self.frame, "step": self.row * 10}
        whole = dict(point, counts=self.counts, steering=self.steering)
        os.fsync(self.history)
        replace(self.path("checkpoint.h5"), json.dumps(whole).encode())
        self.event("checkpoint", time=(self.row - 1) / self.do["rows"], **point)

    def write_frame(self):
        data = frame_bytes(self.frame, self.do["frame_bytes"])
        name = f"frames/frame_{self.frame:06d}.hdf"
        replace(self.path(name), data)
        self.event("frame", n=self.frame, time=self.frame / max(self.do["frames"], 1),
                   step=self.row * 10, particles=64, fields=["velocity"], bytes=len(data),
                   sha256=hashlib.sha256(data).hexdigest(), file=name)
        self.frame += 1

    def progress(self):
        do = self.do
        done = self.row / (do["rows"] + 1)
        self.event("progress", fraction=done, time=done, step=self.row * 10, time_step=0.001,
                   particles=64, particle_steps_per_second=1e6,
                   eta_seconds=(1 - done) * do["seconds"])

    def misbehave(self):
        do, crash, fail = self.do, self.do["crash"], self.do["fail"]
        if crash and self.row == crash.get("row", 0) and self.attempt in crash.get("attempts", [1]):
            if do["torn"]:
                os.write(self.events, b'{"event":"progress","at":"2026-01-01T00:')
            if do["orphan"]:
                self.leave_orphan()
            signal.signal(crash.get("signal", 9), signal.SIG_DFL) if crash.get("signal", 9) != 9 else 0
            os.kill(os.getpid(), crash.get("signal", 9))
            time.sleep(5)
        if fail and self.duration <= fail.get("above", -1):
            fail = None
        if fail and self.row == fail.get("row", 0) and self.attempt in fail.get("attempts", [1, 2, 3]):
            self.event("failed", reason=fail["reason"], detail="as the scene asked",
                       metrics={"probe.runout.final": 1.0})
            self.end(fail["exit"])

    def leave_orphan(self):
        if os.fork() == 0:
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
            time.sleep(60)
            os._exit(0)

    def run(self):
        self.begin()
        do = self.do
        for index in range(do["warnings"]):
            self.event("warning", code="test", pointer="/grid", detail=f"warning {index}")
        if do["noise"]:
            self.make_noise(do["noise"])
        if do["memory"]:
            self.ballast = bytearray(do["memory"])
        rows = do["rows"]
        self.obey()
        begin, first = time.monotonic(), self.row
        while self.row <= (rows if self.last_row is None else self.last_row):
            self.misbehave()
            if self.frame <= self.row * do["frames"] / max(rows, 1):
                self.write_frame()
            os.write(self.history, struct.pack("<4d", *row_values(self.row, rows, do["spike"])))
            self.row += 1
            if self.row % do["flush"] == 0 or self.row > rows:
                if do["garbage"]:
                    os.write(self.events, b'garbage {"event"\n{"event":"garbage-unknown","attempt":1}\n')
                self.event("history", rows=self.row)
                self.progress()
            if self.told:
                self.obey()
            if do["checkpoint"] and self.row % do["checkpoint"] == 0:
                self.checkpoint()
            self.pause(begin + (self.row - first) * do["seconds"] / (rows + 1))
        self.misbehave()
        while do["hang"]:
            time.sleep(1)
        if do["exit"] is not None:
            self.end(do["exit"])
        self.finish()

    def pause(self, until):
        while not self.terminated and time.monotonic() < until:
            if self.told:
                self.obey()
            time.sleep(min(0.02, max(0.0, until - time.monotonic())))
        if self.terminated:
            time.sleep(self.do["term_delay"])
            self.checkpoint()
            self.event("failed", reason="cancelled", detail="terminated", metrics={})
            self.end(12)

    def make_noise(self, count):
        line = b"x" * 99 + b"\n"
        for _ in range(count // 100):
            os.write(2, line)
        os.write(2, b"the last line of the noise\n")

    def finish(self):
        rows = self.row - 1
        replace(self.path("receipt.json"), json.dumps(
            {"metrics": {"rows": rows}, "build": "fake",
             "steered": bool(self.steering)}).encode())
        text = ",".join(name for name, _ in COLUMNS) + "\n"
        for index in range(rows + 1):
            text += ",".join(repr(v) for v in row_values(index, self.do["rows"], self.do["spike"])) + "\n"
        replace(self.path("history.csv"), text.encode())
        self.event("finished", metrics={"probe.runout.final": 2.0 * rows,
                                        "probe.runout.max": float(self.duration),
                                        "reaction.wall.peak": 1e6})
        time.sleep(self.do["linger"])
        self.end(0)

    def end(self, code):
        self.report("end")
        os._exit(code)


def main():
    side, command = sys.argv[1], sys.argv[2]
    if command == "run":
        Run(side, sys.argv[3:]).run()
    elif command == "helper":
        import runpy
        helper = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fake_helper.py")
        try:
            runpy.run_path(helper)["serve"](side)
        except BrokenPipeError:  # the daemon is gone
            os._exit(0)
    else:
        sys.stderr.write(f"unknown command {command}\n")
        sys.exit(1)


main()
