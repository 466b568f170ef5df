#!/usr/bin/env python3
"""Time from the cancel of a running job until its processor and memory are free; prints Markdown.

usage: cancel.py [--binary PATH] [--cancels 200]
Each job repairs a large broken mesh and is cancelled at a random moment of its run. It is over when the server has no
child any more and the anonymous memory of server and children is back within 4 MiB of what it was before the job.
"""
import argparse
import http.client
import json
import os
import random
import time

from campaign_server import Server, commit, default_binary, quantile, sphere_stl

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--cancels", type=int, default=200)
o = p.parse_args()
RINGS, SLACK = 110, 4 << 20
dice = random.Random(6)


def broken(number):
    """Two spheres that cross, without some of their triangles, under a header of their own."""
    one, other = sphere_stl(RINGS), sphere_stl(RINGS, at=(7.3, 1.1, 0.6))
    triangles = [row[i:i + 50] for row in (one[84:], other[84:]) for i in range(0, len(row), 50)]
    kept = [t for i, t in enumerate(triangles) if (i * 2654435761 + number) % 997]
    return b"%-80d" % number + len(kept).to_bytes(4, "little") + b"".join(kept)


def ask(connection, method, path, body=None):
    connection.request(method, path, body)
    response = connection.getresponse()
    content = response.read()
    if response.status >= 300:
        raise SystemExit(f"{method} {path}: {response.status} {content[:300]}")
    return json.loads(content)


def run(connection, server, number, delay, rows):
    """One job, cancelled `delay` seconds after it began to run."""
    before = server.anonymous_bytes()
    job = ask(connection, "POST", "/v1/jobs?operation=repair", broken(number))
    path = job["links"]["self"]
    while not server.children_at_work():
        time.sleep(0.001)
    time.sleep(delay)
    most = server.anonymous_bytes()
    begun = time.perf_counter()
    ask(connection, "POST", path + "/cancel")
    answered = time.perf_counter() - begun
    while server.children_at_work():
        time.sleep(0.0005)
    ended = time.perf_counter() - begun
    while server.anonymous_bytes() > before + SLACK:
        time.sleep(0.001)
        if time.perf_counter() - begun > 10:
            break
    freed = time.perf_counter() - begun
    job = ask(connection, "GET", path + "?wait=10")
    rows.append((answered * 1e3, ended * 1e3, freed * 1e3, job["state"], most - before))


rows = []
with Server(o.binary) as server:
    connection = http.client.HTTPConnection("127.0.0.1", server.port)
    wholes = []
    for number in range(3):
        begun = time.monotonic()
        whole = ask(connection, "POST", "/v1/jobs?operation=repair", broken(number))
        assert ask(connection, "GET", whole["links"]["self"] + "?wait=120")["finished_at"], "the whole job takes too long"
        wholes.append(time.monotonic() - begun)
    seconds, size = min(wholes), len(broken(0))
    for number in range(3, o.cancels + 3):
        run(connection, server, number, dice.uniform(0, 0.9 * seconds), rows)
states = {state: sum(1 for row in rows if row[3] == state) for state in sorted({row[3] for row in rows})}
cancelled = [row for row in rows if row[3] == "cancelled"]
print(f"# Cancel of a running job\n\n{o.cancels} repairs of {size / 1e6:.1f} MB ({seconds:.1f} s each, when left alone), cancelled at random moments of the first nine tenths.\n"
      f"Memory of a job when it was cancelled: at most {max(row[4] for row in rows) / (1 << 20):.0f} MiB. Made by `scripts/campaign.sh service-cancel` at commit {commit()}.\n")
print("States: " + ", ".join(f"{count} {state}" for state, count in states.items()) + ".\n")
print("| ms after the cancel | p50 | p99 | longest |\n|---|---|---|---|")
for place, name in enumerate(("the cancel is answered", "the child is gone, its processor free", "its memory is free")):
    values = [row[place] for row in cancelled]
    print(f"| {name} | {quantile(values, .5):.1f} | {quantile(values, .99):.1f} | {max(values):.1f} |")
fine = len(cancelled) >= 0.9 * o.cancels and quantile([row[2] for row in cancelled], .99) <= 250
print(f"\nProcessor and memory are free within 250 ms (p99): {'yes' if fine else 'NO'}.")
raise SystemExit(not fine)
