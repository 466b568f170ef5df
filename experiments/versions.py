#!/usr/bin/env python3
"""An older program and this one on the same stores, under load; prints Markdown.

usage: versions.py --older PATH [--binary PATH] [--s3 PATH] [--seconds 30]
Two servers of the older program, one for requests and one that runs jobs, share PostgreSQL and S3. Then two of this program come, which bring
the tables to their version; all four work side by side; then the older ones end. In each of the three parts clients send jobs to every
server that runs, and ask another one how they ended. Every accepted job must succeed, whichever program took it, ran it or is asked.
"""
import argparse
import collections
import http.client
import json
import subprocess
import sys
import threading
import time

from campaign_server import commit, default_binary, sphere_stl
from shared_stores import Town, default_s3

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--older", required=True)
p.add_argument("--binary", default=default_binary)
p.add_argument("--s3", default=default_s3)
p.add_argument("--seconds", type=float, default=30, help="for each part")
p.add_argument("--clients", type=int, default=4)
o = p.parse_args()
MESH = sphere_stl(24)
lock, over = threading.Lock(), threading.Event()
open_servers, rows, part = [], [], "the older alone"


def asked(server, method, path, body=None, headers={}):
    """Status and JSON of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    connection.request(method, path, body, headers)
    response = connection.getresponse()
    content = response.read()
    return response.status, json.loads(content) if content else None


def client(number):
    count = 0
    while not over.is_set():
        count += 1
        key, began_in = f"{number}-{count}", part
        body = f"{key:<80}".encode() + MESH[80:]
        tries, job = 0, None
        while job is None or job["finished_at"] is None:
            with lock:
                name, server = open_servers[(number + count + tries) % len(open_servers)]
            try:
                if job is None:
                    status, told = asked(server, "POST", "/v1/jobs?operation=repair", body, {"Idempotency-Key": key})
                    taken_by = name
                else:
                    status, told = asked(server, "GET", f"/v1/jobs/{job['id']}?wait=10")
            except (OSError, http.client.HTTPException):
                status, told = None, None
            if status in (200, 202):
                job, tries = told, tries + 1
            elif status in (None, 503):
                tries += 1
                time.sleep(0.05)
            else:
                job = {"finished_at": "never", "state": f"{status}: {told}"}
        with lock:
            rows.append((began_in, taken_by, name, job["state"]))


def version(binary):
    return subprocess.run([binary, "--version"], capture_output=True, text=True, check=True).stdout.strip()


with Town(o.binary, o.s3) as town:
    settings = ["--queue-max", "10000", "--slots", "1", "--owner-slots-max", "4"]
    started = []

    def open_pair(program):
        town.binary = o.older if program == "older" else o.binary
        api, worker = town.server("api", *settings), town.server("worker", *settings)
        started.extend([api, worker])
        with lock:
            open_servers.append((program, api))
        return api, worker

    older = open_pair("older")
    before = town.database.ask("SELECT max(number) FROM versions")[0][0]
    clients = [threading.Thread(target=client, args=(number,)) for number in range(o.clients)]
    for thread in clients:
        thread.start()
    time.sleep(o.seconds)
    newer, part = open_pair("newer"), "both"
    after = town.database.ask("SELECT max(number) FROM versions")[0][0]
    time.sleep(o.seconds)
    with lock:
        open_servers.pop(0)
    for server in older:
        server.stop()
    part = "the newer alone"
    time.sleep(o.seconds)
    over.set()
    for thread in clients:
        thread.join()
    for server in newer:
        server.stop()
    for server in started:
        server.log.close()

table = collections.Counter((began, taken, told) for began, taken, told, _ in rows)
lines = "\n".join(f"| {began} | {taken} | {told} | {count} |" for (began, taken, told), count in sorted(table.items()))
bad = [state for *_, state in rows if state != "succeeded"]
print(f"""# Campaign `versions`

Made by `experiments/versions.py` at commit {commit()}. The tables were of version {before}, which the older program had made, and of version {after} from the start
of the newer one on. {len(rows)} jobs were accepted, of which {len(rows) - len(bad)} succeeded{''.join(f'; {state}' for state in sorted(set(bad)))}.

| sent while there ran | taken by a server of | its end told by a server of | jobs |
| --- | --- | --- | --- |
{lines}
""")
sys.exit(bool(bad) or before == after)
