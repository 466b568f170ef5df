"""An ordering backend in miniature: takes orders with a mesh, has the mesh repaired and measured, and quotes a price.

    MESHMEND_URL=http://127.0.0.1:8080 WEBHOOK_SECRET=whsec_... python3 backend.py --listen 127.0.0.1:9000

    POST /orders?policy=sls&units=mm   the mesh as the body    202 {"order": 1, "job": "..."}
    GET  /orders/1                                             200 the order with its state, quote or question
    POST /orders/1/answer?units=in     (or ?accept=changes)    202 the answer to its question; it is checked again
    GET  /orders/1/mesh                                        200 the mesh to print
    POST /hooks/meshmend                                       the signed call of the service

An order is `quoted` when the mesh is a valid solid, true to the file, within the limits of the process, and of a size that
is not doubtful; its mesh has been downloaded then. It is `asked` when the customer must say something first: in which unit
the file is, or that a changed shape will do. It is `refused` when the process cannot make it.

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
    number INTEGER PRIMARY KEY, state TEXT NOT NULL, policy TEXT NOT NULL, units TEXT NOT NULL, accepts INTEGER NOT NULL,
    version INTEGER NOT NULL, file TEXT NOT NULL, mesh TEXT, job TEXT, volume_mm3 REAL, area_mm2 REAL, fidelity TEXT,
    price_cents INTEGER, problem TEXT
);
CREATE TABLE IF NOT EXISTS messages (id TEXT PRIMARY KEY);
"""


# What is known of an order before its report.
NOTHING = dict.fromkeys(("volume_mm3", "area_mm2", "mesh", "fidelity", "price_cents", "problem"))
UNITS = ("", "mm", "cm", "m", "in")


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

    def place(self, policy, units, file):
        with self.connect() as db:
            row = "INSERT INTO orders (state, policy, units, accepts, version, file) VALUES ('placed', ?, ?, 0, 1, ?)"
            return db.execute(row, (policy, units, file)).lastrowid

    def reply(self, number, units, accepts):
        """Notes the answer to a question; the order is checked again, as another version of it."""
        with self.connect() as db:
            return db.execute(
                "UPDATE orders SET state = 'placed', version = version + 1, units = coalesce(nullif(?, ''), units),"
                " accepts = max(accepts, ?), problem = NULL WHERE number = ? AND state = 'asked'",
                (units, accepts, number),
            ).rowcount

    def sent(self, number, job):
        with self.connect() as db:
            db.execute("UPDATE orders SET job = ?, state = 'checking' WHERE number = ? AND state = 'placed'", (job, number))

    def unsent(self):
        with self.connect() as db:
            return [dict(row) for row in db.execute("SELECT * FROM orders WHERE state = 'placed'")]

    def get(self, number):
        with self.connect() as db:
            row = db.execute("SELECT * FROM orders WHERE number = ?", (number,)).fetchone()
        return row and dict(row)

    def is_known(self, message):
        with self.connect() as db:
            return db.execute("SELECT 1 FROM messages WHERE id = ?", (message,)).fetchone() is not None

    def quote(self, message, number, job, figures):
        """Notes what is known of an order now, and the message that told it, in one step."""
        with self.connect() as db:
            if db.execute("INSERT OR IGNORE INTO messages VALUES (?)", (message,)).rowcount:
                db.execute(
                    "UPDATE orders SET job = :job, state = :state, volume_mm3 = :volume_mm3, area_mm2 = :area_mm2, mesh = :mesh,"
                    " fidelity = :fidelity, price_cents = :price_cents, problem = :problem WHERE number = :number",
                    {**NOTHING, **figures, "job": job, "number": number},
                )


class Meshmend:
    """The repair service, as far as an order needs it."""

    def __init__(self, url, key, hook, secret):
        self.url, self.key, self.hook, self.secret = url.rstrip("/"), key, hook, secret

    def request(self, method, path, body=None, headers=None, read=json.load):
        headers = dict(headers or {})
        if self.key:
            headers["Authorization"] = f"Bearer {self.key}"
        request = urllib.request.Request(self.url + path, data=body, headers=headers, method=method)
        with urllib.request.urlopen(request, timeout=60) as answer:
            return read(answer)

    def submit(self, order):
        """Sends the mesh of an order; the same job comes back when it was sent before."""
        job = {
            "operation": "repair",
            "policy": order["policy"],
            # What is printed is an STL in millimetres, whatever came in.
            "output_format": "stl",
            "labels": {"order": str(order["number"]), "version": str(order["version"])},
            "webhook": {"url": self.hook, "secret": self.secret},
        }
        if order["units"]:
            job["units"] = order["units"]
        boundary = f"order-{order['number']}-{os.urandom(16).hex()}"
        with open(order["file"], "rb") as file:
            mesh = file.read()
        part = f'--{boundary}\r\nContent-Disposition: form-data; name="%s"\r\nContent-Type: %s\r\n\r\n'
        body = b"".join([
            (part % ("job", "application/json")).encode(), json.dumps(job).encode(), b"\r\n",
            (part % ("mesh", "application/octet-stream")).encode(), mesh, f"\r\n--{boundary}--\r\n".encode(),
        ])
        headers = {"Content-Type": f"multipart/form-data; boundary={boundary}", "Idempotency-Key": key_of(order)}
        return self.request("POST", "/v1/jobs", body, headers)

    def report(self, job):
        return self.request("GET", f"/v1/jobs/{job}/report", headers={"Accept": "application/json"})

    def mesh(self, job):
        return self.request("GET", f"/v1/jobs/{job}/result", read=lambda answer: answer.read())


