#!/usr/bin/env python3
"""What the service adds to the engine's time for a mesh of 1 MB: process, store and files; prints Markdown.

usage: overhead.py [--binary PATH] [--requests 300]
overhead = total as the client sees it - engine (`timing_ms.total` of the report) - syncs x this disk's median sync of their kind.
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

from campaign_server import Server, commit, default_binary, processor_ticks, quantile, share_taken, sphere_stl

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


def median_syncs(folder, count=60):
    """Median milliseconds of a sync, by what is synced, in the order in which a request does it."""
    times = {"a new file as large as the mesh": [], "a directory with a new entry": [], "an appended log (32 kB)": [], "a new small file": []}

    def sync(kind, descriptor):
        begun = time.perf_counter()
        os.fsync(descriptor)
        times[kind].append((time.perf_counter() - begun) * 1e3)

    def new_file(kind, name, content):
        with open(os.path.join(folder, name), "xb") as file:
            file.write(content)
            file.flush()
            sync(kind, file.fileno())
        directory = os.open(folder, os.O_RDONLY)
        sync("a directory with a new entry", directory)
        os.close(directory)

    with open(os.path.join(folder, "log"), "ab") as log:
        for number in range(count):
            new_file("a new file as large as the mesh", f"large-{number}", mesh(number))
            log.write(bytes(32 << 10))
            log.flush()
            sync("an appended log (32 kB)", log.fileno())
            time.sleep(0.02)
            new_file("a new small file", f"small-{number}", bytes(4096))
    return {kind: statistics.median(values) for kind, values in times.items()}


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


# What one request syncs: its upload, its row (made and claimed together, ended), its report.
SYNCS = {"a new file as large as the mesh": 1, "a directory with a new entry": 2, "an appended log (32 kB)": 2, "a new small file": 1}

counted = syncs_of_a_request(o.binary)
if abs(counted - sum(SYNCS.values())) > 0.5:
    raise SystemExit(f"a request has {counted} syncs, not {sum(SYNCS.values())}")
with Server(o.binary) as server:
    connection = http.client.HTTPConnection("127.0.0.1", server.port)
    before = tempfile.mkdtemp(dir=server.folder)
    medians = median_syncs(before)
    for number in range(20):
        ask(connection, number)
    ticks = processor_ticks()
    rows = [ask(connection, 100 + number) for number in range(o.requests)]
    taken = share_taken(ticks)
disk = sum(count * medians[kind] for kind, count in SYNCS.items())
overhead = [total - engine - disk for total, engine in rows]
print(f"# Overhead of the service\n\n{o.requests} repairs of a mesh of {len(MESH) / 1e6:.2f} MB ({(len(MESH) - 84) // 50} triangles, all of them different files), one after the other, each in a\n"
      f"process of its own. Meanwhile the host of this virtual machine gave {taken:.1%} of its processors to others. Made by\n"
      f"`scripts/campaign.sh overhead` at commit {commit()}.\n")
print("| ms | p50 | p99 |\n|---|---|---|")
for name, values in (("total as the client sees it", [t for t, _ in rows]), ("engine", [e for _, e in rows]), ("total - engine", [t - e for t, e in rows]), ("overhead: that without the disk", overhead)):
    print(f"| {name} | {quantile(values, .5):.1f} | {quantile(values, .99):.1f} |")
print(f"\nThe disk: {counted:.1f} syncs a request (counted with strace), {disk:.1f} ms together by this disk's medians:\n")
print("| sync of | a request | median |\n|---|---|---|")
for kind, count in SYNCS.items():
    print(f"| {kind} | {count} | {medians[kind]:.2f} ms |")
targets = {"overhead p50 at most 5 ms": quantile(overhead, .5) <= 5, "overhead p99 at most 15 ms": quantile(overhead, .99) <= 15}
print()
for name, is_met in targets.items():
    print(f"- {name}: {'yes' if is_met else 'NO'}")
raise SystemExit(not all(targets.values()))
