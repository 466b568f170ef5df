#!/usr/bin/env python3
"""What a job costs the database and the bucket, and what servers cost that do nothing; prints Markdown.

usage: scaling.py [--binary PATH] [--s3 PATH] [--jobs 300] [--idle 30]
One server takes requests, one runs jobs, on PostgreSQL with pg_stat_statements and an S3 server behind a proxy that counts requests.
"""
import argparse
import collections
import http.client
import json
import os
import socket
import tempfile
import threading
import time

from campaign_server import commit, default_binary, free_ports, quantile, sphere_stl
from shared_stores import Town, default_s3

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--s3", default=default_s3)
p.add_argument("--jobs", type=int, default=300)
p.add_argument("--idle", type=float, default=30)
p.add_argument("--clients", type=int, default=16)
o = p.parse_args()
MESH = sphere_stl(12)


class Counter:
    """A proxy that counts the requests of connections without TLS."""

    def __init__(self, port):
        self.port, self.to, self.requests = free_ports(1)[0], port, collections.Counter()
        self.listener = socket.create_server(("127.0.0.1", self.port))
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            client, _ = self.listener.accept()
            server = socket.create_connection(("127.0.0.1", self.to))
            for one, other, counts in ((client, server, True), (server, client, False)):
                one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                threading.Thread(target=self.pass_on, args=(one, other, counts), daemon=True).start()

    def pass_on(self, one, other, counts):
        try:
            while piece := one.recv(1 << 16):
                # A head comes in one piece, since clients send it by itself.
                method = piece.split(b" ", 1)[0]
                if counts and method in (b"GET", b"PUT", b"HEAD", b"DELETE", b"POST"):
                    self.requests[method.decode() + (" (list)" if b"list-type=2" in piece[:2000] else "")] += 1
                other.sendall(piece)
            other.shutdown(socket.SHUT_WR)
        except OSError:
            other.close()


def numbers(town):
    """What the database has done so far."""
    # Sessions tell what they did once a second at most.
    time.sleep(1.5)
    columns = ["statements", "milliseconds in statements"]
    row = town.database.ask("SELECT sum(calls), sum(total_exec_time) FROM pg_stat_statements")[0]
    told = dict(zip(columns, map(float, row)))
    for name, sql in {
        "transactions": "SELECT xact_commit FROM pg_stat_database WHERE datname = 'postgres'",
        "records of the log": "SELECT wal_records FROM pg_stat_wal",
        "bytes of the log": "SELECT wal_bytes FROM pg_stat_wal",
        "syncs of the log": "SELECT wal_sync FROM pg_stat_wal",
        "rows written": "SELECT sum(n_tup_ins + n_tup_upd + n_tup_del) FROM pg_stat_user_tables",
    }.items():
        told[name] = float(town.database.ask(sql)[0][0] or 0)
    return told


def sync_ms():
    """Median time of a small write that is synced, in milliseconds."""
    with tempfile.NamedTemporaryFile(dir=town.database.folder) as file:
        times = []
        for _ in range(200):
            begun = time.perf_counter()
            os.pwrite(file.fileno(), b"x" * 8192, 0)
            os.fdatasync(file.fileno())
            times.append((time.perf_counter() - begun) * 1e3)
    return quantile(times, 0.5)


def post(port, number):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("POST", "/v1/jobs?operation=repair", f"{number:<80}".encode() + MESH[80:])
    response = connection.getresponse()
    content = response.read()
    assert response.status == 202, content
    return json.loads(content)["id"]


def get(port, path):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=90)
    connection.request("GET", path)
    return json.loads(connection.getresponse().read())


def difference(now, then, by):
    return {name: (now[name] - then[name]) / by for name in now}


def rows_of(costs):
    return "\n".join(f"| {name} | {cost:,.2f} |" for name, cost in costs.items())


def all_posted(port, count, first):
    """Posts jobs from many clients at one time. How many a second, and their ids."""
    ids, lock, left = [], threading.Lock(), iter(range(first, first + count))

    def client():
        while True:
            with lock:
                number = next(left, None)
            if number is None:
                return
            ids.append(post(port, number))

    threads, begun = [threading.Thread(target=client) for _ in range(o.clients)], time.perf_counter()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return count / (time.perf_counter() - begun), ids


