#!/usr/bin/env python3
"""How long the service takes to answer for a mesh of 12 triangles, each a new one, and for one that it has answered before: one caller on
loopback, one connection; prints Markdown rows in milliseconds.

usage: small_answers.py [--binary PATH] [--calls 300]
"""
import argparse
import http.client
import struct
import time

from campaign_server import Server, default_binary, quantile

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--calls", type=int, default=300)
o = p.parse_args()
CORNERS = [(10.0 * (i & 1), 10.0 * (i >> 1 & 1), 10.0 * (i >> 2)) for i in range(8)]
FACES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def cube(name):
    """A cube as binary STL whose header is its name."""
    triangles = b"".join(struct.pack("<12fH", 0, 0, 0, *CORNERS[a], *CORNERS[b], *CORNERS[c], 0) for a, b, c in FACES)
    return name.encode().ljust(80) + struct.pack("<I", len(FACES)) + triangles


with Server(o.binary) as server:
    connection = http.client.HTTPConnection("127.0.0.1", server.port)

    def milliseconds(operation, body):
        begun = time.perf_counter()
        connection.request("POST", f"/v1/{operation}", body)
        response = connection.getresponse()
        response.read()
        if response.status != 200:
            raise SystemExit(f"{operation}: {response.status}")
        return 1000 * (time.perf_counter() - begun)

    print("| operation | new: median | 99 of 100 | answered before: median | 99 of 100 |\n|---|---|---|---|---|")
    for operation in ("verify", "repair"):
        new = [milliseconds(operation, cube(f"{operation} {number}")) for number in range(o.calls)]
        known = [milliseconds(operation, cube(f"{operation} 0")) for _ in range(o.calls)]
        print(f"| `{operation}` | " + " | ".join(f"{quantile(times, share):.1f}" for times in (new, known) for share in (0.5, 0.99)) + " |")
