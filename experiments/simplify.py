#!/usr/bin/env python3
"""Simplification beside the peers at equal numbers of faces, on real meshes; prints Markdown.

usage: simplify.py quality [--share 0.1] [--models 40] [--cache FILE] [--peers NAMES]     distance of the results from the original, in every mode
       simplify.py speed [--rounds 3] [--mesh m1] [--peers NAMES]          seconds to a tenth of the faces, alternating in one run
       simplify.py judge                                   guarded results of sound corpus files before the judge; needs `cargo build --release`
with MESHMEND_SHARED and the peers' own set-up done (see its README). Ours is `cargo bench --bench simplify`.
Distances are measured by Open3D: 60,000 random points of each surface and all its vertices against the other surface.
"""
import argparse, json, os, re, statistics, subprocess, sys, tempfile
import numpy as np
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
peers = os.environ.get("MESH_PEERS_DIR") or os.path.join(tempfile.gettempdir(), "meshmend-peers")
judge = os.environ.get("MESH_JUDGE_DIR") or os.path.join(tempfile.gettempdir(), "meshmend-judge")
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("what", choices=("quality", "speed", "judge")); p.add_argument("--share", type=float, default=0.1); p.add_argument("--models", type=int, default=40); p.add_argument("--cache", help="file that keeps what was measured of the peers")
p.add_argument("--rounds", type=int, default=3); p.add_argument("--mesh", default="m1"); p.add_argument("--peers", default="", help="only these of the other programs, separated by commas"); o = p.parse_args()
sys.path.insert(0, os.path.join(shared, "judge"))
from meshfile import load_any, read_msh, write_msh
MODES, FACES = ("strict", "fast", "guarded"), (2_000, 130_000)
NAMES = ("meshoptimizer", "fast_simplification", "meshlib", "meshlib_par", "open3d", "pymeshlab", "cgal")
chosen, asked = tuple(o.peers.split(",")) if o.peers else NAMES, f" --peers {o.peers}" if o.peers else ""
if unknown := set(chosen) - set(NAMES): p.error("unknown peers: " + ", ".join(sorted(unknown)))
NAMES = chosen
commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
if o.what != "judge": subprocess.run(["cargo", "bench", "--locked", "--bench", "simplify", "--no-run", "-q"], cwd=root, check=True)

def ours(path, share, mode, out=None):
    args = [path, repr(share), "quadric", "optimal", mode] + ([out] if out else [])
    run = subprocess.run(["cargo", "bench", "--locked", "-q", "--bench", "simplify", "--", *args], cwd=root, capture_output=True, text=True)
    line = next((l for l in run.stdout.splitlines() if l.startswith("{")), None)
    if not line: sys.exit(f"ours failed on {path}: {run.stderr[-300:]}")
    return json.loads(line)

def write_off(path, V, F):
    with open(path, "w") as f:
        f.write(f"OFF\n{len(V)} {len(F)} 0\n" + "\n".join("%r %r %r" % tuple(map(float, v)) for v in V) + "\n" + "\n".join("3 %d %d %d" % tuple(t) for t in F) + "\n")
def read_off(path):
    with open(path) as f:
        f.readline(); nv, nf, _ = map(int, f.readline().split()); a = np.fromfile(f, sep=" ", count=nv * 3 + nf * 4)
    return a[:nv * 3].reshape(nv, 3), a[nv * 3:].reshape(nf, 4)[:, 1:].astype(np.int64)

def points(V, F, seed):
    T = V[F]; area = np.linalg.norm(np.cross(T[:, 1] - T[:, 0], T[:, 2] - T[:, 0]), axis=1); rng = np.random.default_rng(seed)
    i = rng.choice(len(F), 60_000, p=area / area.sum()); r = rng.random((len(i), 2)); a, b = 1 - np.sqrt(r[:, :1]), np.sqrt(r[:, :1]) * r[:, 1:]
    return np.vstack([a * T[i, 0] + b * T[i, 1] + (1 - a - b) * T[i, 2], V[np.unique(F)]])
def distances(P, V, F):
    import open3d as o3
    scene = o3.t.geometry.RaycastingScene(); scene.add_triangles(o3.core.Tensor(V.astype(np.float32)), o3.core.Tensor(F.astype(np.uint32)))
    return scene.compute_distance(o3.core.Tensor(P.astype(np.float32))).numpy()
def measure(V0, F0, V1, F1):
    """Mean distance and Hausdorff distance, both ways, as shares of the diagonal of the original."""
    low, high = V0.min(0), V0.max(0); size = np.linalg.norm(high - low); V0, V1 = ((V - (low + high) / 2) / size for V in (V0, V1))
    a, b = distances(points(V0, F0, 1), V1, F1), distances(points(V1, F1, 2), V0, F0)
    return float(a[:60_000].mean() + b[:60_000].mean()) / 2, float(max(a.max(), b.max()))

