# SPDX-License-Identifier: Apache-2.0
"""Reads Server-Sent Events over a plain socket, byte by byte as a browser would."""
import json
import socket
import time

from talus_harness import PATIENCE, contract_proxy


class Event:
    def __init__(self, name, text, identity):
        self.name, self.text, self.id = name, text, identity

    @property
    def data(self):
        return json.loads(self.text)

    def __repr__(self):
        return f"{self.name}[{self.id}] {self.text[:160]}"

    def __eq__(self, other):
        return (self.name, self.text, self.id) == (other.name, other.text, other.id)

    def __hash__(self):
        return hash((self.name, self.text, self.id))


class Stream:
    """GET path as an event stream. Iterating gives events until the server ends the stream."""

    def __init__(self, port, path, last_id=None, receive_buffer=None, timeout=30.0, token=None,
                 host=None):
        self.comments = []
        self.path = path
        self.ended = False
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(timeout * PATIENCE)
        self.socket.connect(("127.0.0.1", port))
        self.socket = self.wrap(self.socket)
        lines = [f"GET {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}",
                 "Accept: text/event-stream"]
        if last_id is not None:
            lines.append(f"Last-Event-ID: {last_id}")
        if token is not None:
            lines.append(f"Authorization: Bearer {token}")
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.buffer = b""
        self.raw = self._bytes()
        self.status = None
        self.headers = {}

    def wrap(self, plain):
        """For a stream through something else."""
        return plain

    def open(self):
        """Reads the answer's head; done at the first event if not asked for before."""
        if self.status is not None:
            return self
        while b"\r\n\r\n" not in self.buffer:
            self._receive()
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        lines = head.decode("latin-1").split("\r\n")
        self.status = int(lines[0].split()[1])
        self.headers = {k.lower(): v.strip() for k, v in (x.split(":", 1) for x in lines[1:])}
        if self.headers.get("content-type", "").startswith("text/event-stream"):
            contract_proxy.examine("GET", self.path, self.status, self.headers, b"(a stream)")
        return self

    def _receive(self):
        data = self.socket.recv(65536)
        if not data:
            raise EOFError
        self.buffer += data

    def _line(self):
        while b"\r\n" not in self.buffer:
            self._receive()
        line, self.buffer = self.buffer.split(b"\r\n", 1)
        return line

    def _bytes(self):
        """The body's pieces, with chunked transfer undone."""
        if self.status == 204:  # nothing is left to tell, now or ever
            return
        chunked = "chunked" in self.headers.get("transfer-encoding", "").lower()
        while True:
            if not chunked:
                if not self.buffer:
                    try:
                        self._receive()
                    except EOFError:
                        return
                piece, self.buffer = self.buffer, b""
                yield piece
                continue
            size = int(self._line().split(b";")[0], 16)
            while len(self.buffer) < size + 2:
                self._receive()
            if size == 0:
                return
            piece, self.buffer = self.buffer[:size], self.buffer[size + 2:]
            yield piece

    def __iter__(self):
        self.open()
        text = b""
        for piece in self.raw:
            text += piece
            while b"\n\n" in text:
                block, text = text.split(b"\n\n", 1)
                event = self._parse(block.decode("utf-8"))
                if event:
                    yield event
        self.ended = True

    def _parse(self, block):
        name, data, identity = "message", [], None
        for line in block.split("\n"):
            if line.startswith(":"):
                self.comments.append(line)
                continue
            key, _, value = line.partition(":")
            value = value.removeprefix(" ")
            if key == "event":
                name = value
            elif key == "data":
                data.append(value)
            elif key == "id":
                identity = value
        return Event(name, "\n".join(data), identity) if data else None

    def close(self):
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def read_all(port, path, last_id=None, seconds=30.0):
    """Every event until the stream ends; fails if it does not end within `seconds`."""
    end = time.monotonic() + seconds * PATIENCE
    events = []
    with Stream(port, path, last_id, timeout=seconds) as stream:
        for event in stream:
            events.append(event)
            if time.monotonic() > end:
                raise AssertionError(f"stream does not end; last: {events[-1]}")
        if not stream.ended:
            raise AssertionError("stream broke off")
    return events


def series(events):
    """{name: ([time], [value])} of reaction, probe and energy events, with rewinds applied."""
    rows = {}
    for event in events:
        if event.name in ("reaction", "probe", "energy"):
            time_list, value_list = rows.setdefault(event.data["name"], ([], []))
            assert len(event.data["time"]) == len(event.data["value"])
            time_list += event.data["time"]
            value_list += event.data["value"]
        elif event.name == "rewind":
            for time_list, value_list in rows.values():
                del time_list[event.data["row"]:]
                del value_list[event.data["row"]:]
    return rows
