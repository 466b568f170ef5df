#!/usr/bin/env python3
"""Writes the fixture meshes: `make_fixtures.py DIRECTORY` (in the project: `fixtures`).

Each is the smallest mesh that shows one thing, in whole numbers where that is possible. Nothing is random and only the
standard library is used, so every run writes the same bytes.
"""

import base64
import json
import struct
import sys
from pathlib import Path

# A mesh is (vertices, faces): faces are tuples of vertex numbers from 0, counter-clockwise seen from outside.

TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def tetrahedron(corner=(0, 0, 0), size=10):
    """Legs along the axes from `corner`."""
    x, y, z = corner
    vertices = [(x, y, z), (x + size, y, z), (x, y + size, z), (x, y, z + size)]
    return vertices, list(TETRAHEDRON)


def box(low, high):
    """The eight corners of a box and its six faces as quadrilaterals."""
    vertices = [tuple((low, high)[i >> k & 1][k] for k in range(3)) for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return vertices, faces


def prism(outline, height):
    """The solid above a counter-clockwise outline in the plane, whose faces are polygons."""
    n = len(outline)
    vertices = [(x, y, 0) for x, y in outline] + [(x, y, height) for x, y in outline]
    bottom = (0,) + tuple(range(n - 1, 0, -1))
    top = tuple(range(n, 2 * n))
    walls = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return vertices, [bottom, top] + walls


def tetrahedron_of(a, b, c, d):
    """The faces of the tetrahedron with these vertices, where `a`, `b`, `c` are counter-clockwise seen from `d`."""
    return [tuple((a, b, c, d)[v] for v in face) for face in TETRAHEDRON]


def in_triangles(mesh):
    vertices, faces = mesh
    return vertices, [(f[0], f[i], f[i + 1]) for f in faces for i in range(1, len(f) - 1)]


def turned(mesh):
    """Inside out."""
    vertices, faces = mesh
    return vertices, [face[::-1] for face in faces]


def joined(*meshes):
    """Several meshes in one, each with its own vertices."""
    vertices, faces = [], []
    for its_vertices, its_faces in meshes:
        faces += [tuple(len(vertices) + v for v in face) for face in its_faces]
        vertices += its_vertices
    return vertices, faces


def added(mesh, vertices=(), faces=()):
    return mesh[0] + list(vertices), mesh[1] + list(faces)


def without(mesh, face):
    return mesh[0], [f for f in mesh[1] if f != face]


# --- formats ---------------------------------------------------------------------------------------------------------


def lines(rows):
    return ("\n".join(rows) + "\n").encode("ascii")


def words(numbers):
    return " ".join(str(n) for n in numbers)


def obj(mesh):
    vertices, faces = mesh
    return lines([f"v {words(v)}" for v in vertices] + [f"f {words(i + 1 for i in f)}" for f in faces])


def off(mesh):
    vertices, faces = mesh
    head = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    return lines(head + [words(v) for v in vertices] + [words((len(f), *f)) for f in faces])


def stl_ascii(mesh):
    vertices, faces = in_triangles(mesh)
    rows = ["solid fixture"]
    for face in faces:
        corners = [f"      vertex {words(vertices[v])}" for v in face]
        rows += ["  facet normal 0 0 0", "    outer loop", *corners, "    endloop", "  endfacet"]
    return lines(rows + ["endsolid fixture"])


def stl_binary(mesh):
    vertices, faces = in_triangles(mesh)
    facets = [struct.pack("<12fH", 0, 0, 0, *(x for v in face for x in vertices[v]), 0) for face in faces]
    return b"fixture".ljust(80, b" ") + struct.pack("<I", len(faces)) + b"".join(facets)


def ply_head(kind, mesh):
    return lines([
        "ply", f"format {kind} 1.0",
        f"element vertex {len(mesh[0])}", "property float x", "property float y", "property float z",
        f"element face {len(mesh[1])}", "property list uchar int vertex_indices", "end_header",
    ])


def ply_ascii(mesh):
    vertices, faces = mesh
    return ply_head("ascii", mesh) + lines([words(v) for v in vertices] + [words((len(f), *f)) for f in faces])


def ply_binary(mesh, order, kind):
    vertices, faces = mesh
    body = [struct.pack(order + "3f", *v) for v in vertices]
    body += [struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces]
    return ply_head(kind, mesh) + b"".join(body)


def gltf_parts(mesh, uri=None):
    """The document and the buffer of a glTF file in which each triangle has vertices of its own, as exporters write flat shading."""
    vertices, faces = in_triangles(mesh)
    corners = [vertices[v] for face in faces for v in face]
    data = b"".join(struct.pack("<3f", *corner) for corner in corners)
    buffer = {"byteLength": len(data)}
    if uri:
        buffer["uri"] = uri(data)
    positions = {
        "bufferView": 0, "componentType": 5126, "count": len(corners), "type": "VEC3",
        "min": [min(c[k] for c in corners) for k in range(3)], "max": [max(c[k] for c in corners) for k in range(3)],
    }
    return {
        "asset": {"version": "2.0", "generator": "fixture"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [positions],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(data)}], "buffers": [buffer],
    }, data


