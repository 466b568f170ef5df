#!/usr/bin/env python3
"""Seconds to fill holes, beside MeshLib and CGAL, alternating in one run; prints Markdown.

usage: holes_speed.py [--scan FILE] [--binary PROGRAM] [--rounds 3] [--only ten many rbf-1000 rbf-20000]
`--scan`: a closed scan of about 100,000 faces, out of which ten caps are cut (default: a wavy surface made here). CGAL_FILL as for holes_tools.py; numpy, scipy, for a PLY or OBJ scan trimesh.
*Whole* is the process with reading and writing; *pass* the time of the step or call that fills, as the program says.
"""
import argparse, json, os, statistics, subprocess, sys, tempfile, time
import numpy as np
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
sys.path.insert(0, here)
from holes_cut import Model, loops_of
from holes_models import grid_torus, merged
from holes_tools import TITLES, tool, write_off

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--scan"); p.add_argument("--rounds", type=int, default=3); p.add_argument("--only", nargs="*")
p.add_argument("--binary", default=os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend"))
p.add_argument("--one", nargs=2, help=argparse.SUPPRESS)


def wavy(nu, nv):
    point = lambda u, v: np.c_[(2 + (0.7 + 0.05 * np.cos(7 * u)) * np.cos(v)) * np.cos(u), (2 + (0.7 + 0.05 * np.cos(7 * u)) * np.cos(v)) * np.sin(u), 0.7 * np.sin(v) + 0.1 * np.sin(3 * u)]
    v, f = grid_torus(point, nu, nv)
    return v.astype(np.float32).astype(float), f


def ten_large(v, f):
    """Ten caps of 4.5 % of the diagonal taken out, the places seeded and apart."""
    model, rng, keep, places = Model(v, f), np.random.default_rng(7), np.ones(len(f), bool), []
    while len(places) < 10:
        centre = model.centres[rng.integers(len(f))]
        if all(np.linalg.norm(centre - other) > 0.15 * model.size for other in places):
            trial = keep & (np.linalg.norm(model.centres - centre, axis=1) > 0.045 * model.size)
            if loops_of(f[trial]) and len(loops_of(f[trial])) == len(places) + 1: keep = trial; places.append(centre)
    return merged(v, f[keep])


def many_small(count):
    """A fine surface without the triangles around `count` of its vertices."""
    v, f = wavy(800, 300)
    nu, nv = 800, 300
    i, j = np.meshgrid(np.arange(0, nu, 4), np.arange(0, nv, 4), indexing="ij")
    gone = np.random.default_rng(3).permutation((i * nv + j).ravel())[:count]
    return merged(v, f[~np.isin(f, gone).any(1)])


def round_hole(corners):
    """A ball of rows of `corners` vertices, evenly wide around a round hole, so that rim and two rings have 3 `corners` vertices."""
    angle = 2 * np.pi * np.arange(corners) / corners
    radius = 0.5
    rows, at = [], np.arcsin(radius)
    for _ in range(12): rows.append(at); at += np.sin(at) * 2 * np.pi / corners
    while at < np.pi - 0.05: rows.append(at); at += 0.04 + 0.2 * (at - rows[0])
    rim = lambda a: np.c_[np.sin(a) * np.cos(angle), np.sin(a) * np.sin(angle), np.full(corners, np.cos(a))]
    v = np.vstack([rim(a) for a in rows] + [[[0, 0, -1]]])
    i, j = np.arange(corners), (np.arange(corners) + 1) % corners
    f = [np.vstack([np.c_[r + i, s + i, s + j], np.c_[r + i, s + j, r + j]]) for r, s in ((k * corners, (k + 1) * corners) for k in range(len(rows) - 1))]
    last = (len(rows) - 1) * corners
    return v.astype(np.float32).astype(float), np.vstack([*f, np.c_[last + i, np.full(corners, len(v) - 1), last + j]])


def ours(path, method, *more):
    with tempfile.TemporaryDirectory() as d:
        start = time.perf_counter()
        run = subprocess.run([o.binary, "fill-holes", path, "-o", d + "/out.off", "--method", method, *more, "--json"], capture_output=True, text=True)
        whole = time.perf_counter() - start
        if not os.path.exists(d + "/out.off"): return None
        # Welding, turning and filling.
        return whole, json.loads(run.stdout)["timing_ms"]["repair"] / 1e3


def theirs(path, name):
    start = time.perf_counter()
    run = subprocess.run([sys.executable, os.path.abspath(__file__), "--one", path, name], capture_output=True, text=True)
    whole = time.perf_counter() - start
    try: return whole, json.loads(run.stdout.splitlines()[-1])["seconds"]
    except (IndexError, ValueError, KeyError): return None


def scan():
    if not o.scan: return "a wavy ring made here", *wavy(400, 125)
    import trimesh
    m = trimesh.load(o.scan, force="mesh", process=False)
    return os.path.basename(o.scan), *merged(np.asarray(m.vertices, float).astype(np.float32).astype(float), np.asarray(m.faces, np.int64))


def main():
    cases = []
    if not o.only or "ten" in o.only:
        what, v, f = scan()
        cases.append((f"ten large holes in {what}, {len(f):,} faces", *ten_large(v, f), [("minimal",), ("smooth",), ("auto",)], ["meshlib", "meshlib_nicely", "cgal"]))
    if not o.only or "many" in o.only: cases.append(("10,000 small holes", *many_small(10_000), [("auto",), ("minimal",)], ["meshlib", "cgal"]))
    for n in (1_000, 20_000):
        if not o.only or f"rbf-{n}" in o.only: cases.append((f"one round hole, {9 * round(n / 9):,} constraints", *round_hole(round(n / 9)), [("rbf", "--constraints", "1"), ("rbf",)], ["meshlib_nicely", "cgal"]))
    commit = subprocess.run(["git", "log", "-1", "--format=%h", "--", "src"], cwd=root, capture_output=True, text=True).stdout.strip()
    print(f"# Speed of filling holes\n\n{os.cpu_count()} cores, commit {commit}, median of {o.rounds} alternating rounds; made by `experiments/holes_speed.py`. *Whole* is a process with reading and writing, *pass* the step or call that fills. Read the ratios within a table.\n")
    for title, v, f, methods, names in cases:
        seconds = {}
        with tempfile.TemporaryDirectory() as d:
            path = d + "/in.off"
            write_off(path, v, f)
            for _ in range(o.rounds):
                for m in methods: seconds.setdefault(f"**`{' '.join(m)}`**", []).append(ours(path, *m))
                for name in names: seconds.setdefault(TITLES[name], []).append(theirs(path, name))
        print(f"## {title[0].upper()}{title[1:]}\n\n{len(f):,} faces, {len(loops_of(f) or []):,} holes.\n\n| tool | whole, s | pass, s |\n|---|---|---|")
        middle = lambda rows, k: statistics.median([r[k] for r in rows if r and r[k] is not None] or [float("nan")])
        for name, rows in seconds.items(): print(f"| {name} | {middle(rows, 0):.3f} | {middle(rows, 1):.3f} |" if any(rows) else f"| {name} | no result | |")
        print(flush=True)


if __name__ == "__main__":
    o = p.parse_args()
    if o.one:
        from holes_tools import read_off
        said = os.fdopen(os.dup(1), "w")
        os.dup2(2, 1)
        _, _, seconds = tool(o.one[1])(*read_off(o.one[0]))
        print(json.dumps({"seconds": seconds}), file=said, flush=True)
    else: main()
