#!/usr/bin/env python3
"""What the service adds to the engine's time for a mesh of 1 MB: process, store and files; prints Markdown.

usage: overhead.py [--binary PATH] [--requests 300]
overhead = total as the client sees it - engine (`timing_ms.total` of the report) - syncs x this disk's median sync.
The syncs of one request are counted with strace in a run of its own.
"""
import argparse
import http.client
import json
import os
import re
import shutil
import statistics
import subprocess
import tempfile
import time

from campaign_server import Server, commit, default_binary, quantile, sphere_stl

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--requests", type=int, default=300)
o = p.parse_args()
MESH = sphere_stl(71)


def mesh(number):
    """The mesh under a header of its own, so that no request is answered from an earlier one."""
    return b"%-80d" % number + MESH[80:]


def ask(connection, number):
    """Milliseconds of one request: as the client sees it, and of the engine."""
    body = mesh(number)
    begun = time.perf_counter()
    connection.request("POST", "/v1/repair", body, {"Accept": "application/json"})
    response = connection.getresponse()
    content = response.read()
    total = time.perf_counter() - begun
    if response.status != 200:
        raise SystemExit(f"{response.status}: {content[:500]}")
    return total * 1e3, json.loads(content)["timing_ms"]["total"]


def median_sync(folder, size, count=200):
    """Milliseconds of a sync after `size` bytes were appended to a file."""
    times = []
    with open(os.path.join(folder, "sync"), "ab") as file:
        for _ in range(count):
            file.write(os.urandom(size))
            file.flush()
            begun = time.perf_counter()
            os.fsync(file.fileno())
            times.append((time.perf_counter() - begun) * 1e3)
    os.remove(file.name)
    return statistics.median(times)


def syncs_of_a_request(binary, requests=20):
    """Calls of fsync and fdatasync by the server for one request, on average."""
    if not shutil.which("strace"):
        raise SystemExit("strace is missing: it counts the syncs")
    with Server(binary) as server, tempfile.NamedTemporaryFile("r") as counts:
        connection = http.client.HTTPConnection("127.0.0.1", server.port)
        ask(connection, 10**9)
        time.sleep(1)
        strace = subprocess.Popen(["strace", "-f", "-qq", "-e", "trace=fsync,fdatasync", "-o", counts.name, "-p", str(server.process.pid)])
        time.sleep(1)
        for number in range(requests):
            ask(connection, 10**9 + 1 + number)
        time.sleep(0.5)
        strace.terminate()
        strace.wait()
        # A call that another thread's came into stands on two lines: only where it begins does it have its argument.
        return len(re.findall(r"\bf(?:data)?sync\(\d", counts.read())) / requests


syncs = syncs_of_a_request(o.binary)
with Server(o.binary) as server:
    connection = http.client.HTTPConnection("127.0.0.1", server.port)
    small, whole = median_sync(server.folder, 4096), median_sync(server.folder, len(MESH), 50)
    for number in range(20):
        ask(connection, number)
    rows = [ask(connection, 100 + number) for number in range(o.requests)]
    small = statistics.median([small, median_sync(server.folder, 4096)])
disk = syncs * small
overhead = [total - engine - disk for total, engine in rows]
print(f"# Overhead of the service\n\n{o.requests} repairs of a mesh of {len(MESH) / 1e6:.2f} MB ({(len(MESH) - 84) // 50} triangles, all of them different files), one after the other, each in a\n"
      f"process of its own. Made by `scripts/campaign.sh overhead` at commit {commit()}.\n")
print("| ms | p50 | p99 |\n|---|---|---|")
for name, values in (("total as the client sees it", [t for t, _ in rows]), ("engine", [e for _, e in rows]), ("total - engine", [t - e for t, e in rows]), ("overhead: that without the disk", overhead)):
    print(f"| {name} | {quantile(values, .5):.1f} | {quantile(values, .99):.1f} |")
print(f"\nThe disk: {syncs:.1f} syncs a request, a median of {small:.2f} ms each after 4 kB ({whole:.2f} ms after the whole mesh): {disk:.1f} ms a request.")
targets = {"overhead p50 at most 5 ms": quantile(overhead, .5) <= 5, "overhead p99 at most 15 ms": quantile(overhead, .99) <= 15}
print()
for name, is_met in targets.items():
    print(f"- {name}: {'yes' if is_met else 'NO'}")
raise SystemExit(not all(targets.values()))
