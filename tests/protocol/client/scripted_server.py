# SPDX-License-Identifier: Apache-2.0
"""A server that answers as a test tells it to, on TCP or a Unix socket: what the client makes of
answers that a healthy talusd gives rarely or never."""
import http.server
import json
import socketserver
import threading


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def handle_any(self):
        length = int(self.headers.get("Content-Length") or 0)
        body = self.rfile.read(length).decode()
        self.server.requests.append((self.command, self.path, dict(self.headers), body))
        self.server.answer(self)

    do_GET = do_POST = do_DELETE = handle_any

    def log_message(self, *arguments):
        pass

    def address_string(self):
        return "client"

    def send(self, status, body=b"", content_type="application/json", **headers):
        if not isinstance(body, bytes):
            body = json.dumps(body).encode()
        self.send_response(status)
        if status != 204:
            self.send_header("Content-Type", content_type)
        for name, value in headers.items():
            self.send_header(name.replace("_", "-"), value)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def begin_stream(self):
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True

    def send_event(self, id, event, data):
        self.wfile.write(f"id: {id}\nevent: {event}\ndata: {json.dumps(data)}\n\n".encode())
        self.wfile.flush()


class Server(socketserver.ThreadingMixIn, http.server.HTTPServer):
    daemon_threads = True


class UnixServer(socketserver.ThreadingMixIn, socketserver.UnixStreamServer):
    daemon_threads = True


def start(answer, socket_path=None):
    """answer(handler) is called for every request; returns the running server."""
    if socket_path is None:
        server = Server(("127.0.0.1", 0), Handler)
        server.url = f"http://127.0.0.1:{server.server_address[1]}"
    else:
        server = UnixServer(socket_path, Handler)
        server.url = f"unix:{socket_path}"
    server.requests = []
    server.answer = answer
    threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True).start()
    return server
