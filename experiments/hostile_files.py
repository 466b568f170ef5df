"""Families of files that are small for the work they ask for. Each is a function of one size and gives the name's ending and the bytes; the same size gives the same bytes. Needs nothing but Python.

usage: hostile_files.py FOLDER [FAMILY ...]        writes the files that `SIZES` names
"""
import argparse, math, os, random, struct
from array import array

RECORD = struct.Struct("<12x9fH")


def stl(triangles):
    """Binary STL of nine numbers for each triangle."""
    body = b"".join(RECORD.pack(*t, 0) for t in triangles)
    return "stl", bytes(80) + struct.pack("<I", len(body) // 50) + body


def off(points, faces):
    lines = [f"OFF\n{len(points)} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points]
    lines += [f"{len(f)} {' '.join(map(str, f))}" for f in faces]
    return "off", ("\n".join(lines) + "\n").encode()


def ply(points, faces, kind="float"):
    """Binary PLY; faces of any number of corners up to 255."""
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property {kind} {axis}\n" for axis in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    numbers = array("d" if kind == "double" else "f", (c for p in points for c in p)).tobytes()
    return "ply", head.encode() + numbers + b"".join(struct.pack(f"<B{len(f)}i", len(f), *f) for f in faces)


def box(low, size):
    """The twelve outward triangles of a box, as nine numbers each."""
    (x, y, z), (u, v, w) = low, size
    p = [(x + u * (i & 1), y + v * (i >> 1 & 1), z + w * (i >> 2)) for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return [p[i] + p[j] + p[k] for a, b, c, d in quads for i, j, k in ((a, b, c), (a, c, d))]


def turned(triangles):
    """The triangles after a rotation about two axes by angles that are no fractions of a turn."""
    (c, s), (d, e) = [(math.cos(a), math.sin(a)) for a in (0.4, 0.7)]

    def turn(x, y, z):
        x, y = c * x - s * y, s * x + c * y
        return x, d * y - e * z, e * y + d * z

    return [turn(*t[:3]) + turn(*t[3:6]) + turn(*t[6:]) for t in triangles]


def random_triangles(n):
    r = random.Random(n)
    return stl([r.random() for _ in range(9)] for _ in range(n))


def degenerate_far_away(n):
    return stl(box((0, 0, 0), (1, 1, 1)) + [(n, 0, 0) * 3])


def one_triangle(_):
    return stl([(0, 0, 0, 10, 0, 0, 0, 10, 0)])


def both_directions(n):
    """A cube of about n triangles in all, each square of a grid in either direction."""
    k = max(1, math.isqrt(n // 24))
    one = []
    for axis in range(3):
        for side in (0, 1):
            for i in range(k):
                for j in range(k):
                    def at(a, b):
                        p = [a / k, b / k]
                        p.insert(axis, float(side))
                        return tuple(p)
                    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
                    one += [a + b + c, a + c + d] if side == axis % 2 else [a + c + b, a + d + c]
    return stl(one + [t[:3] + t[6:] + t[3:6] for t in one])


def beams(n):
    """n beams along x through n beams along y."""
    along = [box((-1, 2 * i, 0), (2 * n + 1, 1, 1)) for i in range(n)]
    across = [box((2 * i, -1, 0.25), (1, 2 * n + 1, 1)) for i in range(n)]
    return [t for b in along + across for t in b]


def crossing_beams(n):
    return stl(beams(n))


def rotated_beams(n):
    return stl(turned(beams(n)))


def beams_in_three_directions(n):
    """n by n beams along each axis."""
    most, all_of_them = 2 * n + 1, []
    for i in range(n):
        for j in range(n):
            all_of_them += box((-1, 2 * i, 2 * j), (most, 1, 1)) + box((2 * i + 0.25, -1, 2 * j + 0.25), (1, most, 1))
            all_of_them += box((2 * i + 0.5, 2 * j + 0.5, -1), (1, 1, most))
    return stl(all_of_them)


def anyhow(r, triangles):
    """The triangles after a random rotation about the origin."""
    a, b, c, d = q = [r.gauss(0, 1) for _ in range(4)]
    s = 2 / sum(x * x for x in q)
    rows = (
        (1 - s * (c * c + d * d), s * (b * c - a * d), s * (b * d + a * c)),
        (s * (b * c + a * d), 1 - s * (b * b + d * d), s * (c * d - a * b)),
        (s * (b * d - a * c), s * (c * d + a * b), 1 - s * (b * b + c * c)),
    )
    return [tuple(sum(m * x for m, x in zip(row, t[k : k + 3])) for k in (0, 3, 6) for row in rows) for t in triangles]


def prism(sides, radius, low, high, tip=1.0):
    """A prism along z; its lower end is `tip` times as wide."""
    ends = [(math.cos(2 * math.pi * i / sides), math.sin(2 * math.pi * i / sides)) for i in range(sides)]
    bottom, top = [[(w * x, w * y, z) for x, y in ends] for w, z in ((radius * tip, low), (radius, high))]
    around = [(i, (i + 1) % sides) for i in range(sides)]
    walls = [t for i, j in around for t in (bottom[i] + bottom[j] + top[j], bottom[i] + top[j] + top[i])]
    return walls + [t for i in range(1, sides - 1) for t in (bottom[0] + bottom[i + 1] + bottom[i], top[0] + top[i] + top[i + 1])]


def boxes_at_one_place(n):
    r = random.Random(n)
    sizes = [[r.uniform(0.5, 1.5) for _ in range(3)] for _ in range(n)]
    return stl(t for size in sizes for t in anyhow(r, box([-x / 2 for x in size], size)))


def struts_through_a_point(n):
    r = random.Random(n)
    return stl(t for _ in range(n) for t in anyhow(r, prism(12, 0.1, -2, 2)))


def cones_with_one_tip(n):
    """Thin cones whose tips are as wide as an atom."""
    r = random.Random(n)
    return stl(t for _ in range(n) for t in anyhow(r, prism(8, 0.15, 0, 1, 1e-8)))


def crossing_planes(n):
    """Squares through the middle of a cube, each in two triangles."""
    r, triangles = random.Random(n), []
    for _ in range(n):
        a, b = [[r.gauss(0, 1) for _ in range(3)] for _ in range(2)]
        a = [x / math.hypot(*a) for x in a]
        dot = sum(x * y for x, y in zip(a, b))
        b = [y - dot * x for x, y in zip(a, b)]
        b = [x / math.hypot(*b) for x in b]
        m = [r.uniform(-0.1, 0.1) for _ in range(3)]
        p, q, s, t = [tuple(m[k] + i * a[k] + j * b[k] for k in range(3)) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        triangles += [p + q + s, p + s + t]
    return stl(triangles)


def copies_of_a_triangle(n):
    one = RECORD.pack(0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    return "stl", bytes(80) + struct.pack("<I", n) + one * n


def faces_at_one_edge(n):
    r = random.Random(n)
    tips = [(math.cos(a), math.sin(a), r.uniform(0.2, 0.8)) for a in (r.uniform(0, math.tau) for _ in range(n))]
    return ply([(0, 0, 0), (0, 0, 1), *tips], [(0, 1, 2 + i) for i in range(n)])


def faces_at_one_vertex(n):
    """A cone of n sides with its base, a fan too."""
    rim = [(math.cos(math.tau * i / n), math.sin(math.tau * i / n), 0) for i in range(n)]
    sides = [(0, 1 + i, 1 + (i + 1) % n) for i in range(n)]
    return ply([(0, 0, 1), *rim], sides)


def random_faces_at_one_vertex(n):
    r = random.Random(n)
    return stl((0, 0, 0, *(r.uniform(-1, 1) for _ in range(6))) for _ in range(n))


def comb_polygon(n):
    """Teeth of no regular depth, one polygon."""
    r, m = random.Random(n), n // 2 - 1
    points = [p for i in range(m) for p in ((i, r.uniform(5, 9), 0), (i + 0.5, r.uniform(0.5, 4), 0))]
    points += [(m, 0, 0), (-1, 0, 0)]
    return off(points, [range(len(points))])


def star_polygon(n):
    at = lambda i, radius: (radius * math.cos(math.tau * i / n), radius * math.sin(math.tau * i / n), 0)
    return off([at(i, 1 + 9 * (i % 2)) for i in range(n)], [range(n)])


def spiral_polygon(n):
    turn = lambda i, off_by: ((i + off_by) * math.cos(i / 20), (i + off_by) * math.sin(i / 20), 0)
    half = n // 2
    return off([turn(i, 1) for i in range(half)] + [turn(i, 40) for i in reversed(range(half))], [range(2 * half)])


def random_polygon(n):
    r = random.Random(n)
    return off([(r.random(), r.random(), 0) for _ in range(n)], [range(n)])


def random_polygon_in_space(n):
    r = random.Random(n)
    return off([(r.random(), r.random(), r.random()) for _ in range(n)], [range(n)])


def polygon_at_one_point(n):
    return off([(1, 2, 3)] * n, [range(n)])


def polygon_of_one_vertex(n):
    return "off", (f"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{n}" + " 0" * n + "\n").encode()


def polygon_in_turns(n):
    """Passes the same three vertices again and again."""
    return "off", (f"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{n // 3 * 3}" + " 0 1 2" * (n // 3) + "\n").encode()


def slivers(n):
    """Long triangles all through the cube."""
    r = random.Random(n)

    def one():
        a, b = [r.random() for _ in range(3)], [r.random() for _ in range(3)]
        return (*a, *b, *(x + 1e-6 * r.random() for x in b))

    return stl(one() for _ in range(n))


def mixed_exponents(n):
    r = random.Random(n)
    number = lambda: r.choice((-1, 1)) * (1 + r.random()) * 10 ** r.uniform(-300, 300)
    points = [(number(), number(), number()) for _ in range(n)]
    return ply(points, [r.sample(range(n), 3) for _ in range(n)], "double")


def mixed_exponents_closed(n):
    """A closed surface of tetrahedra with a corner of every size."""
    r, points, faces = random.Random(n), [], []
    for i in range(n // 4):
        size = 10 ** r.uniform(-300, 300)
        at = [r.choice((-1, 1)) * size * r.random() for _ in range(3)]
        points += [tuple(at), (at[0] + size, at[1], at[2]), (at[0], at[1] + size, at[2]), (at[0], at[1], at[2] + size)]
        faces += [(4 * i + a, 4 * i + b, 4 * i + c) for a, b, c in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))]
    return ply(points, faces, "double")


def boxes(places):
    """Boxes of size 1 as a PLY, each with vertices of its own."""
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    points, faces = [], []
    for x, y, z in places:
        base = len(points)
        points += [(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)) for i in range(8)]
        faces += [[base + i for i in quad] for quad in quads]
    return ply(points, faces)


def touching_boxes(n):
    side = math.ceil(n ** (1 / 3))
    return boxes([(i % side, i // side % side, i // side // side) for i in range(n)])


def menger_sponge(level):
    """The small cubes that are left, each a body that touches its neighbours."""
    side = 3 ** level

    def stays(*place):
        while any(place):
            if sum(c % 3 == 1 for c in place) > 1:
                return False
            place = [c // 3 for c in place]
        return True

    return boxes([p for p in ((i, j, k) for i in range(side) for j in range(side) for k in range(side)) if stays(*p)])


def nested_spheres(n):
    """Shells of 80 triangles inside each other, all outward."""
    g = (1 + math.sqrt(5)) / 2
    points = [p for a in (-1, 1) for b in (-g, g) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    near = lambda i, j: abs(math.dist(points[i], points[j]) - 2) < 1e-9
    faces = [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near(i, j) and near(j, k) and near(i, k)]
    one = []
    for i, j, k in faces:
        a, b, c = points[i], points[j], points[k]
        normal = [(b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]) for u, v in ((1, 2), (2, 0), (0, 1))]
        if sum(x * y for x, y in zip(normal, a)) < 0:
            b, c = c, b
        unit = lambda p: tuple(x / math.hypot(*p) for x in p)
        ab, bc, ca = [unit([x + y for x, y in zip(p, q)]) for p, q in ((a, b), (b, c), (c, a))]
        a, b, c = unit(a), unit(b), unit(c)
        one += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return stl(tuple(x * s for p in t for x in p) for s in (1 + i / 10 for i in range(n)) for t in one)


def without_area(n):
    r, triangles = random.Random(n), []
    for _ in range(n):
        a, d = [[r.randrange(64) for _ in range(3)] for _ in range(2)]
        triangles.append((*a, *(x + y for x, y in zip(a, d)), *(x + 2 * y for x, y in zip(a, d))))
    return stl(triangles)


def triangle_strips(n):
    """One strip of n corners, as some scanners write them, over a wavy sheet."""
    side = 256
    points = [(i, j, math.sin(i / 9) * math.cos(j / 7)) for i in range(side) for j in range(side)]
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    corners = [(k // 2 + (k % 2) * side) % len(points) for k in range(n)]
    numbers = array("f", (c for p in points for c in p)).tobytes()
    return "ply", head.encode() + numbers + struct.pack("<i", n) + array("i", corners).tobytes()


def obj_groups(n):
    lines = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1"]
    faces = ("f 1 3 2", "f 1 2 4", "f 2 3 4", "f 3 1 4")
    return "obj", ("\n".join(lines) + "\n" + "".join(f"g {i}\n{faces[i % 4]}\n" for i in range(n))).encode()


# Sizes of each family, the smallest ones first; the last is the one that the issue names, or larger.
SIZES = {
    random_triangles: (60, 120, 240, 500, 1000, 5000, 83000, 200000),
    degenerate_far_away: (20,),
    one_triangle: (1,),
    both_directions: (4800, 96000),
    crossing_beams: (10, 30, 100, 300),
    rotated_beams: (10, 30, 100, 300),
    beams_in_three_directions: (5, 10, 30),
    boxes_at_one_place: (20, 60, 200, 6000),
    struts_through_a_point: (30, 75, 120, 1600),
    cones_with_one_tip: (40, 80, 150, 2400),
    crossing_planes: (20, 200, 1000),
    copies_of_a_triangle: (1000, 80000, 1000000),
    faces_at_one_edge: (1000, 20000, 160000),
    faces_at_one_vertex: (1000, 160000, 1000000),
    random_faces_at_one_vertex: (100, 1000, 80000, 1000000),
    comb_polygon: (1024, 65536),
    star_polygon: (1024, 65536),
    spiral_polygon: (1024, 65536),
    random_polygon: (1024, 65536),
    random_polygon_in_space: (1024, 65536),
    polygon_at_one_point: (1024, 65536),
    polygon_of_one_vertex: (65536,),
    polygon_in_turns: (65536,),
    slivers: (1000, 80000, 100000),
    mixed_exponents: (100, 1000, 4000, 100000),
    mixed_exponents_closed: (1000, 4000, 80000),
    touching_boxes: (1000, 15000, 100000),
    menger_sponge: (1, 2, 3),
    nested_spheres: (100, 1000, 2000),
    without_area: (1000, 80000, 200000),
    triangle_strips: (100000, 800000),
    obj_groups: (10000, 250000, 1000000),
}


def cases(families=()):
    """Name, family and size of each file, in the order of the table."""
    for make, sizes in SIZES.items():
        for size in sizes:
            if not families or make.__name__ in families:
                yield make, size


def write(folder, make, size):
    """The path of the file, which is made if it is not there."""
    start = os.path.join(folder, f"{make.__name__}-{size}.")
    for ending in ("stl", "off", "ply", "obj"):
        if os.path.exists(start + ending):
            return start + ending
    ending, content = make(size)
    with open(start + "part", "wb") as file:
        file.write(content)
    os.rename(start + "part", start + ending)
    return start + ending


if __name__ == "__main__":
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder")
    p.add_argument("families", nargs="*")
    o = p.parse_args()
    os.makedirs(o.folder, exist_ok=True)
    for make, size in cases(families=o.families):
        path = write(o.folder, make, size)
        print(f"{os.path.getsize(path):12} {path}")