def by_pymeshlab(V, F, k, d):
    import pymeshlab as pm
    ms = pm.MeshSet(verbose=False); ms.add_mesh(pm.Mesh(V, F)); ms.meshing_decimation_quadric_edge_collapse(targetfacenum=k, autoclean=False); m = ms.current_mesh(); return m.vertex_matrix(), m.face_matrix()
def by_cgal(V, F, k, d):
    write_msh(d + "/in.msh", V, F); subprocess.run([judge + "/cgal_peer", "simplify", d + "/in.msh", d + "/out.msh", repr(k / len(F))], capture_output=True, timeout=120, check=True); return read_msh(d + "/out.msh")
def by_meshlib(V, F, k, d):
    import meshlib.mrmeshpy as mm, meshlib.mrmeshnumpy as mn
    m = mn.meshFromFacesVerts(F.astype(np.int32), V); s = mm.DecimateSettings(); s.strategy = mm.DecimateStrategy.MinimizeError; s.maxDeletedFaces = len(F) - k; s.maxError = 1e30; s.packMesh = True
    mm.decimateMesh(m, s); return mn.getNumpyVerts(m), mn.getNumpyFaces(m.topology)
def by_open3d(V, F, k, d):
    import open3d as o3
    m = o3.geometry.TriangleMesh(o3.utility.Vector3dVector(V), o3.utility.Vector3iVector(F)).simplify_quadric_decimation(k); return np.asarray(m.vertices), np.asarray(m.triangles)
def by_fast_simplification(V, F, k, d):
    import fast_simplification as fs
    return fs.simplify(V.astype(np.float32), F.astype(np.int32), target_count=k)
def by_meshoptimizer(V, F, k, d):
    import meshoptimizer as mo
    out = np.zeros(F.size, np.uint32); n = mo.simplify(out, np.ascontiguousarray(F.ravel(), np.uint32), np.ascontiguousarray(V, np.float32), target_index_count=3 * k, target_error=1.0); return V, out[:n].reshape(-1, 3)
PEERS = dict(pymeshlab=by_pymeshlab, cgal=by_cgal, meshlib=by_meshlib, open3d=by_open3d, fast_simplification=by_fast_simplification, meshoptimizer=by_meshoptimizer)
PEERS = {name: run for name, run in PEERS.items() if name in NAMES}

def quality():
    names, ratios, wins = [], {m: ([], []) for m in MODES}, {}
    cache = json.load(open(o.cache)) if o.cache and os.path.exists(o.cache) else {}
    for line in open(os.path.join(shared, "corpus/MANIFEST.tsv")):
        if line.startswith("#") or len(names) == o.models: continue
        id, path, *_, vertices, faces, classes, licence = line.rstrip("\n").split("\t")
        if "clean" not in classes or not FACES[0] <= int(faces) <= FACES[1] or path.lower().endswith(".3mf"): continue
        V, F, _ = load_any(os.path.join(shared, "corpus", path)); V, F = np.asarray(V, float), np.asarray(F, np.int64); k = int(len(F) * o.share)
        with tempfile.TemporaryDirectory() as d:
            write_off(d + "/in.off", V, F); found = cache.setdefault(f"{id} {o.share}", {}); todo = {} if found else PEERS
            for name, run in todo.items():
                try: a, b = run(V, F, k, d)
                except Exception as e: print(f"{id} {name}: {str(e)[:80]}", file=sys.stderr); continue
                # Equal counts: one that keeps far more faces than asked is not compared.
                if 0 < len(b) <= 1.02 * k: found[name] = measure(V, F, np.asarray(a, float), np.asarray(b, np.int64))
            if o.cache: json.dump(cache, open(o.cache, "w"))
            if not found: continue
            best = [min(found, key=lambda n: found[n][i]) for i in (0, 1)]
            for name in best: wins[name] = wins.get(name, 0) + 1
            for mode in MODES:
                count = ours(d + "/in.off", (k + 0.5) / len(F), mode, d + "/ours.off")["faces_after"]
                mine = measure(V, F, *read_off(d + "/ours.off"))
                for i in (0, 1): ratios[mode][i].append(mine[i] / max(found[best[i]][i], 1e-7))
                if count > 1.02 * k: print(f"{id} {mode}: {count} faces of {k}", file=sys.stderr)
        names.append(id); print(id, len(F), {m: [round(r[-1], 3) for r in ratios[m]] for m in MODES}, best, file=sys.stderr, flush=True)
    print(f"## Quality at {o.share:.0%} of the faces\n\n{len(names)} clean corpus models of {FACES[0]:,} to {FACES[1]:,} faces, commit {commit}; made by `experiments/simplify.py quality --share {o.share}{asked}`.\n"
          "Ratio of our distance to that of the best peer of each model (below 1: ours is nearer), median and 90th percentile over the models.\n")
    print("| mode | mean distance, median | 90 % | Hausdorff distance, median | 90 % |\n|---|---|---|---|---|")
    for mode in MODES: print(f"| {mode} | " + " | ".join(f"{statistics.median(r):.3f} | {np.percentile(r, 90):.3f}" for r in ratios[mode]) + " |")
    print("\nBest peer, over models and both distances: " + ", ".join(f"{n} {c}" for n, c in sorted(wins.items(), key=lambda t: -t[1])) + ".")

