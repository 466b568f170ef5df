#!/usr/bin/env python3
"""Each operator of the modeller before and after, and what is refused and why, from the program's own output: docs/pictures/modeller-*.svg. Needs nothing but Python.

usage: modeller_pictures.py [--binary PROGRAM]
"""
import argparse, json, math, os, re, subprocess, tempfile
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend"))
WIDTH, HEIGHT, GAP = 300, 270, 10
MOVED, PLAIN, LINE, NEW = (238, 160, 72), (196, 206, 220), "#2b3440", "#c4261d"

dot = lambda a, b: sum(x * y for x, y in zip(a, b))
sub = lambda a, b: [x - y for x, y in zip(a, b)]
cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
unit = lambda a: [x / math.sqrt(dot(a, a)) for x in a]


def off(points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"] + [" ".join(map(repr, q)) for q in points]
    return "\n".join(lines + [" ".join(map(str, [len(f), *f])) for f in faces]) + "\n"


def read_off(path):
    words = open(path).read().split()[1:]
    v, f = int(words[0]), int(words[1]); at = 3 + 3 * v
    points = [list(map(float, words[3 + 3 * i:6 + 3 * i])) for i in range(v)]
    faces = []
    for _ in range(f):
        n = int(words[at]); faces.append(list(map(int, words[at + 1:at + 1 + n]))); at += 1 + n
    return points, faces


def prism(outline, low, high):
    n = len(outline)
    points = [[*q, low] for q in outline] + [[*q, high] for q in outline]
    return points, [list(range(n))[::-1], list(range(n, 2 * n))] + [[i, (i + 1) % n, (i + 1) % n + n, i + n] for i in range(n)]


BOX = prism([[0, 0], [60, 0], [60, 40], [0, 40]], 0, 24)
U = prism([[0, 0], [60, 0], [60, 40], [46, 40], [46, 12], [14, 12], [14, 40], [0, 40]], 0, 16)
ROOF = ([[0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0], [20, 20, 20], [40, 20, 20]],
        [[3, 2, 1, 0], [0, 1, 5, 4], [1, 2, 5], [2, 3, 4, 5], [3, 0, 4]])
TIP = ([[0, 0, 0], [40, 0, 0], [40, 40, 0], [0, 40, 0], [20, 20, 40]], [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
# Two steps that meet crosswise: a vertex of six faces in the middle.
STEPS = ([[0, 0, 0], [45, 0, 0], [45, 45, 0], [0, 45, 0], [0, 0, 20], [20, 0, 20], [20, 20, 20], [0, 20, 20], [20, 0, 30], [45, 0, 30], [45, 20, 30],
          [20, 20, 30], [0, 20, 30], [20, 45, 30], [0, 45, 30], [20, 20, 45], [45, 20, 45], [45, 45, 45], [20, 45, 45]],
         [[3, 2, 1, 0], [4, 5, 6, 7], [8, 9, 10, 11], [12, 11, 13, 14], [15, 16, 17, 18], [0, 1, 9, 8, 5, 4], [1, 2, 17, 16, 10, 9], [2, 3, 14, 13, 18, 17],
          [3, 0, 4, 7, 12, 14], [5, 8, 11, 6], [6, 11, 12, 7], [11, 15, 18, 13], [11, 10, 16, 15]])
CUBE = prism([[-20, -20], [20, -20], [20, 20], [-20, 20]], -20, 20)
LEFT, RIGHT, FRONT, BACK = ({"normal": n, "at": a} for n, a in [
    ([-1, 0, 1], [10, 20, 10]), ([1, 0, 1], [50, 20, 10]), ([0, -1, 1], [30, 10, 10]), ([0, 1, 1], [30, 30, 10])])


class Tool:
    def __init__(self, binary):
        self.binary, self.folder = binary, tempfile.mkdtemp()

    def run(self, shape, operators=(), **options):
        """The edited shape and what was told of it; the shape itself where an operator is refused."""
        given, made = (os.path.join(self.folder, name) for name in ("given.off", "made.off"))
        open(given, "w").write(off(*shape))
        if os.path.exists(made): os.remove(made)
        flags = [f"--{name.replace('_', '-')}={value}" for name, value in options.items()]
        command = [self.binary, "modeller", given, "-o", made, "--polygons", "true", "--list-faces", "true", "--json",
                   "--operators", json.dumps(list(operators)), *flags]
        report = json.loads(subprocess.run(command, capture_output=True, text=True).stdout)
        return (read_off(made) if os.path.exists(made) else shape), report


def drawn(shape, faces, marked, fresh, turn=(35, 24)):
    """Polygons of a shape from far to near; `faces` as the report lists them, `marked`: numbers of those to colour, `fresh`: the edges, as pairs of
    planes, to draw in red."""
    points, polygons = shape
    a, b = map(math.radians, turn)
    view = [-math.sin(a) * math.cos(b), -math.cos(a) * math.cos(b), math.sin(b)]
    side = unit(cross([0, 0, 1], view)); up = cross(view, side)
    normal = [unit(cross(sub(points[f[1]], points[f[0]]), sub(points[f[2]], points[f[0]]))) for f in polygons]

    def plane(i):
        q = points[polygons[i][0]]
        best = min(faces, key=lambda f: max(abs(x - y) for x, y in zip(f["normal"], normal[i])) + abs(dot(normal[i], q) - f["distance"]))
        return best["face"]
    planes = [plane(i) if faces else i for i in range(len(polygons))]
    beside = {}
    for i, f in enumerate(polygons):
        for u, v in zip(f, f[1:] + f[:1]): beside[u, v] = i
    flat = [(dot(q, side), -dot(q, up)) for q in points]
    depth = lambda i: sum(dot(points[v], view) for v in polygons[i]) / len(polygons[i])
    out = []
    for i in sorted((i for i in range(len(polygons)) if dot(normal[i], view) > 1e-9), key=depth):
        light = 0.62 + 0.38 * max(0, dot(normal[i], unit([-0.35, -0.55, 0.9])))
        colour = "#%02x%02x%02x" % tuple(int(c * light) for c in (MOVED if planes[i] in marked else PLAIN))
        path = " ".join(f"{flat[v][0]!r},{flat[v][1]!r}" for v in polygons[i])
        out.append(("polygon", path, colour))
        f = polygons[i]
        for u, v in zip(f, f[1:] + f[:1]):
            other = planes[beside[v, u]] if (v, u) in beside else None
            if other == planes[i]: continue
            is_new = frozenset((planes[i], other)) in fresh
            out.append(("line", (flat[u], flat[v]), NEW if is_new else LINE, 2.2 if is_new else 1.0))
    return out, flat


def edges_of(shape, faces):
    points, polygons = shape
    tool = lambda f: unit(cross(sub(points[f[1]], points[f[0]]), sub(points[f[2]], points[f[0]])))
    number = lambda f: min(faces, key=lambda g: max(abs(x - y) for x, y in zip(g["normal"], tool(f))) + abs(dot(tool(f), points[f[0]]) - g["distance"]))["face"]
    owner = {}
    for f in polygons:
        for u, v in zip(f, f[1:] + f[:1]): owner[u, v] = number(f)
    return {frozenset((owner[u, v], owner[v, u])) for u, v in owner if (v, u) in owner}


def page(path, panels):
    """A row of panels, each a drawing with a caption of one or two lines."""
    body = []
    for k, (marks, flat, caption) in enumerate(panels):
        xs, ys = [q[0] for q in flat], [q[1] for q in flat]
        scale = min((WIDTH - 30) / (max(xs) - min(xs)), (HEIGHT - 90) / (max(ys) - min(ys)))
        dx = k * (WIDTH + GAP) + WIDTH / 2 - scale * (max(xs) + min(xs)) / 2
        dy = (HEIGHT - 66) / 2 - scale * (max(ys) + min(ys)) / 2
        at = lambda q: (q[0] * scale + dx, q[1] * scale + dy)
        for mark in marks:
            if mark[0] == "polygon":
                corners = [at(tuple(map(float, c.split(",")))) for c in mark[1].split()]
                text = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
                body.append(f'<polygon points="{text}" fill="{mark[2]}" stroke="{mark[2]}" stroke-width="0.5"/>')
            else:
                (x1, y1), (x2, y2) = map(at, mark[1])
                body.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{mark[2]}" stroke-width="{mark[3]}" stroke-linecap="round"/>')
        for i, line in enumerate(caption):
            body.append(f'<text x="{k * (WIDTH + GAP) + WIDTH / 2}" y="{HEIGHT - 52 + 14 * i}" font-family="sans-serif" font-size="11" text-anchor="middle" fill="#2b3440">{line}</text>')
    width = len(panels) * (WIDTH + GAP) - GAP
    open(path, "w").write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {HEIGHT}" width="{width}" height="{HEIGHT}">'
                          f'<rect width="{width}" height="{HEIGHT}" fill="white"/>' + "".join(body) + "</svg>\n")
    print("wrote", os.path.relpath(path, root))


def wrapped(text, width=50):
    lines, line = [], ""
    for word in text.split():
        if len(line) + len(word) + 1 > width and line: lines.append(line); line = word
        else: line = f"{line} {word}".strip()
    return lines + [line]


def main():
    tool = Tool(p.parse_args().binary)
    out = os.path.join(root, "docs", "pictures"); os.makedirs(out, exist_ok=True)
    shift = lambda face, by, **more: {"shift": {"faces": [{"face": face, "by_mm": by}], **more}}
    ridge = {"faces": [FRONT, BACK]}
    rows = {
        "shift": (U, [("outward by 8 mm", [shift({"normal": [1, 0, 0], "at": [60, 20, 8]}, 8)]),
                      ("a wall by its two sides, by 10 mm", [{"shift": {"faces": [
                          {"face": {"normal": [1, 0, 0], "at": [60, 20, 8]}, "by_mm": -10}, {"face": {"normal": [-1, 0, 0], "at": [46, 30, 8]}, "by_mm": 10}]}}]),
                      ("refused: beyond the interval", [shift({"normal": [-1, 0, 0], "at": [46, 30, 8]}, 33)])]),
        "split": (TIP, [("a side moves outward by 4 mm", [{"split": {"at": [20, 20, 40], "face": {"normal": [2, 0, 1], "at": [30, 20, 20]}, "by_mm": 4}}]),
                        ("the same inward by 4 mm", [{"split": {"at": [20, 20, 40], "face": {"normal": [2, 0, 1], "at": [30, 20, 20]}, "by_mm": -4}}]),
                        ("refused", [{"split": {"at": [0, 0, 0], "face": {"normal": [-2, 0, 1], "at": [10, 20, 20]}, "by_mm": 1}}])]),
        "merge": (ROOF, [("the left hip moves until the ridge is a point", [{"merge": {"edge": ridge, "face": LEFT}}]),
                         ("refused", [{"merge": {"edge": {"faces": [LEFT, FRONT]}, "face": BACK}}])]),
        "flip": (ROOF, [("the hips become neighbours", [{"flip": {"edge": ridge, "face": LEFT}}]),
                        ("refused", [{"flip": {"edge": {"faces": [LEFT, FRONT]}, "face": FRONT}}])]),
        "bad-flip": (BOX, [("refused", [{"flip": {"edge": {"faces": [{"normal": [1, 0, 0], "at": [60, 20, 12]}, {"normal": [0, -1, 0], "at": [30, 0, 12]}]},
                                                  "face": {"normal": [1, 0, 0], "at": [60, 20, 12]}}}])]),
        "bad-split": (STEPS, [("refused", [{"split": {"at": [20, 20, 30], "face": {"normal": [0, 0, 1], "at": [32, 10, 30]}, "by_mm": 4}}])]),
        "pass": (ROOF, [("16 mm inward, past the end of the ridge", [shift(LEFT, -16, pass_events=True)]), ("refused without pass_events", [shift(LEFT, -16)])]),
    }
    for name, (shape, cases) in rows.items():
        turn = {"shift": (-35, 24), "split": (-35, 24), "bad-split": (30, 40)}.get(name, (35, 24))
        first, told = tool.run(shape)
        faces = told["modeller"]["faces"]
        old = edges_of(first, faces)
        marks = lambda shape, faces, moved, fresh: drawn(shape, faces, moved, fresh, turn)
        panels = [(*marks(first, faces, set(), set()), ["before"])]
        for caption, operators in cases:
            made, report = tool.run(shape, operators)
            model = report["modeller"]
            if model["refused"] is not None:
                # What is in the way.
                message = report["verdict"]["reasons"][0]["message"].replace("operator 0 is refused: ", "")
                named = re.findall(r"faces? (\d+(?:, \d+)*)", message)
                blocked = {f for b in model["refused"]["blocking"] for f in b["faces"]} or {int(f) for text in named for f in text.split(", ")}
                # A number that a float has, in the digits that people need.
                message = re.sub(r"-?\d+\.\d{4,}", lambda m: f"{float(m[0]):.6g}", message)
                panels.append((*marks(first, faces, blocked, set()), wrapped(f"refused ({model['refused']['reason']}): {message}")))
                print(f"{name}: {message}")
            else:
                assert report["certificate"]["printable"], name
                moved = {m["face"] for step in model["steps"] for m in step["moved"]}
                panels.append((*marks(made, model["faces"], moved, edges_of(made, model["faces"]) - old), wrapped(caption)))
        page(os.path.join(out, f"modeller-{name}.svg"), panels)
    first, told = tool.run(CUBE)
    dual, report = tool.run(CUBE, dual="polar")
    again, _ = tool.run(dual, dual="polar")
    page(os.path.join(out, "modeller-dual.svg"), [(*drawn(shape, [], set(), set()), [caption]) for shape, caption in [
        (first, "a cube around the origin"), (dual, "its polar dual, an octahedron"), (again, "the dual of that")]])


if __name__ == "__main__":
    main()
