#!/usr/bin/env python3
"""Restarts of the service while clients send work: every accepted job must succeed; prints Markdown.

usage: restarts.py [--binary PATH] [--restarts 10] [--every 6]
Clients repeat what is not answered or answered 503 (with the same Idempotency-Key) and wait for each job's end; the
server is ended with SIGTERM and started again on the same ports and folder.
"""
import argparse
import http.client
import json
import threading
import time

from campaign_server import Server, commit, default_binary, quantile, sphere_stl

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--restarts", type=int, default=10)
p.add_argument("--every", type=float, default=6)
p.add_argument("--clients", type=int, default=6)
o = p.parse_args()
SMALL, LARGE = sphere_stl(24), sphere_stl(300)
over, rows, lock = threading.Event(), [], threading.Lock()


def patient(port, method, path, body=None, headers={}):
    """The answer, asked for until there is one; the number of tries without."""
    tries = 0
    while True:
        try:
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=90)
            connection.request(method, path, body, headers)
            response = connection.getresponse()
            content = response.read()
            if response.status not in (429, 503):
                return response.status, content, tries
            time.sleep(0.2)
        except (OSError, http.client.HTTPException):
            time.sleep(0.05)
        tries += 1


def client(port, number):
    count = 0
    while not over.is_set():
        count += 1
        mesh = LARGE if count % 5 == 0 else SMALL
        body = b"%-80d" % (number * 1_000_000 + count) + mesh[80:]
        begun = time.monotonic()
        status, content, tries = patient(port, "POST", "/v1/jobs?operation=repair", body, {"Idempotency-Key": f"{number}-{count}"})
        job = json.loads(content)
        while status < 300 and not job["finished_at"]:
            status, content, more = patient(port, "GET", job["links"]["self"] + "?wait=20")
            job, tries = json.loads(content), tries + more
        with lock:
            rows.append((status, job.get("state"), job.get("attempts"), tries, time.monotonic() - begun))


downs = []
with Server(o.binary) as server:
    threads = [threading.Thread(target=client, args=(server.port, n)) for n in range(o.clients)]
    for thread in threads:
        thread.start()
    for _ in range(o.restarts):
        time.sleep(o.every)
        begun = time.monotonic()
        server.restart()
        downs.append(time.monotonic() - begun)
    time.sleep(o.every)
    over.set()
    for thread in threads:
        thread.join()
states = {state: sum(1 for row in rows if row[1] == state) for state in sorted({str(row[1]) for row in rows})}
print(f"# Restarts under load\n\n{o.restarts} restarts, one each {o.every:g} s, while {o.clients} clients repair meshes of {len(SMALL) // 1000} kB and, each fifth, {len(LARGE) / 1e6:.0f} MB.\n"
      f"From SIGTERM until the next server listens: p50 {quantile(downs, .5):.1f} s, longest {max(downs):.1f} s. Made by `scripts/campaign.sh restarts` at commit {commit()}.\n")
print("| | |\n|---|---|")
print(f"| jobs | {len(rows)} |")
for state, count in states.items():
    print(f"| {state} | {count} |")
print(f"| requests that were tried again | {sum(row[3] for row in rows)} |\n| most attempts counted of a job | {max(row[2] or 0 for row in rows)} |")
print(f"| time of a job with its waits | p50 {quantile([row[4] for row in rows], .5):.2f} s, longest {max(row[4] for row in rows):.1f} s |")
fine = list(states) == ["succeeded"] and len(rows) > 10 * o.restarts
print(f"\nNo job failed: {'yes' if fine else 'NO'}.")
raise SystemExit(not fine)
