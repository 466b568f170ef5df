#!/usr/bin/env python3
"""What share of its triangles each broken file of the corpus keeps in repair, and where the others are: meeting other triangles of the file, inside other bodies of the result, or on its surface. Prints Markdown.

usage: kept.py [--binary PATH] [--only ID ...]    with MESHMEND_SHARED; needs numpy and meshlib

A triangle is kept when the result has its three corners as 32-bit coordinates, whichever way it runs. It meets another when MeshLib finds them
colliding and they have no corner in common. It is inside when the result winds around both of its sides, a ten-thousandth of the diagonal away; up to 300 of the others of each file are looked at, and
those without area count as inside.
"""
import argparse, json, os, subprocess, sys, tempfile
import numpy as np
from meshlib import mrmeshnumpy, mrmeshpy

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=os.path.join(root, "target/release/meshmend"))
p.add_argument("--only", nargs="*", default=[])
o = p.parse_args()
manifest = os.path.join(shared, "corpus/MANIFEST.tsv")
if not os.path.exists(manifest):
    sys.exit("the corpus is not here; set MESHMEND_SHARED")

# Places of triangles that are looked at in one file, at most.
SAMPLES = 300
BESIDE = 1e-4


def triangles_of(path):
    """Positions of the corners of each triangle, from an OFF file as the program writes it."""
    lines = [line.split() for line in open(path) if line.strip() and not line.startswith("#")]
    vertices, faces = int(lines[1][0]), int(lines[1][1])
    at = np.array([[float(x) for x in line[:3]] for line in lines[2:2 + vertices]]).reshape(-1, 3)
    polygons = [[int(x) for x in line[1:1 + int(line[0])]] for line in lines[2 + vertices:2 + vertices + faces]]
    corners = [(q[0], q[k], q[k + 1]) for q in polygons for k in range(1, len(q) - 1)]
    return at[np.array(corners, dtype=np.int64).reshape(-1, 3)]


def names_of(triangles):
    return [tuple(sorted(map(tuple, t))) for t in triangles.astype(np.float32).tolist()]


def meeting(triangles, names):
    """For each triangle, whether it meets one that has no corner in common with it."""
    corners = triangles.astype(np.float32).reshape(-1, 3)
    mesh = mrmeshnumpy.meshFromFacesVerts(np.arange(len(corners), dtype=np.int32).reshape(-1, 3), corners)
    meets = np.zeros(len(triangles), bool)
    for pair in mrmeshpy.findSelfCollidingTriangles(mrmeshpy.MeshPart(mesh)):
        a, b = int(pair.aFace.get()), int(pair.bFace.get())
        if not set(names[a]) & set(names[b]):
            meets[a] = meets[b] = True
    return meets


def is_within(places, triangles):
    """For each place whether the triangles wind around it, by their solid angles (van Oosterom and Strackee 1983)."""
    within = np.zeros(len(places), bool)
    for i, place in enumerate(places):
        a, b, c = (triangles[:, k] - place for k in range(3))
        x, y, z = (np.linalg.norm(corner, axis=1) for corner in (a, b, c))
        along = x * y * z + (a * b).sum(1) * z + (b * c).sum(1) * x + (c * a).sum(1) * y
        within[i] = np.arctan2((a * np.cross(b, c)).sum(1), along).sum() / (2 * np.pi) > 0.5
    return within


def share_inside(lost, result, size):
    """The share of some of the `lost` triangles that have the result on both sides."""
    some = lost[np.random.default_rng(1).choice(len(lost), min(SAMPLES, len(lost)), replace=False)]
    normals = np.cross(some[:, 1] - some[:, 0], some[:, 2] - some[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    some, normals = some[lengths > 0], normals[lengths > 0] / lengths[lengths > 0, None]
    if not len(some):
        return 1.0  # Without area: no surface.
    middles, step = some.mean(1), normals * BESIDE * size
    return float((is_within(middles + step, result) & is_within(middles - step, result)).mean())


def measured(path):
    """Triangles of the file, and the shares that are kept, meet others, are inside and are lost; `None`: refused or valid."""
    with tempfile.TemporaryDirectory() as folder:
        file, result = os.path.join(folder, "file.off"), os.path.join(folder, "result" + os.path.splitext(path)[1].lower())
        back = os.path.join(folder, "back.off")
        run = lambda *words: subprocess.run([o.binary, *words], capture_output=True, timeout=900)
        report = json.loads(run("repair", path, "-o", result, "--json").stdout or "{}")
        if (report.get("verdict") or {}).get("outcome") not in ("repaired", "rebuilt"):
            return None
        run("convert", path, "-o", file)
        run("convert", result, "-o", back)
        if not os.path.exists(file):
            return None
        before, after = triangles_of(file), triangles_of(back)
        names, known = names_of(before), set(names_of(after))
        kept = np.array([name in known for name in names])
        meets = meeting(before, names) & ~kept
        lost = ~kept & ~meets
        inside = share_inside(before[lost], after, np.linalg.norm(np.ptp(before.reshape(-1, 3), axis=0))) if lost.any() else 0.0
        n = len(before)
        return n, kept.sum() / n, meets.sum() / n, inside * lost.sum() / n, (1 - inside) * lost.sum() / n


rows = []
for line in open(manifest):
    if line.startswith("#"):
        continue
    name, path = line.split("\t")[:2]
    if o.only and name not in o.only and name[:3] not in o.only:
        continue
    found = measured(os.path.join(shared, "corpus", path))
    if found:
        rows.append((name, *found))
        print(*rows[-1], sep="\t", file=sys.stderr, flush=True)

commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
if not rows:
    sys.exit("no file was repaired")
could = lambda row: row[2] / (row[2] + row[5]) if row[2] + row[5] > 0 else 1.0
most = sum(row[2] > 0.9 for row in rows)
could_keep_most = sum(row[2] + row[5] > 0.9 for row in rows)
most_of_those = sum(could(row) > 0.9 for row in rows)
print(f"""# Which triangles stay

Made by `experiments/kept.py` at commit {commit}: the broken STL, OBJ, OFF and PLY files of the corpus that are repaired. A triangle is kept when the result has
its three corners, whichever way it runs. Of the others, some meet triangles of the file with which they have no corner in common, so they had to be divided or
go; some are inside other bodies of the result, which nobody sees and a valid solid cannot have; the rest is on the surface and was divided or replaced. What is inside is told by up to {SAMPLES} triangles of each file.

| | files |
|---|---:|
| repaired | {len(rows)} |
| more than 90 % of the triangles are kept | {most} ({most / len(rows):.0%}) |
| more than 90 % could be kept: at most a tenth meets others or is inside | {could_keep_most} ({could_keep_most / len(rows):.0%}) |
| more than 90 % of those that could be: neither meeting others nor inside | {most_of_those} ({most_of_those / len(rows):.0%}) |

| file | triangles | kept | meet others | inside | divided or replaced |
|---|---:|---:|---:|---:|---:|""")
for name, n, *shares in rows:
    print(f"| {name} | {n:,} | " + " | ".join(f"{share:.1%}" for share in shares) + " |")