with Town(o.binary, o.s3, shared_preload_libraries="pg_stat_statements") as town:
    town.database.ask("CREATE EXTENSION pg_stat_statements")
    proxy = Counter(town.bucket.port)
    town.shared[town.shared.index("--blobs-endpoint") + 1] = f"http://127.0.0.1:{proxy.port}"
    settings = ["--queue-max", "100000", "--interactive-slots", "0", "--slots", "2", "--owner-slots-max", "2"]
    api, worker = town.server("api", *settings), town.server("worker", *settings)
    post(api.port, 0)
    time.sleep(3)
    town.database.ask("SELECT pg_stat_statements_reset()")
    then, begun = numbers(town), time.perf_counter()
    time.sleep(o.idle)
    now = numbers(town)
    idle = difference(now, then, 2 * (time.perf_counter() - begun))
    # One after the other, each waited for.
    then, asked, times = numbers(town), proxy.requests.copy(), []
    for number in range(1, o.jobs + 1):
        begun = time.perf_counter()
        job = post(api.port, number)
        ended = get(api.port, f"/v1/jobs/{job}?wait=60")
        assert ended["state"] == "succeeded", ended
        times.append((time.perf_counter() - begun) * 1e3)
    now = numbers(town)
    took = sum(times) / 1e3 + 1.5
    each = {name: cost - idle[name] * 2 * took / o.jobs for name, cost in difference(now, then, o.jobs).items()}
    requests = {f"{name} at the bucket": (count - asked[name]) / o.jobs for name, count in sorted(proxy.requests.items()) if "list" not in name}
    kept = {name: float(town.database.ask(f"SELECT count(*) FROM {name}")[0][0]) / (o.jobs + 1) for name in ("jobs", "names", "changes")}
    size = float(town.database.ask("SELECT sum(pg_total_relation_size(relid)) FROM pg_stat_user_tables")[0][0]) / (o.jobs + 1)
    stored = sum(os.path.getsize(path) for path in town.bucket.files().values()) / (o.jobs + 1)
    top = town.database.ask("SELECT calls, round(mean_exec_time::numeric, 3), left(regexp_replace(query, '\\s+', ' ', 'g'), 90) FROM pg_stat_statements ORDER BY total_exec_time DESC LIMIT 12")
    # As many at one time as there are clients, while nothing runs them.
    worker.stop()
    rate, ids = all_posted(api.port, o.jobs, 10_000_000)
    worker.start()
    begun = time.perf_counter()
    for job in ids:
        while get(api.port, f"/v1/jobs/{job}?wait=60")["state"] != "succeeded":
            pass
    drained = len(ids) / (time.perf_counter() - begun)
    disk = sync_ms()
    for server in (api, worker):
        server.__exit__()

print(f"""At commit {commit()}, {o.jobs} jobs (repair of a sphere of {(len(MESH) - 84) // 50} triangles, {len(MESH)} bytes), one server that takes requests, one that runs jobs with two
slots, PostgreSQL and the S3 server on one machine of {os.cpu_count()} cores; its load was {os.getloadavg()[0]:.1f} at the end. A small synced write took {disk:.2f} ms
(median).

| what one job costs, one after the other | number |
| --- | --- |
{rows_of(each)}
{rows_of(requests)}
| milliseconds from the request to the end, median | {quantile(times, 0.5):.1f} |

| what is kept of a job | number |
| --- | --- |
{rows_of({f"rows of {name}": count for name, count in kept.items()})}
| bytes in the database with its indexes | {size:,.0f} |
| bytes in the bucket | {stored:,.0f} |

| what a server costs in a second that does nothing | number |
| --- | --- |
{rows_of(idle)}

| at one time | jobs a second |
| --- | --- |
| taken in, {o.clients} clients, nothing runs | {rate:.0f} |
| run by two slots from a full queue | {drained:.1f} |

| calls | mean ms | the statements that take most time |
| --- | --- | --- |
{chr(10).join("| " + " | ".join(row[:2]) + " | `" + row[2] + "` |" for row in top)}
""")
