"""Writes a sheet of many triangles, which takes the server some time: what a client follows and cancels.

    slow_mesh.py SIDE FILE.stl
"""

import math
import struct
import sys


def main(side, path):
    side = int(side)
    height = [[math.sin(x * 0.3) * math.cos(y * 0.2) for y in range(side + 1)] for x in range(side + 1)]
    point = lambda x, y: (x, y, height[x][y])
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", 2 * side * side))
        for x in range(side):
            for y in range(side):
                a, b, c, d = point(x, y), point(x + 1, y), point(x + 1, y + 1), point(x, y + 1)
                file.write(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) + struct.pack("<12fH", 0, 0, 0, *a, *c, *d, 0))


main(*sys.argv[1:])
