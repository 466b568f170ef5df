#!/usr/bin/env python3
"""What Meshmend finds in the corpus beside MeshLab, Blender and CGAL, element by element; prints Markdown tables.

usage: findings.py --binary PATH [--only ID ...] [--save FILE] [--show CLASS/TOOL]     with MESHMEND_SHARED, run with a Python that has pymeshlab, bpy and cgal
Every tool gets the same triangles, with bit-equal positions joined and without triangles that have two corners at one position, so that elements have one
numbering; then each reads the file itself. 20 s for a tool and file.
"""
import argparse, collections, json, os, select, subprocess, sys, tempfile
import numpy as np
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared")); sys.path.insert(0, os.path.join(shared, "judge"))
from meshfile import load_off
LIMIT = 20.0; cgal_peer = os.path.join(os.environ.get("MESH_JUDGE_DIR") or os.path.join(tempfile.gettempdir(), "meshmend-judge"), "cgal_peer")
edge = lambda a, b: (a, b) if a < b else (b, a)

def read_off(path):
    """Vertices and triangles of a file that `write_off` wrote."""
    lines = [l.split() for l in open(path)]; nv, nf = int(lines[1][0]), int(lines[1][1])
    return [[float(x) for x in l] for l in lines[2:2 + nv]], [tuple(int(x) for x in l[1:]) for l in lines[2 + nv:2 + nv + nf]]
def welded(v, f):
    """The same triangles with one vertex for each position, in the order in which positions first appear."""
    number, places = {}, []
    for p in v:
        if (q := tuple(x + 0.0 for x in p)) not in number: number[q] = len(places); places.append(q)
    return places, [tuple(number[tuple(x + 0.0 for x in v[i])] for i in t) for t in f]
def write_off(path, v, f):
    with open(path, "w") as o: o.write(f"OFF\n{len(v)} {len(f)} 0\n" + "".join("%r %r %r\n" % tuple(p) for p in v) + "".join("3 %d %d %d\n" % tuple(t) for t in f))

def pymeshlab(path, original):
    import pymeshlab as pm
    def own(m):
        t = m.get_topological_measures(); n = m.current_mesh(); return {"vertices": n.vertex_number(), "faces": n.face_number(), "border": t["boundary_edges"], "nm": t["non_two_manifold_edges"]}
    v, f = read_off(path); v, f = np.array(v, float).reshape(-1, 3), np.array(f, np.int32).reshape(-1, 3); ms = pm.MeshSet(verbose=False); ms.add_mesh(pm.Mesh(v, f)); out = {}
    m = ms.current_mesh; faces = lambda: np.nonzero(m().face_selection_array())[0].tolist(); vertices = lambda: np.nonzero(m().vertex_selection_array())[0].tolist()
    t = ms.get_topological_measures(); out["counts"] = {"border edges": t["boundary_edges"], "non-manifold edges": t["non_two_manifold_edges"]}
    ms.compute_selection_by_non_manifold_edges_per_face(); out["faces at non-manifold edges"] = faces(); ms.set_selection_none()
    ms.compute_selection_by_non_manifold_per_vertex(); out["non-manifold vertices"] = vertices(); ms.set_selection_none()
    ms.compute_selection_from_mesh_border(); out["border vertices"] = vertices(); ms.set_selection_none()
    ms.compute_selection_by_self_intersections_per_face(); out["faces that meet others"] = faces(); ms.set_selection_none()
    def lost(filter):
        before = collections.Counter(tuple(sorted(t)) for t in m().face_matrix().tolist()); getattr(ms, filter)(); gone = before - collections.Counter(tuple(sorted(t)) for t in m().face_matrix().tolist())
        return [list(t) for t in sorted(gone)]
    out["degenerate triangles"] = lost("meshing_remove_null_faces"); out["duplicate triangles"] = lost("meshing_remove_duplicate_faces")
    n = m().vertex_number(); ms.meshing_remove_unreferenced_vertices(); out["counts"]["isolated vertices"] = n - m().vertex_number()
    ms = pm.MeshSet(verbose=False)
    try: ms.load_new_mesh(original); out["own"] = own(ms)
    except Exception as e: out["own"] = {"error": str(e).strip().splitlines()[-1][:80]}
    return out