def glb(mesh):
    document, data = gltf_parts(mesh)
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(data)) + b"BIN\0" + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def gltf(mesh):
    document, _ = gltf_parts(mesh, lambda data: "data:application/octet-stream;base64," + base64.b64encode(data).decode())
    return (json.dumps(document, indent=1) + "\n").encode()


# --- meshes ----------------------------------------------------------------------------------------------------------

CUBE = box((0, 0, 0), (10, 10, 10))
# Counter-clockwise; the fan around the first corner, which is the one pushed in, covers it rightly.
L_SHAPE = [(5, 5), (5, 10), (0, 10), (0, 0), (10, 0), (10, 5)]


def valid():
    cube = in_triangles(CUBE)
    cavity = turned(in_triangles(box((3, 3, 3), (7, 7, 7))))
    return {
        "tetrahedron.off": off(tetrahedron()),
        "cube.obj": obj(cube),
        "cube.off": off(cube),
        "cube_ascii.stl": stl_ascii(cube),
        "cube_binary.stl": stl_binary(cube),
        "cube_ascii.ply": ply_ascii(cube),
        "cube_little_endian.ply": ply_binary(cube, "<", "binary_little_endian"),
        "cube_big_endian.ply": ply_binary(cube, ">", "binary_big_endian"),
        "cube_of_squares.obj": obj(CUBE),
        "cube_split.glb": glb(cube),
        "cube_split.gltf": gltf(cube),
        "hollow_cube.off": off(joined(cube, cavity)),
        "two_parts.stl": stl_binary(joined(tetrahedron(), tetrahedron((20, 0, 0)))),
    }


def boundary():
    return {
        "open_sheet.off": off(([(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)], [(0, 1, 2), (0, 2, 3)])),
        "boundary_loop.off": off(without(tetrahedron(), (1, 2, 3))),
        "boundary_loop.glb": glb(without(tetrahedron(), (1, 2, 3))),
        "isolated_face.obj": obj(added(tetrahedron(), [(20, 0, 0), (30, 0, 0), (20, 10, 0)], [(4, 5, 6)])),
    }


def degenerate():
    needle = [(0, 0, 0), (1000, 0, 0), (1000, 5, 0), (1000, 0, 5)]
    cap = [(0, 0, 0), (200, 0, 0), (100, 2, 0), (100, 100, 100)]
    wedge = prism([(0, 0), (250, -2), (250, 2)], 100)
    # The edge from 0 to 1 is divided at 4 on one side only; a face without area joins both sides.
    divided = without(tetrahedron(), (0, 2, 1))
    return {
        "coincident_corners.obj": obj(added(tetrahedron(), [], [(1, 2, 2)])),
        "needle.off": off((needle, list(TETRAHEDRON))),
        "cap.off": off((cap, list(TETRAHEDRON))),
        "folded_edge.off": off(in_triangles(wedge)),
        "collinear_face.off": off(added(divided, [(5, 0, 0)], [(0, 2, 4), (4, 2, 1), (0, 4, 1)])),
    }


def duplicate():
    # Two tetrahedra on the face 1 2 3, each with its own side of the wall between them.
    second = tetrahedron_of(1, 2, 3, 4)
    # The same vertex once more: the faces at it no longer meet by their numbers.
    torn = [(0, 2, 1), (0, 1, 3), (1, 2, 4), (2, 0, 4)]
    return {
        "duplicate_face.off": off(added(tetrahedron(), [], [(2, 3, 1)])),
        "opposite_duplicate_face.off": off(added(tetrahedron(), [(10, 10, 10)], second)),
        "duplicate_vertex.obj": obj((tetrahedron()[0] + [(0, 0, 10)], torn)),
        "isolated_vertex.obj": obj(added(tetrahedron(), [(5, 5, 5)])),
        "isolated_edge.obj": obj(added(tetrahedron(), [(5, 5, 5), (6, 5, 5)])) + b"l 5 6\n",
    }


def non_manifold():
    # The second tetrahedron has the edge from 0 to 3, or the vertex 3, in common with the first.
    at_edge = tetrahedron_of(0, 4, 5, 3)
    at_vertex = tetrahedron_of(4, 6, 5, 3)
    beyond = [(0, 0, 20), (10, 0, 20), (0, 10, 20)]
    return {
        "non_manifold_edge.off": off(added(tetrahedron(), [(-10, 0, 0), (0, -10, 0)], at_edge)),
        "non_manifold_vertex.off": off(added(tetrahedron(), beyond, at_vertex)),
    }


def orientation():
    vertices, faces = tetrahedron()
    band = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 10), (5, 5, 10)]
    return {
        "orientation_conflict.off": off((vertices, [faces[0][::-1]] + faces[1:])),
        "non_orientable.off": off((band, [(i, (i + 1) % 5, (i + 2) % 5) for i in range(5)])),
    }


