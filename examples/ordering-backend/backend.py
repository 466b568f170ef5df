"""An ordering backend in miniature: takes orders with a mesh, has the mesh repaired and measured, and quotes a price.

    MESHMEND_URL=http://127.0.0.1:8080 WEBHOOK_SECRET=whsec_... python3 backend.py --listen 127.0.0.1:9000

    POST /orders?policy=sls     the mesh as the body    202 {"order": 1, "job": "..."}
    GET  /orders/1                                      200 the order with its state and quote
    POST /hooks/meshmend                                the signed call of the service

The order is written before the upload, and the upload carries the order's number as `Idempotency-Key`, so that an order
is sent again after a crash and still makes one job. A price is only made from a call whose signature is right, and a
call that comes twice changes nothing. Python's own library is all it needs.
"""

import argparse
import base64
import hashlib
import hmac
import json
import os
import sqlite3
import threading
import time
import urllib.error
import urllib.parse
import urllib.request
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

MESH_BYTES_MAX = 512 << 20
MESSAGE_BYTES_MAX = 1 << 20
# As the specification of Standard Webhooks advises: an older call may be a recorded one.
TOLERANCE_S = 300
# What a cubic centimetre of material and a square centimetre of surface cost, and the least price, in cents.
CENTS_PER_CM3, CENTS_PER_CM2, CENTS_MIN = 35, 4, 500

SCHEMA = """
CREATE TABLE IF NOT EXISTS orders (
    number INTEGER PRIMARY KEY, state TEXT NOT NULL, policy TEXT NOT NULL, file TEXT NOT NULL, job TEXT,
    volume_mm3 REAL, area_mm2 REAL, printable INTEGER, price_cents INTEGER, problem TEXT
);
CREATE TABLE IF NOT EXISTS messages (id TEXT PRIMARY KEY);
"""


class Orders:
    """The orders, in a file."""

    def __init__(self, path):
        self.path = path
        with self.connect() as db:
            db.executescript(SCHEMA)

    def connect(self):
        db = sqlite3.connect(self.path, timeout=30)
        db.row_factory = sqlite3.Row
        return db

    def place(self, policy, file):
        with self.connect() as db:
            return db.execute("INSERT INTO orders (state, policy, file) VALUES ('placed', ?, ?)", (policy, file)).lastrowid

    def sent(self, number, job):
        with self.connect() as db:
            db.execute("UPDATE orders SET job = ?, state = 'checking' WHERE number = ? AND state = 'placed'", (job, number))

    def unsent(self):
        with self.connect() as db:
            return [dict(row) for row in db.execute("SELECT * FROM orders WHERE state = 'placed'")]

    def get(self, number):
        with self.connect() as db:
            row = db.execute("SELECT * FROM orders WHERE number = ?", (number,)).fetchone()
        return row and {name: row[name] for name in row.keys() if name != "file"}

    def is_known(self, message):
        with self.connect() as db:
            return db.execute("SELECT 1 FROM messages WHERE id = ?", (message,)).fetchone() is not None

    def quote(self, message, number, job, figures):
        """Notes what is known of an order now, and the message that told it, in one step."""
        with self.connect() as db:
            if db.execute("INSERT OR IGNORE INTO messages VALUES (?)", (message,)).rowcount:
                db.execute(
                    "UPDATE orders SET job = :job, state = :state, volume_mm3 = :volume_mm3, area_mm2 = :area_mm2,"
                    " printable = :printable, price_cents = :price_cents, problem = :problem WHERE number = :number",
                    {**figures, "job": job, "number": number},
                )


class Meshmend:
    """The repair service, as far as an order needs it."""

    def __init__(self, url, key, hook, secret):
        self.url, self.key, self.hook, self.secret = url.rstrip("/"), key, hook, secret

    def request(self, method, path, body=None, headers=None):
        headers = dict(headers or {})
        if self.key:
            headers["Authorization"] = f"Bearer {self.key}"
        request = urllib.request.Request(self.url + path, data=body, headers=headers, method=method)
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)

    def submit(self, order):
        """Sends the mesh of an order; the same job comes back when it was sent before."""
        job = {
            "operation": "repair",
            "policy": order["policy"],
            "labels": {"order": str(order["number"])},
            "webhook": {"url": self.hook, "secret": self.secret},
        }
        boundary = f"order-{order['number']}-{os.urandom(16).hex()}"
        with open(order["file"], "rb") as file:
            mesh = file.read()
        part = f'--{boundary}\r\nContent-Disposition: form-data; name="%s"\r\nContent-Type: %s\r\n\r\n'
        body = b"".join([
            (part % ("job", "application/json")).encode(), json.dumps(job).encode(), b"\r\n",
            (part % ("mesh", "application/octet-stream")).encode(), mesh, f"\r\n--{boundary}--\r\n".encode(),
        ])
        headers = {"Content-Type": f"multipart/form-data; boundary={boundary}", "Idempotency-Key": f"order-{order['number']}"}
        return self.request("POST", "/v1/jobs", body, headers)

    def report(self, job):
        return self.request("GET", f"/v1/jobs/{job}/report", headers={"Accept": "application/json"})


