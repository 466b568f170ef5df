#!/usr/bin/env python3
"""A whole analysis of a large mesh beside PyMeshLab's and MeshLib's filters, alternating in one run; prints a Markdown table of ratios.

usage: analysis_speed.py --binary PATH [--rounds 5] [--mesh m1]     run it with the Python of the peers' virtual environment
Every program gets a fresh process in every round. A peer's clock starts after its modules are loaded; ours is that of the whole process.
"""
import argparse, json, os, resource, statistics, subprocess, sys, tempfile, time
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)

def marks(steps):
    """Runs the named steps in order; returns [name, wall seconds, processor seconds] of each, and what it answered."""
    cpu = lambda: sum(resource.getrusage(resource.RUSAGE_SELF)[:2]); out = []
    for name, step in steps:
        wall, used = time.perf_counter(), cpu()
        try: answer = step()
        except Exception as e: answer = f"failed: {str(e)[:60]}"
        out.append([name, time.perf_counter() - wall, cpu() - used, answer])
    return out
def pymeshlab_steps(path):
    import pymeshlab as pm
    ms = pm.MeshSet(verbose=False); m = ms.current_mesh; call = lambda name, **k: lambda: getattr(ms, name)(**k)
    def topology(): t = ms.get_topological_measures(); return {k: t[k] for k in ("boundary_edges", "non_two_manifold_edges", "non_two_manifold_vertices", "connected_components_number")}
    def geometry(): return {"area": float(ms.get_geometric_measures()["surface_area"])}
    def selected(name, **k):
        def run(): getattr(ms, name)(**k); return {"faces": m().selected_face_number(), "vertices": m().selected_vertex_number()}
        return run
    def removed(name):
        def run(): a = m().face_number(); getattr(ms, name)(); return {"faces": a - m().face_number()}
        return run
    return [("read", call("load_new_mesh", file_name=path)), ("get_topological_measures", topology), ("get_geometric_measures", geometry),
            ("compute_selection_by_self_intersections_per_face", selected("compute_selection_by_self_intersections_per_face")),
            ("compute_selection_by_non_manifold_edges_per_face", selected("compute_selection_by_non_manifold_edges_per_face")),
            ("compute_selection_by_non_manifold_per_vertex", selected("compute_selection_by_non_manifold_per_vertex")),
            ("compute_selection_from_mesh_border", selected("compute_selection_from_mesh_border")),
            ("compute_selection_bad_faces", selected("compute_selection_bad_faces", usear=False, select_folded_faces=True)),
            ("meshing_remove_null_faces", removed("meshing_remove_null_faces")), ("meshing_remove_duplicate_faces", removed("meshing_remove_duplicate_faces"))]
def meshlib_steps(path):
    import meshlib.mrmeshpy as mm
    at = {}
    def read(): at["m"] = mm.loadMesh(path); at["p"] = mm.MeshPart(at["m"]); return {"triangles": at["m"].topology.numValidFaces()}
    def overlap(): return {"triangles": mm.findOverlappingTris(at["p"], mm.FindOverlappingSettings()).count()}
    def sphere(): s = mm.InSphereSearchSettings(); s.maxRadius = at["m"].computeBoundingBox().diagonal() / 2; return {"vertices": mm.computeInSphereThicknessAtVertices(at["m"], s).size()}
    return [("read", read), ("findHoleRepresentiveEdges", lambda: {"loops": len(at["m"].topology.findHoleRepresentiveEdges())}),
            ("findDegenerateFaces", lambda: {"faces": mm.findDegenerateFaces(at["p"]).count()}), ("findMultipleEdges", lambda: {"edges": len(mm.findMultipleEdges(at["m"].topology))}),
            ("getAllComponents", lambda: {"components": len(mm.getAllComponents(at["p"]))}), ("area, volume", lambda: {"area": float(at["m"].area()), "volume": float(at["m"].volume())}),
            ("findSelfCollidingTriangles", lambda: {"pairs": len(mm.findSelfCollidingTriangles(at["p"]))}),
            ("findDisorientedFaces", lambda: {"faces": mm.findDisorientedFaces(at["m"]).count()}), ("findOverlappingTris", overlap),
            ("computeRayThicknessAtVertices", lambda: {"vertices": mm.computeRayThicknessAtVertices(at["m"]).size()})] + [("computeInSphereThicknessAtVertices", sphere)] * ("sphere" in sys.argv)
STEPS = {"pymeshlab": pymeshlab_steps, "meshlib": meshlib_steps}
if sys.argv[1:2] == ["--one"]:
    said = os.dup(1); os.dup2(2, 1); steps = STEPS[sys.argv[2]](sys.argv[3]); os.write(said, json.dumps(marks(steps)).encode()); os._exit(0)

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", required=True); p.add_argument("--rounds", type=int, default=5); p.add_argument("--mesh", default="m1"); p.add_argument("--save"); p.add_argument("--load"); o = p.parse_args()
peers = os.environ.get("MESH_PEERS_DIR") or os.path.join(tempfile.gettempdir(), "meshmend-peers"); stl = os.path.join(peers, "bench", o.mesh + ".stl")
if not os.path.exists(stl): sys.exit(f"not here: {stl}; set up the peers first")

