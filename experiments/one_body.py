#!/usr/bin/env python3
"""Takes one body out of a binary STL file that holds several: triangles that share corners, bit for bit, are one body; bodies are numbered from the one with most triangles. Needs nothing but Python.

usage: one_body.py IN NUMBER OUT
"""
import struct, sys

source, number, target = sys.argv[1], int(sys.argv[2]), sys.argv[3]
data = open(source, "rb").read()
records = [data[84 + 50 * i:134 + 50 * i] for i in range(struct.unpack_from("<I", data, 80)[0])]
corners = [[record[12 + 12 * k:24 + 12 * k] for k in range(3)] for record in records]
parent = {corner: corner for triangle in corners for corner in triangle}


def first(corner):
    while parent[corner] != corner:
        parent[corner] = parent[parent[corner]]
        corner = parent[corner]
    return corner


for a, b, c in corners:
    parent[first(b)] = first(a)
    parent[first(c)] = first(a)
bodies = {}
for record, triangle in zip(records, corners):
    bodies.setdefault(first(triangle[0]), []).append(record)
body = sorted(bodies.values(), key=len, reverse=True)[number]
open(target, "wb").write(bytes(80) + struct.pack("<I", len(body)) + b"".join(body))
print(f"{len(bodies)} bodies; number {number} has {len(body)} triangles")