def is_signed(secret, headers, body, now):
    """Whether a call is from who knows the secret, and not an old one."""
    key = base64.b64decode(secret.removeprefix("whsec_"))
    message, timestamp = headers.get("webhook-id", ""), headers.get("webhook-timestamp", "")
    if not timestamp.isdigit() or abs(now - int(timestamp)) > TOLERANCE_S:
        return False
    digest = hmac.new(key, f"{message}.{timestamp}.".encode() + body, hashlib.sha256).digest()
    expected = "v1," + base64.b64encode(digest).decode()
    given = headers.get("webhook-signature", "").split(" ")
    return any(hmac.compare_digest(expected.encode(), one.encode()) for one in given)


def figures_of(job, report):
    """What the report says about price and fitness."""
    if job["state"] != "succeeded":
        problem = (job.get("problem") or {}).get("code", job["state"])
        return dict(state="refused", volume_mm3=None, area_mm2=None, printable=0, price_cents=None, problem=problem)
    # A price rests on the volume, which means something only of a valid solid.
    quote = report["printing"]["quote"]
    if not quote["price_safe"]:
        return dict(state="refused", volume_mm3=None, area_mm2=None, printable=0, price_cents=None, problem=quote["reason"])
    volume, area = quote["volume"], quote["area"]
    price = max(CENTS_MIN, round(volume / 1000 * CENTS_PER_CM3 + area / 100 * CENTS_PER_CM2))
    return dict(state="quoted", volume_mm3=volume, area_mm2=area, printable=1, price_cents=price, problem=None)


class Backend(BaseHTTPRequestHandler):
    """The HTTP side of the shop."""

    orders: Orders
    meshmend: Meshmend
    folder: str

    def answer(self, status, value):
        body = json.dumps(value).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def body(self, bytes_max):
        length = self.headers.get("Content-Length", "")
        if not length.isdigit() or int(length) > bytes_max:
            self.answer(413 if length.isdigit() else 411, {"error": f"a body of at most {bytes_max} bytes is expected"})
            return None
        return self.rfile.read(int(length))

    def do_POST(self):
        url = urllib.parse.urlsplit(self.path)
        if url.path == "/orders":
            self.place(urllib.parse.parse_qs(url.query).get("policy", ["fdm"])[0])
        elif url.path == "/hooks/meshmend":
            self.take_message()
        else:
            self.answer(404, {"error": "there is nothing at this path"})

    def do_GET(self):
        number = self.path.removeprefix("/orders/")
        order = self.orders.get(int(number)) if number.isdigit() else None
        self.answer(200, order) if order else self.answer(404, {"error": "there is no such order"})

    def place(self, policy):
        mesh = self.body(MESH_BYTES_MAX)
        if mesh is None:
            return
        file = os.path.join(self.folder, os.urandom(16).hex())
        with open(file, "wb") as out:
            out.write(mesh)
        number = self.orders.place(policy, file)
        try:
            job = send(self.orders, self.meshmend, {"number": number, "policy": policy, "file": file})
        except OSError:
            # It is sent again later.
            job = None
        self.answer(202, {"order": number, "job": job})

    def take_message(self):
        body = self.body(MESSAGE_BYTES_MAX)
        if body is None:
            return
        if not is_signed(self.meshmend.secret, self.headers, body, time.time()):
            self.answer(401, {"error": "the signature is wrong"})
            return
        message = self.headers["webhook-id"]
        if not self.orders.is_known(message):
            job = json.loads(body)["data"]
            number = int(job["labels"]["order"])
            report = self.meshmend.report(job["id"]) if job["state"] == "succeeded" else None
            self.orders.quote(message, number, job["id"], figures_of(job, report))
        self.answer(200, {})

    def log_message(self, form, *arguments):
        print(form % arguments, flush=True)


def send(orders, meshmend, order):
    """Sends an order to the service; gives the job's id, or nothing when the mesh was not taken."""
    try:
        job = meshmend.submit(order)["id"]
        orders.sent(order["number"], job)
        return job
    except urllib.error.HTTPError as error:
        if error.code in (429, 503, 507):
            raise OSError("try again later") from error
        problem = json.load(error).get("code", str(error.code))
        figures = figures_of({"state": "failed", "problem": {"code": problem}}, None)
        orders.quote(f"order-{order['number']}", order["number"], None, figures)
        return None


def send_again(orders, meshmend, pause):
    """Sends orders that could not be sent, now and then."""
    while True:
        time.sleep(pause)
        for order in orders.unsent():
            try:
                send(orders, meshmend, order)
            except OSError as error:
                print(f"order {order['number']} is not sent yet: {error}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--listen", default="127.0.0.1:9000")
    parser.add_argument("--data", default="orders")
    parser.add_argument("--pause", type=float, default=10, help="seconds between two rounds of unsent orders")
    options = parser.parse_args()
    os.makedirs(options.data, exist_ok=True)
    host, port = options.listen.rsplit(":", 1)
    server = ThreadingHTTPServer((host, int(port)), Backend)
    address = f"{host}:{server.server_port}"
    Backend.orders = Orders(os.path.join(options.data, "orders.sqlite3"))
    Backend.folder = options.data
    Backend.meshmend = Meshmend(
        os.environ["MESHMEND_URL"],
        os.environ.get("MESHMEND_KEY", ""),
        os.environ.get("WEBHOOK_URL", f"http://{address}/hooks/meshmend"),
        os.environ["WEBHOOK_SECRET"],
    )
    threading.Thread(target=send_again, args=(Backend.orders, Backend.meshmend, options.pause), daemon=True).start()
    print(f"listening on http://{address}", flush=True)
    server.serve_forever()


if __name__ == "__main__":
    main()
