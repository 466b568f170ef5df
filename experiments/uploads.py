#!/usr/bin/env python3
"""Memory of the server while large uploads come in side by side; prints Markdown.

usage: uploads.py [--binary PATH] [--uploads 8] [--mebibytes 512]
The last byte of each upload is held back until all the others are there and the memory is read, so that no job begins.
"""
import argparse
import os
import socket
import threading
import time

from campaign_server import Server, commit, default_binary

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--uploads", type=int, default=8)
p.add_argument("--mebibytes", type=int, default=512)
o = p.parse_args()
BLOCK, size = os.urandom(1 << 20), o.mebibytes << 20
sent, failures, held = [0] * o.uploads, [], threading.Event()


def upload(port, number):
    """All but the last byte."""
    try:
        with socket.create_connection(("127.0.0.1", port)) as s:
            s.sendall(b"POST /v1/jobs?operation=verify HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n" % size)
            while sent[number] < size - 1:
                piece = BLOCK[: min(len(BLOCK), size - 1 - sent[number])]
                s.sendall(piece)
                sent[number] += len(piece)
            held.wait()
    except OSError as error:
        failures.append(str(error))


with Server(o.binary, f"--upload-bytes-max={o.mebibytes}MiB") as server:
    time.sleep(1)
    idle = server.anonymous_bytes()
    threads = [threading.Thread(target=upload, args=(server.port, n)) for n in range(o.uploads)]
    begun, most = time.monotonic(), 0
    for thread in threads:
        thread.start()
    while sum(sent) < o.uploads * (size - 1) and not failures and time.monotonic() - begun < 1800:
        most = max(most, server.anonymous_bytes())
        time.sleep(0.02)
    seconds = time.monotonic() - begun
    most = max(most, server.anonymous_bytes())
    held.set()
    for thread in threads:
        thread.join()
mebibytes = lambda n: f"{n / (1 << 20):.1f} MiB"
print(f"# Parallel uploads\n\n{o.uploads} uploads of {o.mebibytes} MiB at one time in {seconds:.0f} s. Made by `scripts/campaign.sh uploads` at commit {commit()}.\n")
print("| anonymous memory of server and children | |\n|---|---|")
print(f"| idle | {mebibytes(idle)} |\n| most while the uploads came in | {mebibytes(most)} |\n| above idle | {mebibytes(most - idle)} |")
fine = not failures and most - idle <= 64 << 20
print(f"\nAt most 64 MiB above idle: {'yes' if fine else 'NO'}.{' Failures: ' + '; '.join(failures) if failures else ''}")
raise SystemExit(not fine)
