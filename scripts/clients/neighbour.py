"""A difficult neighbour between a client and the server, and the receiver of its webhooks.

    neighbour.py PORT SERVER_URL [FOLDER]

    /NAME/MANNER/...     passed on to the server, in the MANNER below; what was asked is kept under NAME
    /NAME/asked          what was asked: method, path, manner, status and the headers that matter, as JSON
    /NAME/hook           receives a webhook; the first one of each NAME is answered 500
    /NAME/calls          the webhooks that came, as JSON
    /NAME/printed        what a scenario in a browser has printed, as it posts it
    /files/...           files of FOLDER, for that scenario

Manners: `plain`: as it is. `busy`: of each NAME the first POST is answered 503, the second 429, each with a `Retry-After`.
`away`: the first request is answered 502 with a page that is no problem document. `lost`: the first POST reaches the
server, but its answer does not come back. `cut`: streams of events break off within their second event.
`short`: the first result ends before its last byte. `bent`: one byte of each result is another. `torn`: of the first PATCH one half
reaches the server, which stores it, and no answer comes back.
"""

import http.client
import json
import mimetypes
import pathlib
import sys
import threading
import time
import urllib.parse
from collections import defaultdict
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

# What is between two neighbours only, and what a browser says of the page that asks: to the server it is a page of its own.
HOP = {"connection", "transfer-encoding", "keep-alive", "host", "origin", "referer"}
KEPT = ["idempotency-key", "last-event-id", "content-length", "prefer"]
PROBLEM = "application/problem+json"


class Neighbour(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server_url = ""
    folder = pathlib.Path()
    lock = threading.Lock()
    asked = defaultdict(list)
    calls = defaultdict(list)
    printed = {}

    def handle_any(self):
        name, _, rest = self.path.lstrip("/").partition("/")
        manner, _, path = rest.partition("/")
        if name == "files":
            return self.give_file(rest)
        body = self.read_body()
        if rest in ("asked", "calls"):
            return self.answer(200, "application/json", json.dumps((self.asked if rest == "asked" else self.calls)[name]).encode())
        if rest == "printed":
            if self.command == "POST":
                self.printed[name] = body
            return self.answer(200, "text/plain", self.printed.get(name, b""))
        if rest == "hook":
            with self.lock:
                self.calls[name].append({"headers": dict(self.headers.items()), "body": body.decode()})
                is_first = len(self.calls[name]) == 1
            return self.answer(500 if is_first else 204, "text/plain", b"")
        entry = {"method": self.command, "path": "/" + path.partition("?")[0], "manner": manner, "status": None}
        entry |= {header: self.headers[header] for header in KEPT if self.headers[header] is not None}
        with self.lock:
            times = sum(e["manner"] == manner and e["method"] == self.command for e in self.asked[name])
            self.asked[name].append(entry)
        self.pass_on(manner, times, path, body, entry)

    do_GET = do_HEAD = do_POST = do_PATCH = do_DELETE = handle_any

    def read_body(self):
        if self.headers.get("transfer-encoding", "").lower() == "chunked":
            body = b""
            while size := int(self.rfile.readline().partition(b";")[0], 16):
                body += self.rfile.read(size)
                self.rfile.readline()
            self.rfile.readline()
            return body
        return self.rfile.read(int(self.headers.get("content-length", 0)))

    def pass_on(self, manner, times, path, body, entry):
        if manner == "busy" and self.command == "POST" and times < 2:
            status, code, wait = [(503, "draining", "1"), (429, "rate-limited", "0")][times]
            entry["status"] = status
            problem = {"type": f"/v1/errors#{code}", "title": code, "status": status, "code": code, "detail": "come again"}
            return self.answer(status, PROBLEM, json.dumps(problem).encode(), {"Retry-After": wait})
        if manner == "away" and times == 0:
            entry["status"] = 502
            return self.answer(502, "text/html", b"<h1>Bad gateway</h1>")
        server = urllib.parse.urlsplit(self.server_url)
        connection = http.client.HTTPConnection(server.hostname, server.port, timeout=120)
        headers = {name: value for name, value in self.headers.items() if name.lower() not in HOP}
        if manner == "torn" and self.command == "PATCH" and times == 0:
            self.close_connection = True
            return self.tear(connection, "/" + path, body, {**headers, "Host": server.netloc})
        connection.request(self.command, "/" + path, body=body or None, headers={**headers, "Host": server.netloc, "Content-Length": str(len(body))})
        reply = connection.getresponse()
        entry["status"] = reply.status
        if reply.headers.get_content_type() == "text/event-stream":
            return self.give_events(reply, is_cut=manner == "cut")
        content = reply.read()
        is_result = entry["path"].endswith("/result")
        if manner == "lost" and self.command == "POST" and times == 0:
            self.close_connection = True
            return None
        passed = {name: value for name, value in reply.getheaders() if name.lower() not in HOP | {"content-length", "content-type"}}
        if manner == "bent" and is_result:
            content = content[:-1] + bytes([content[-1] ^ 1])
        is_short = manner == "short" and is_result and sum(e["path"] == entry["path"] for e in self.all_asked()) == 1
        self.answer(reply.status, reply.headers.get("content-type"), content, passed, cut=1 if is_short else 0)

    def tear(self, connection, path, body, headers):
        """Sends half of a piece of an upload, and waits until the server has stored it."""
        connection.putrequest(self.command, path, skip_host=True, skip_accept_encoding=True)
        for name, value in headers.items():
            connection.putheader(name, value)
        connection.endheaders(body[: len(body) // 2])
        connection.close()
        for _ in range(600):
            connection.request("HEAD", path, headers={"Tus-Resumable": "1.0.0"})
            reply = connection.getresponse()
            reply.read()
            if reply.headers["upload-offset"] != headers["Upload-Offset"]:
                return
            time.sleep(0.1)

    def all_asked(self):
        return [entry for entries in self.asked.values() for entry in entries]

    def give_events(self, reply, *, is_cut):
        """Passes events on as they come; a cut stream breaks off in the middle of its second event."""
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True
        blocks = 0
        while line := reply.readline():
            self.wfile.write(line)
            self.wfile.flush()
            blocks += line == b"\n"
            if is_cut and blocks == 1:
                self.wfile.write(b"event: sta")
                return

    def answer(self, status, content_type, content, headers=None, *, cut=0):
        self.send_response(status)
        for name, value in (headers or {}).items():
            self.send_header(name, value)
        if content_type is not None:
            self.send_header("Content-Type", content_type)
        if status != 204:
            self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content[: len(content) - cut])
        self.close_connection = self.close_connection or cut > 0

    def give_file(self, rest):
        path = (self.folder / urllib.parse.unquote(rest)).resolve()
        if not path.is_relative_to(self.folder) or not path.is_file():
            return self.answer(404, "text/plain", b"")
        kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
        return self.answer(200, "text/javascript" if path.suffix == ".js" else kind, path.read_bytes())

    def log_message(self, *_):
        pass


def main(port, server_url, folder="."):
    Neighbour.server_url = server_url
    Neighbour.folder = pathlib.Path(folder).resolve()
    ThreadingHTTPServer(("127.0.0.1", int(port)), Neighbour).serve_forever()


main(*sys.argv[1:])
