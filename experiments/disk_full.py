#!/usr/bin/env python3
"""A disk that fills up and a store that does not answer: what callers hear, and that the service recovers by itself; prints Markdown.

usage: disk_full.py [--binary PATH]
Needs root: the data folder lies on a file system in memory of 64 MiB that is mounted for it.
"""
import argparse
import http.client
import json
import os
import sqlite3
import subprocess
import tempfile
import time

from campaign_server import Server, commit, default_binary, sphere_stl

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
o = p.parse_args()
MESH = sphere_stl(40)
rows, count = [], iter(range(1 << 30))


def ask(server, method, path, body=None):
    """Status, problem code and JSON of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    connection.request(method, path, body, {"Accept": "application/json"})
    response = connection.getresponse()
    answer = json.loads(response.read())
    return response.status, answer.get("code", "") if isinstance(answer, dict) else "", answer


def expect(server, situation, status, code=""):
    """Verifies a new mesh and notes what came of it."""
    begun = time.monotonic()
    got = ask(server, "POST", "/v1/verify", b"%-80d" % next(count) + MESH[80:])
    rows.append((situation, f"{got[0]} {got[1]}".strip(), f"{time.monotonic() - begun:.2f} s", got[:2] == (status, code)))


def fill(path, leave):
    """A file that leaves so many bytes of the disk."""
    disk = os.statvfs(os.path.dirname(path))
    size = max(0, disk.f_bavail * disk.f_frsize - leave)
    with open(path, "ab") as file:
        os.posix_fallocate(file.fileno(), 0, file.tell() + size)


mount = tempfile.mkdtemp(prefix="meshmend-disk-")
subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64m", "tmpfs", mount], check=True)
try:
    tempfile.tempdir = mount
    with Server(o.binary, "--disk-free-bytes-min=8MiB") as server:
        filler = os.path.join(mount, "filler")
        kept = ask(server, "POST", "/v1/jobs?operation=verify", MESH)[2]["links"]["self"]
        expect(server, "room enough", 200)
        fill(filler, 6 << 20)
        expect(server, "less room than `disk_free_bytes_min`", 507, "storage-full")
        fill(filler, 0)
        expect(server, "no room at all", 507, "storage-full")
        is_kept = ask(server, "GET", kept)[2]["state"] == "succeeded"
        rows.append(("no room at all: an earlier job", "succeeded" if is_kept else "lost", "", is_kept))
        os.remove(filler)
        expect(server, "room again", 200)
        store = sqlite3.connect(os.path.join(server.folder, "data", "jobs.sqlite3"), isolation_level=None)
        store.execute("BEGIN IMMEDIATE")
        expect(server, "another process holds the store", 503, "store-unavailable")
        is_kept = ask(server, "GET", kept)[2]["state"] == "succeeded"
        rows.append(("another process holds the store: an earlier job", "succeeded" if is_kept else "lost", "", is_kept))
        store.close()
        expect(server, "the store answers again", 200)
        is_alive = server.process.poll() is None
finally:
    subprocess.run(["umount", mount], check=False)
    os.rmdir(mount)
print(f"# A full disk and a store that does not answer\n\nOne server, never restarted, its data on a file system of 64 MiB. Made by `scripts/campaign.sh disk-full` at commit {commit()}.\n")
print("| situation | a new mesh | after | as expected |\n|---|---|---|---|")
for situation, answer, seconds, is_met in rows:
    print(f"| {situation} | {answer} | {seconds} | {'yes' if is_met else 'NO'} |")
raise SystemExit(not (is_alive and all(row[3] for row in rows)))