def nesting():
    return {
        "inverted_shell.off": off(turned(tetrahedron())),
        "misnested_shell.off": off(joined(tetrahedron((0, 0, 0), 20), tetrahedron((3, 3, 3), 5))),
        "noise_shell.off": off(joined(tetrahedron((0, 0, 0), 1000), tetrahedron((2000, 0, 0), 2))),
        "double_skin.off": off(in_triangles(box((0, 0, 0), (300000, 400000, 2)))),
        "zero_volume_shell.off": off((tetrahedron()[0][:3], [(0, 1, 2), (0, 2, 1)])),
    }


def intersection():
    # A tip from below: through the face, or just on it.
    def tip(height):
        return [(0, 0, -10), (10, 0, -10), (0, 10, -10), (2, 2, height)], list(TETRAHEDRON)

    # Its upper face lies in the plane of the other's lower one.
    hanging = [(2, 2, 0), (2, 12, 0), (12, 2, 0), (2, 2, -10)], list(TETRAHEDRON)
    return {
        "self_intersection.off": off(joined(tetrahedron(), tip(3))),
        "overlap.off": off(joined(tetrahedron(), hanging)),
        "touch.off": off(joined(tetrahedron(), tip(0))),
        "near.off": off(joined(tetrahedron(), tip(-0.0001))),
    }


def numbers():
    # Coordinates rounded to float32 put the tip into the corner below it.
    low = [(0, 0, 1), (10, 0, 1), (0, 10, 1), (0, 0, "1.00000001")]
    return {
        "no_triangle.off": off((tetrahedron()[0], [])),
        "non_finite.obj": obj(added(tetrahedron(), [("nan", 0, 0)], [(0, 1, 4)])),
        "index_out_of_range.obj": obj(added(tetrahedron(), [], [(0, 1, 6)])),
        "too_few_corners.obj": obj(added(tetrahedron(), [], [(0, 1)])),
        "unsound_reading.obj": obj((low, list(TETRAHEDRON))),
    }


def polygons():
    vertices, faces = CUBE
    return {
        "non_planar_polygon.obj": obj((vertices[:-1] + [(10, 10, 12)], faces)),
        "concave_polygon.obj": obj(prism(L_SHAPE, 5)),
        # The same, but the fan around the corner that now is the first one leaves the outline.
        "unsound_reading.obj": obj(prism(L_SHAPE[1:] + L_SHAPE[:1], 5)),
    }


def modeller():
    roof = (
        [(0, 0, 0), (60, 0, 0), (60, 40, 0), (0, 40, 0), (20, 20, 20), (40, 20, 20)],
        [(3, 2, 1, 0), (0, 1, 5, 4), (1, 2, 5), (2, 3, 4, 5), (3, 0, 4)],
    )
    # Two steps that meet crosswise: a vertex of six faces in the middle, two of them in one plane.
    steps = (
        [(0, 0, 0), (45, 0, 0), (45, 45, 0), (0, 45, 0), (0, 0, 20), (20, 0, 20), (20, 20, 20), (0, 20, 20), (20, 0, 30)]
        + [(45, 0, 30), (45, 20, 30), (20, 20, 30), (0, 20, 30), (20, 45, 30), (0, 45, 30), (20, 20, 45), (45, 20, 45)]
        + [(45, 45, 45), (20, 45, 45)],
        [(3, 2, 1, 0), (4, 5, 6, 7), (8, 9, 10, 11), (12, 11, 13, 14), (15, 16, 17, 18), (0, 1, 9, 8, 5, 4)]
        + [(1, 2, 17, 16, 10, 9), (2, 3, 14, 13, 18, 17), (3, 0, 4, 7, 12, 14), (5, 8, 11, 6), (6, 11, 12, 7)]
        + [(11, 15, 18, 13), (11, 10, 16, 15)],
    )
    left, front, back = [{"normal": n, "at": p} for n, p in [
        ([-1, 0, 1], [10, 20, 10]), ([0, -1, 1], [30, 10, 10]), ([0, 1, 1], [30, 30, 10])]]
    top = {"normal": [0, 0, 1], "at": [32, 10, 30]}
    edit_roof = {
        "operators": [
            {"shift": {"faces": [{"face": left, "by_mm": -2}]}},
            {"flip": {"edge": {"faces": [front, back]}, "face": left}},
            {"undo": {}},
        ],
        "ranges": [left, {"together": [{"face": front}, {"face": back}]}],
        "list_faces": True,
        "polygons": True,
    }
    edit_steps = {"operators": [{"split": {"at": [20, 20, 30], "face": top, "by_mm": 4}}]}
    options = lambda given: (json.dumps(given) + "\n").encode()
    return {
        "hip_roof.off": off(roof),
        "hip_roof.off.options.json": options(edit_roof),
        "steps.off": off(steps),
        "steps.off.options.json": options(edit_steps),
    }


FAMILIES = [valid, boundary, degenerate, duplicate, non_manifold, orientation, nesting, intersection, numbers, polygons,
            modeller]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for family in FAMILIES:
        folder = Path(sys.argv[1], family.__name__)
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in family().items():
            Path(folder, name).write_bytes(content)


if __name__ == "__main__":
    main()