def blender(path, original):
    import bpy, bmesh
    from mathutils.bvhtree import BVHTree
    v, f = read_off(path); mesh = bpy.data.meshes.new("m"); mesh.from_pydata(v, [], f); bm = bmesh.new(); bm.from_mesh(mesh); bm.verts.ensure_lookup_table(); bm.faces.ensure_lookup_table(); out = {}
    pair = lambda e: list(edge(e.verts[0].index, e.verts[1].index))
    out["non-manifold edges"] = [pair(e) for e in bm.edges if len(e.link_faces) > 2]; out["border edges"] = [pair(e) for e in bm.edges if e.is_boundary]
    out["edges between opposite directions"] = [pair(e) for e in bm.edges if e.is_manifold and not e.is_contiguous]
    out["non-manifold vertices"] = [x.index for x in bm.verts if not x.is_manifold and x.link_faces]; out["isolated vertices"] = [x.index for x in bm.verts if not x.link_edges]
    out["border vertices"] = sorted({i for e in out["border edges"] for i in e})
    for name, limit in (("degenerate triangles", 0.0), ("degenerate triangles, limit 0.0001", 1e-4)): out[name] = [sorted(x.index for x in t.verts) for t in bm.faces if t.calc_area() <= limit]
    tree = BVHTree.FromBMesh(bm, epsilon=1e-5); pairs = sorted({edge(a, b) for a, b in tree.overlap(tree) if a != b}); out["pairs that meet"] = pairs; out["faces that meet others"] = sorted({i for p in pairs for i in p})
    normals = [t.normal.copy() for t in bm.faces]; bmesh.ops.recalc_face_normals(bm, faces=bm.faces[:]); out["turned"] = sum(t.normal.dot(n) < 0 for t, n in zip(bm.faces, normals)); bm.free()
    bpy.ops.wm.read_factory_settings(use_empty=True); kind = original.rsplit(".", 1)[-1].lower()
    if kind == "off": return out
    try:
        {"stl": bpy.ops.wm.stl_import, "obj": bpy.ops.wm.obj_import, "ply": bpy.ops.wm.ply_import}[kind](filepath=original); own = collections.Counter()
        for o in bpy.context.scene.objects:
            if o.type != "MESH": continue
            bm = bmesh.new(); bm.from_mesh(o.data); own.update(vertices=len(bm.verts), faces=len(bm.faces), border=sum(e.is_boundary for e in bm.edges), nm=sum(len(e.link_faces) > 2 for e in bm.edges)); bm.free()
        out["own"] = dict(own) or {"error": "no mesh"}
    except Exception as e: out["own"] = {"error": str(e).strip().splitlines()[-1][:80]}
    return out
def cgal(path, original):
    from CGAL.CGAL_Polyhedron_3 import Polyhedron_3
    import CGAL.CGAL_Polygon_mesh_processing as pmp
    p = Polyhedron_3(path); _, f = read_off(path); built = p.size_of_facets() == len(f) and len(f) > 0; out = {"built": built, "closed": built and p.is_closed()}
    if built:
        for i, t in enumerate(p.facets()): t.set_id(i)
        found = []; pmp.self_intersections(p, found); out["pairs that meet"] = sorted({edge(q.first.id(), q.second.id()) for q in found}); out["faces that meet others"] = sorted({i for q in out["pairs that meet"] for i in q})
        out["border edges"] = int(p.size_of_border_edges()) if p.normalize_border() is None else None
        if out["closed"] and not found: out["outward"] = bool(pmp.is_outward_oriented(p))
    return out
TOOLS = {"pymeshlab": pymeshlab, "blender": blender, "cgal": cgal}
if sys.argv[1:2] == ["--worker"]:
    said = os.dup(1); os.dup2(2, 1)
    for line in sys.stdin:
        try: answer = TOOLS[sys.argv[2]](*line.rstrip("\n").split("\t"))
        except Exception as e: answer = {"error": f"{type(e).__name__}: {e}"[:200]}
        os.write(said, (json.dumps(answer) + "\n").encode())
    sys.exit()

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", required=True); p.add_argument("--only", nargs="*"); p.add_argument("--save"); p.add_argument("--load"); p.add_argument("--show"); o = p.parse_args()