def ours(*more):
    """[wall of the process, processor seconds of the process, report]"""
    with tempfile.TemporaryFile() as f:
        start = time.perf_counter(); child = subprocess.Popen([o.binary, "analyze", stl, "--json", *more], stdout=f, stderr=subprocess.DEVNULL)
        _, _, used = os.wait4(child.pid, 0); wall = time.perf_counter() - start; child.returncode = 0; f.seek(0); report = json.load(f)
    return [wall, used.ru_utime + used.ru_stime, report["timing_ms"], {d["code"]: d["count"] for d in report["before"]["defects"]}, report["before"]["counts"]["triangles"]]
rounds = json.load(open(o.load)) if o.load else []
for _ in range(0 if o.load else o.rounds):
    row = {"ours": ours(), "policy": ours("--policy", "fdm")}
    for name in STEPS: row[name] = json.loads(subprocess.run([sys.executable, os.path.abspath(__file__), "--one", name, stl, *(["sphere"] if not rounds else [])], capture_output=True, timeout=300, check=True).stdout)
    rounds.append(row)
    if o.save: json.dump(rounds, open(o.save, "w"))

med = statistics.median
def peer(name, only): return [med(sum(s[k] for s in r[name] if only(s[0])) for r in rounds) for k in (1, 2)]
def ratio(name, only, base):
    """Median of the rounds' own ratios: wall, processor."""
    return [med(sum(s[k] for s in r[name] if only(s[0])) / base(r)[k - 1] for r in rounds) for k in (1, 2)]
thick = lambda n: "Thickness" in n; same = lambda n: not thick(n) and n not in ("compute_selection_bad_faces", "findOverlappingTris")  # these two ask by angle and distance
few = {"pymeshlab": ("get_topological_measures", "get_geometric_measures", "compute_selection_by_self_intersections_per_face"),
       "meshlib": ("findHoleRepresentiveEdges", "findDegenerateFaces", "findMultipleEdges", "getAllComponents", "area, volume", "findSelfCollidingTriangles")}
whole = lambda r: r["ours"][:2]
def no_read(r): w, c, t = r["ours"][:3]; s = (t["total"] - t["read"]) / 1000; return s, c * s / w
commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip(); n = rounds[0]["ours"][4]
print(f"# A whole analysis beside other programs\n\n{n:,} triangles (binary STL), {os.cpu_count()} cores, commit {commit}, median of {o.rounds} alternating rounds, each program a fresh process.\n"
      f"Made by `experiments/analysis_speed.py --rounds {o.rounds} --mesh {o.mesh}`. A ratio is the median of the rounds' own ratios; the seconds are of one noisy machine.\n")
print("| what | program | seconds | processor seconds | ours is faster by | in processor time |\n|---|---|---|---|---|---|")
line = lambda what, name, t, q: print(f"| {what} | {name} | {t[0]:.2f} | {t[1]:.2f} | " + (f"{q[0]:.1f} x | {q[1]:.1f} x |" if q else "1 | 1 |"))
line("reading, report with certificate, whole process", "Meshmend", [med(whole(r)[k] for r in rounds) for k in (0, 1)], None)
for name in few:
    f = lambda s: s == "read" or s in few[name]; line("reading, fewest filters: topology, measures, intersections", name, peer(name, f), ratio(name, f, whole))
    line("reading, filters of the same classes", name, peer(name, same), ratio(name, same, whole))
line("the same without reading", "Meshmend", [med(no_read(r)[k] for r in rounds) for k in (0, 1)], None)
for name in few:
    f = lambda s: s in few[name]; line("fewest filters", name, peer(name, f), ratio(name, f, no_read))
    f = lambda s: s != "read" and same(s); line("filters of the same classes", name, peer(name, f), ratio(name, f, no_read))
t = [r["policy"][2] for r in rounds]; key = "measure" if all(x.get("measure") is not None for x in t) else None
print(f"\nWith `--policy fdm` (walls and gaps by ray and sphere, overhangs, edges, parts, quote figures): {med(r['policy'][0] for r in rounds):.2f} s the whole process, "
      f"{med(r['policy'][1] for r in rounds):.2f} s of processors" + (f", of it measuring {med(x['measure'] for x in t) / 1000:.2f} s" if key else "") + f"; {med(r['policy'][0] - r['ours'][0] for r in rounds):.2f} s more than without.")
print("MeshLib's two thicknesses alone, on the same mesh (the sphere once only, its radius up to half the diagonal): " + ", ".join(f"{s[0]} {med([x[1] for r in rounds for x in r['meshlib'] if x[0] == s[0]]):.2f} s" for s in rounds[0]["meshlib"] if thick(s[0])) + ".\n")
print("Our processor seconds without reading are the share of the process that its wall time says. *Filters of the same classes* are all below but the two thicknesses,\n"
      "`compute_selection_bad_faces` (folds by an angle) and `findOverlappingTris` (faces near each other by a distance).\n")
print("## What each found\n\n| program | step | seconds | answer |\n|---|---|---|---|")
words = lambda a: a if isinstance(a, str) else ", ".join(f"{k} {v:.6g}" if isinstance(v, float) else f"{k} {v:,}" for k, v in (a or {}).items())
tm = {k: med(r["ours"][2][k] for r in rounds) / 1000 for k in ("read", "analyze", "certify")}
print(f"| Meshmend | read {tm['read']:.2f}, analyze {tm['analyze']:.2f}, certify {tm['certify']:.2f} | {sum(tm.values()):.2f} | {words(rounds[0]['ours'][3])} |")
for name in STEPS:
    for i, s in enumerate(rounds[0][name]): print(f"| {name} | {s[0]} | {med(r[name][i][1] for r in rounds if i < len(r[name])):.2f} | {words(s[3])} |")
