#!/usr/bin/env python3
"""Files of the corpus whose bodies pass through each other, before and after a repair; draws docs/pictures/united.png. Needs numpy, scipy, trimesh and pillow, and a folder `shared` (or MESHMEND_SHARED).

usage: united_pictures.py [--binary PROGRAM] [--file ID ...]     files by their names in the manifest of the corpus
Before: what meets another triangle is orange. After: triangles that the file had are grey, new ones green.
"""
import argparse, os, subprocess, sys, tempfile
import numpy as np
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
sys.path[:0] = [here, os.path.join(shared, "judge")]
from holes_pictures import GREY, SIDE, drawn

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend"))
p.add_argument("--file", nargs="*", default=["283_two_spheres", "051_rabbit", "219_upperarm", "242_WSG_FMF", "226_wrist2", "225_upperarm", "090_3DSMaxExport", "129_self_intersectA"])
MET, NEW = np.array([0.95, 0.55, 0.15]), np.array([0.30, 0.72, 0.38])


def corners(v, f):
    """Each triangle by its corners, wherever it begins."""
    return {tuple(sorted(map(tuple, v[t].astype("f4").tolist()))) for t in f}


def colours(v, f, kept, other):
    is_kept = np.array([tuple(sorted(map(tuple, v[t].astype("f4").tolist()))) in kept for t in f])
    return np.where(is_kept[:, None], GREY, other), ~is_kept


def pictures(path):
    from meshfile import load_any
    with tempfile.TemporaryDirectory() as d:
        out = os.path.join(d, "out." + path.rsplit(".", 1)[-1].lower())
        subprocess.run([o.binary, "repair", path, "-o", out], capture_output=True, timeout=300, check=True)
        (v, f, _), (w, g, _) = load_any(path), load_any(out)
    v, f, w, g = (np.asarray(x) for x in (v, f, w, g))
    centre, reach = (v.min(0) + v.max(0)) / 2, np.linalg.norm(v.max(0) - v.min(0)) / 2 * 1.02
    view = np.array([0.55, -0.75, 0.45]); view /= np.linalg.norm(view)
    before, after = corners(v, f), corners(w, g)
    return [drawn(v, f, *colours(v, f, after, MET), view, centre, reach), drawn(w, g, *colours(w, g, before, NEW), view, centre, reach)]


if __name__ == "__main__":
    from PIL import Image, ImageDraw
    o = p.parse_args()
    paths = dict(line.rstrip("\n").split("\t")[:2] for line in open(os.path.join(shared, "corpus/MANIFEST.tsv")) if not line.startswith("#"))
    rows = (len(o.file) + 1) // 2
    sheet = Image.new("RGB", (4 * SIDE, rows * (SIDE + 18)), "white")
    for n, name in enumerate(o.file):
        x, y = 2 * SIDE * (n % 2), (SIDE + 18) * (n // 2)
        for k, image in enumerate(pictures(os.path.join(shared, "corpus", paths[name]))):
            sheet.paste(Image.fromarray((image * 255).astype("u1")), (x + k * SIDE, y + 18))
        ImageDraw.Draw(sheet).text((x + 6, y + 4), name, fill=(60, 60, 60))
    sheet.convert("P", palette=Image.ADAPTIVE, colors=64).save(os.path.join(root, "docs/pictures/united.png"), optimize=True)