def key_of(order):
    """The same for every try to send an order, another one when the customer has changed it."""
    return f"order-{order['number']}-{order['version']}"


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


def figures_of(job, report, order):
    """What the report says about price and fitness: a quote, a question to the customer, or a refusal."""
    if job["state"] != "succeeded":
        return dict(state="refused", problem=(job.get("problem") or {}).get("code", job["state"]))
    verdict, printing = report["verdict"], report["printing"]
    known = dict(fidelity=verdict["fidelity"])
    hypothesis = (report["before"] or {}).get("unit_hypothesis") or {}
    if hypothesis.get("question"):
        return dict(known, state="asked", problem=hypothesis["question"])
    # A valid solid is not yet the part that the customer has drawn.
    if verdict["fidelity"] == "changed" and not order["accepts"]:
        return dict(known, state="asked", problem="; ".join(change["message"] for change in verdict["changes"]))
    # Nor one that the process can make: walls may be too thin, or the part too large.
    if printing is None or not verdict["p3_holds"]:
        checks = (printing or {}).get("checks", [])
        broken = [check["message"] for check in checks if check["code"] in verdict["p3_breaches"]]
        return dict(known, state="refused", problem=" ".join(broken) or "the mesh cannot be measured")
    # A price rests on the volume, which means something only of a valid solid.
    quote = printing["quote"]
    if not quote["price_safe"]:
        return dict(known, state="refused", problem=quote["reason"])
    volume, area = quote["volume"], quote["area"]
    price = max(CENTS_MIN, round(volume / 1000 * CENTS_PER_CM3 + area / 100 * CENTS_PER_CM2))
    return dict(known, state="quoted", volume_mm3=volume, area_mm2=area, price_cents=price)


class Backend(BaseHTTPRequestHandler):
    """The HTTP side of the shop."""

    orders: Orders
    meshmend: Meshmend
    folder: str

    def answer(self, status, value, media_type="application/json"):
        body = value if isinstance(value, bytes) else json.dumps(value).encode()
        self.send_response(status)
        self.send_header("Content-Type", media_type)
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
        query = {name: values[0] for name, values in urllib.parse.parse_qs(url.query).items()}
        if query.get("units", "") not in UNITS:
            self.answer(400, {"error": "units are mm, cm, m or in"})
        elif url.path == "/orders":
            self.place(query.get("policy", "fdm"), query.get("units", ""))
        elif url.path.startswith("/orders/") and url.path.endswith("/answer"):
            self.reply(url.path.split("/")[2], query)
        elif url.path == "/hooks/meshmend":
            self.take_message()
        else:
            self.answer(404, {"error": "there is nothing at this path"})

    def do_GET(self):
        number, _, what = self.path.removeprefix("/orders/").partition("/")
        order = self.orders.get(int(number)) if number.isdigit() else None
        if order is None or what not in ("", "mesh") or (what and not order["mesh"]):
            self.answer(404, {"error": "there is no such order, or no mesh of it yet"})
        elif what:
            with open(order["mesh"], "rb") as mesh:
                self.answer(200, mesh.read(), "model/stl")
        else:
            self.answer(200, {name: value for name, value in order.items() if name not in ("file", "mesh")})

    def reply(self, number, query):
        accepts = query.get("accept") == "changes"
        if not number.isdigit() or not self.orders.reply(int(number), query.get("units", ""), accepts):
            self.answer(409, {"error": "this order waits for no answer"})
            return
        order = self.orders.get(int(number))
        self.answer(202, {"order": order["number"], "job": self.send_now(order)})

    def place(self, policy, units):
        mesh = self.body(MESH_BYTES_MAX)
        if mesh is None:
            return
        file = os.path.join(self.folder, os.urandom(16).hex())
        with open(file, "wb") as out:
            out.write(mesh)
        number = self.orders.place(policy, units, file)
        self.answer(202, {"order": number, "job": self.send_now(self.orders.get(number))})

    def send_now(self, order):
        try:
            return send(self.orders, self.meshmend, order)
        except OSError:
            # It is sent again later.
            return None

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
            order = self.orders.get(int(job["labels"]["order"]))
            # A call about an order that has been answered since says nothing about it.
            if order and job["labels"]["version"] == str(order["version"]):
                report = self.meshmend.report(job["id"]) if job["state"] == "succeeded" else None
                figures = figures_of(job, report, order)
                if figures["state"] == "quoted":
                    figures["mesh"] = self.keep_mesh(order, job)
                self.orders.quote(message, order["number"], job["id"], figures)
        self.answer(200, {})

    def keep_mesh(self, order, job):
        """Downloads what will be printed: the service keeps it for a while only."""
        path = os.path.join(self.folder, f"{key_of(order)}.stl")
        with open(path, "wb") as out:
            out.write(self.meshmend.mesh(job["id"]))
        return path

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
        figures = figures_of({"state": "failed", "problem": {"code": problem}}, None, order)
        orders.quote(key_of(order), order["number"], None, figures)
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