class Worker:
    """One process of a tool that answers file after file; replaced when it takes too long or dies."""
    def __init__(self, name): self.name = name; self.start()
    def start(self): self.process = subprocess.Popen([sys.executable, os.path.abspath(__file__), "--worker", self.name], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL); self.first = True
    def ask(self, *words):
        self.process.stdin.write(("\t".join(words) + "\n").encode()); self.process.stdin.flush(); ready = select.select([self.process.stdout], [], [], LIMIT + 20 * self.first)[0]; self.first = False
        line = self.process.stdout.readline() if ready else b""
        if line: return json.loads(line)
        self.process.kill(); self.process.wait(); self.start(); return {"error": "no answer in time" if not ready else "ended without an answer"}
def ours(path, elements=True):
    run = subprocess.run([o.binary, "analyze", path, "--json", "--samples", "10000"], capture_output=True, timeout=120)
    try: report = json.loads(run.stdout)["before"]
    except (ValueError, KeyError): return {"error": run.stderr.decode("utf-8", "replace").strip()[:100]}
    short = {"counts": report["counts"], "properties": report["properties"], "codes": {d["code"]: d["count"] for d in report["defects"]}}
    if not elements: return short
    of = collections.defaultdict(list); truncated = [d["code"] for d in report["defects"] if d["count"] > 10000]
    for d in report["defects"]: of[d["code"]] = [([x["index"] for x in w["faces"]], [x["index"] for x in w["vertices"]]) for w in d["witnesses"]]
    pairs = {c: sorted({edge(*f[:2]) for f, _ in of[c]}) for c in ("self-intersection", "overlap", "touch")}
    return {**short, "truncated": truncated,
            "non-manifold edges": [edge(*v[:2]) for _, v in of["non-manifold-edge"]], "non-manifold vertices": [v[0] for _, v in of["non-manifold-vertex"]],
            "edges between opposite directions": [edge(*v[:2]) for _, v in of["orientation-conflict"]], "isolated vertices": [v[0] for _, v in of["isolated-vertex"]],
            "pairs": pairs, "duplicates": [f[0] for c in ("duplicate-face", "opposite-duplicate-face") for f, _ in of[c]],
            "coincident": [f[0] for f, _ in of["coincident-corners"]], "collinear": [f[0] for f, _ in of["collinear-face"]], "volume": report["measures"].get("volume")}
def collect():
    rows, workers = [], {n: Worker(n) for n in TOOLS}
    for line in open(os.path.join(shared, "corpus/MANIFEST.tsv")):
        if line.startswith("#"): continue
        id, path, *_ = line.rstrip("\n").split("\t")
        if path.lower().endswith(".3mf") or (o.only and id not in o.only): continue
        source = os.path.join(shared, "corpus", path); row = {"id": id, "kind": path.rsplit(".", 1)[-1].lower()}
        with tempfile.TemporaryDirectory() as d:
            copy, mesh = os.path.join(d, "copy.off"), os.path.join(d, "mesh.off"); subprocess.run([o.binary, "convert", source, "-o", copy], capture_output=True, timeout=120)
            if not os.path.exists(copy): row["error"] = "not converted"; rows.append(row); continue
            v, f, _ = load_off(copy); v, f = v.tolist(), f.tolist(); seams = len(v); v, f = welded(v, f); points = [t for t in f if len(set(t)) < 3]; f = [t for t in f if len(set(t)) == 3]
            if not f: row["error"] = "no triangle with three positions"; rows.append(row); continue
            write_off(mesh, v, f); row.update(vertices=v, faces=f, joined=seams - len(v), points=len(points), original=ours(source, False), ours=ours(mesh))
            for name, worker in workers.items(): row[name] = worker.ask(mesh, source)
            try: row["soup"] = json.loads(subprocess.run([cgal_peer, "si", mesh, "-"], capture_output=True, timeout=LIMIT).stdout)["count"]
            except (ValueError, OSError, subprocess.TimeoutExpired): row["soup"] = None
        rows.append(row)
    return rows
rows = json.load(open(o.load)) if o.load else collect()
if o.save and not o.load: json.dump(rows, open(o.save, "w"))
