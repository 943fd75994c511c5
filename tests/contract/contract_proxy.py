# SPDX-License-Identifier: Apache-2.0
"""Sends the requests of the protocol tests through prism and notes what it finds. The harness uses it
where TALUS_CONTRACT_CONTROL names the port of prism_proxy.mjs; notes go to TALUS_CONTRACT_NOTES, one
JSON object a line."""
import http.client
import json
import os
import re
import threading

CONTROL = os.environ.get("TALUS_CONTRACT_CONTROL")
NOTES = os.environ.get("TALUS_CONTRACT_NOTES")
# Streams, contents of files and frames are not JSON and go directly.
DIRECT = re.compile(r"/events(\?|$)|/files/|/frames/|^/$|^/metrics")
# These belong to the connection, or to what the proxy would rewrite.
DIRECT_HEADERS = {"host", "origin", "range", "if-range", "content-encoding", "transfer-encoding",
                  "content-length", "connection", "expect"}
LOCK = threading.Lock()
PORTS = {}


def is_json(body):
    try:
        json.loads(body)
    except ValueError:
        return False
    return True


def takes(method, path, body, headers):
    """Whether prism can be asked about a request at all."""
    names = {name.lower() for name in headers}
    typed = {name.lower(): value for name, value in headers.items()}.get("content-type", "")
    return (CONTROL is not None and not DIRECT.search(path) and not names & DIRECT_HEADERS
            and path.startswith("/") and method in ("GET", "POST", "PATCH", "DELETE")
            and (body is None or (typed.startswith("application/json") and is_json(body)
                                  and method in ("POST", "PATCH"))))


def proxy_port(upstream):
    with LOCK:
        if upstream not in PORTS:
            control = http.client.HTTPConnection("127.0.0.1", int(CONTROL), timeout=60)
            control.request("GET", f"/{upstream}")
            PORTS[upstream] = int(control.getresponse().read())
            control.close()
        return PORTS[upstream]


def note(**entry):
    if NOTES:
        with LOCK, open(NOTES, "a", encoding="utf-8") as file:
            file.write(json.dumps(entry) + "\n")


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
    if answer.status >= 500 and b"stoplight.io/prism" in data:
        raise ConnectionResetError("there is no daemon behind the proxy")
    note(method=method, path=path, status=answer.status, through=True,
         violations=answer.getheader("sl-violations"), answer=data[:2000].decode("utf-8", "replace"))
    return answer.status, fields, data