def speed():
    python, bench = os.path.join(peers, "venv/bin/python"), os.path.join(shared, "peers/bench.py"); stl = os.path.join(peers, "bench", o.mesh + ".stl")
    seconds, mine = {}, {m: [] for m in MODES}
    for _ in range(o.rounds):
        for mode in MODES: mine[mode].append(ours(stl, 0.1, mode))
        for name in NAMES:
            try: t = json.loads(subprocess.run([python, bench, "one", "simplify", name, o.mesh], capture_output=True, text=True, timeout=300).stdout).get("t")
            except Exception: t = None
            if t: seconds.setdefault(name, []).append(t)
    n = mine["fast"][0]["faces"]; med = statistics.median; fast = med([m["seconds"] for m in mine["fast"]])
    print(f"## Speed, {n:,} faces to a tenth\n\n{os.cpu_count()} cores, commit {commit}, median of {o.rounds} alternating rounds; made by `experiments/simplify.py speed --rounds {o.rounds} --mesh {o.mesh}{asked}`.\n")
    print("| program | seconds | in relation to fast | input faces per second | bytes charged per face |\n|---|---|---|---|---|")
    for mode in MODES:
        t = med([m["seconds"] for m in mine[mode]]); print(f"| Meshmend {mode} | {t:.2f} | {t / fast:.2f} | {n / t:,.0f} | {mine[mode][0]['peak_bytes_per_face']:.0f} |")
    for name in NAMES:
        if name in seconds: t = med(seconds[name]); print(f"| {name} | {t:.2f} | {t / fast:.2f} | {n / t:,.0f} | |")
        else: print(f"| {name} | failed | | | |")

def judged():
    tool, shares = os.path.join(judge, "judge"), (0.5, 0.1, 0.01); counts, inputs = {s: [0, 0, 0, 0] for s in shares}, 0
    def look(path):
        with tempfile.NamedTemporaryFile(suffix=".msh") as f:
            V, F, _ = load_any(path); write_msh(f.name, np.asarray(V, float), np.asarray(F, np.int64))
            return json.loads(subprocess.run([tool, f.name, "--only"], capture_output=True, text=True).stdout)
    for line in open(os.path.join(shared, "corpus/MANIFEST.tsv")):
        id, path, *_, classes, licence = line.rstrip("\n").split("\t")
        if line.startswith("#") or classes != "clean" or path.lower().endswith(".3mf"): continue
        path = os.path.join(shared, "corpus", path)
        if not look(path)["printable"]: continue
        inputs += 1
        for share in shares:
            with tempfile.TemporaryDirectory() as d:
                out = d + "/out" + os.path.splitext(path)[1].lower(); c = counts[share]
                args = [os.path.join(root, "target/release/meshmend"), "simplify", path, "-o", out, "--ratio", repr(share), "--mode", "guarded", "--json"]
                run = subprocess.run(args, capture_output=True, text=True)
                if not os.path.exists(out): c[0] += 1; print(f"{id} {share}: {run.stderr.strip()[:150]}", file=sys.stderr); continue
                verdict = look(out); c[1] += 1; c[2] += verdict["printable"]; c[3] += verdict["si"]
                if not verdict["printable"]: print(f"{id} {share}: {verdict}", file=sys.stderr)
        print(id, counts, file=sys.stderr, flush=True)
    print(f"## Guarded results before the judge\n\n{inputs} clean corpus files that the judge calls printable, commit {commit}; made by `experiments/simplify.py judge`.\n")
    print("| share of the faces | results | printable | pairs of triangles that meet | no result |\n|---|---|---|---|---|")
    for s, (failed, results, printable, pairs) in counts.items(): print(f"| {s:.0%} | {results} | {printable} | {pairs} | {failed} |")

{"quality": quality, "speed": speed, "judge": judged}[o.what]()
