#!/usr/bin/env python3
"""Writes a wavy torus with 2 * RINGS * SIDES triangles as binary STL, ring by ring, so that files of any size can be made. Needs numpy.

usage: large_torus.py RINGS SIDES OUT        10000 5000 makes 100 million triangles, 5 GB
"""
import struct
import sys

import numpy as np

rings, sides, path = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
around = np.linspace(0, 2 * np.pi, sides, endpoint=False)
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def ring(number):
    """The vertices of a ring."""
    angle = 2 * np.pi * (number % rings) / rings
    radius = 30 + 0.5 * np.sin(40 * angle)
    far = 100 + radius * np.cos(around)
    return np.stack([far * np.cos(angle), far * np.sin(angle), radius * np.sin(around)], 1).astype("<f4")


with open(path, "wb") as out:
    out.write(b"torus".ljust(80) + struct.pack("<I", 2 * rings * sides))
    last = ring(0)
    for number in range(rings):
        this = ring(number + 1)
        triangles = np.zeros(2 * sides, TRIANGLE)
        triangles["corners"][0::2] = np.stack([last, this, np.roll(this, -1, 0)], 1)
        triangles["corners"][1::2] = np.stack([last, np.roll(this, -1, 0), np.roll(last, -1, 0)], 1)
        out.write(triangles.tobytes())
        last = this
