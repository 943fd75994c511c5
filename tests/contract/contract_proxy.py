# SPDX-License-Identifier: Apache-2.0
"""Sends the requests of the protocol tests through prism and notes what it finds. The harness uses it
where TALUS_CONTRACT_CONTROL names the port of prism_proxy.mjs; notes go to TALUS_CONTRACT_NOTES, one
JSON object a line. What prism cannot carry goes directly, and its answer is held against the document
by the validator alone."""
import http.client
import json
import os
import re
import threading
import urllib.parse

CONTROL = os.environ.get("TALUS_CONTRACT_CONTROL")
NOTES = os.environ.get("TALUS_CONTRACT_NOTES")
# Streams, contents of files and frames are not JSON; prism would hold them back or change them.
DIRECT = re.compile(r"/events(\?|$)|/files/|/frames/|^/$")
# These belong to the connection, or to what the proxy would rewrite.
DIRECT_HEADERS = {"host", "range", "if-range", "content-encoding", "transfer-encoding",
                  "content-length", "connection", "expect"}
# Prism takes no larger header field of its own.
HEADER_BYTES_MAX = 8000
LOCK = threading.Lock()
PORTS = {}


def members(pairs):
    """Of two equal keys prism would send on the last; others than these end up in a header field that
    it writes, and end it."""
    keys = [key for key, _ in pairs]
    if len(set(keys)) < len(keys) or not all(key.isascii() and key.isprintable() for key in keys):
        raise ValueError("not the same in JavaScript")
    return dict(pairs)


def is_json(body):
    """Whether prism would send on what it got: Python takes more for JSON than there is."""
    try:
        text = body if isinstance(body, str) else body.decode()
        json.loads(text, object_pairs_hook=members, parse_constant=members)
    except (ValueError, TypeError, RecursionError):
        return False
    return True


def is_target(path):
    """Whether prism can decode a path: one that it cannot ends it."""
    if re.search("%(?![0-9A-Fa-f]{2})", path):
        return False
    try:
        urllib.parse.unquote(path, errors="strict")
    except UnicodeDecodeError:
        return False
    return path.startswith("/")


def takes(method, path, body, headers):
    """Whether prism can carry a request at all."""
    fields = {name.lower(): value for name, value in headers.items()}
    size = len(path) + sum(len(name) + len(value) for name, value in headers.items())
    # Other schemes are for a server in front; prism knows this one in these letters only.
    bearer = fields.get("authorization", "Bearer x")
    bearer = bearer.encode() if isinstance(bearer, str) else bearer
    return (CONTROL is not None and is_target(path) and not DIRECT.search(path)
            and not fields.keys() & DIRECT_HEADERS and size < HEADER_BYTES_MAX
            and bearer.startswith(b"Bearer ")
            and method in ("GET", "POST", "PATCH", "DELETE")
            and (body is None or (fields.get("content-type", "").startswith("application/json")
                                  and is_json(body) and method in ("POST", "PATCH"))))


def ask(method, target, body=None):
    """The answer of the control server."""
    control = http.client.HTTPConnection("127.0.0.1", int(CONTROL), timeout=60)
    try:
        control.request(method, target, body)
        return json.loads(control.getresponse().read())
    finally:
        control.close()


def proxy_port(upstream):
    with LOCK:
        if upstream not in PORTS:
            PORTS[upstream] = ask("GET", f"/{upstream}")
        return PORTS[upstream]


def note(**entry):
    if NOTES:
        with LOCK, open(NOTES, "a", encoding="utf-8") as file:
            file.write(json.dumps(entry) + "\n")


def examine(method, path, status, headers, body):
    """Notes an answer that came directly; `headers` have lower-case names."""
    if CONTROL is None:
        return
    text = body.decode("utf-8", "replace")
    violations = ask("POST", "/answers", json.dumps({
        "method": method, "path": path, "status": status, "headers": headers, "body": text}))
    note(method=method, path=path, status=status, through=False, routed=violations is not None,
         violations=violations or [], answer=text[:2000])


def violations_of(field):
    """Prism cuts long lists."""
    if field is None or field.startswith("["):
        return json.loads(field or "[]")
    part = "response" if '"location":["response"' in field else "request"
    return [{"location": [part], "severity": "Error", "message": field[:200]}]


def request(upstream, method, path, body, headers, timeout):
    """The answer as (status, [(name, value)], body)."""
    connection = http.client.HTTPConnection("127.0.0.1", proxy_port(upstream), timeout=timeout)
    try:
        connection.request(method, path, body=body, headers=headers)
        answer = connection.getresponse()
        data = answer.read()
    finally:
        connection.close()
    fields = [(name, value) for name, value in answer.getheaders()
              if name.lower() != "sl-violations"]
    if answer.status >= 500 and b"urn:talus:" not in data:
        raise ConnectionResetError("there is no daemon behind the proxy")
    violations = violations_of(answer.getheader("sl-violations"))
    unknown = any(violation["message"] == "Selected route not found" for violation in violations)
    note(method=method, path=path, status=answer.status, through=True, routed=not unknown,
         violations=violations, answer=data[:2000].decode("utf-8", "replace"))
    return answer.status, fields, data
