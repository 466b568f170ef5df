#!/usr/bin/env python3
"""What Meshmend finds in the corpus beside MeshLab, Blender and CGAL, element by element; prints Markdown tables.

usage: findings.py --binary PATH [--only ID ...] [--save FILE] [--load FILE]     with MESHMEND_SHARED, run with a Python that has pymeshlab, bpy and cgal
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

def pymeshlab_reads(path):
    import pymeshlab as pm
    ms = pm.MeshSet(verbose=False); ms.load_new_mesh(path); t = ms.get_topological_measures(); m = ms.current_mesh()
    return {"vertices": m.vertex_number(), "faces": m.face_number(), "border": t["boundary_edges"]}
def blender_reads(path):
    import bpy, bmesh
    kind = path.rsplit(".", 1)[-1].lower()
    if kind == "off": return {"error": "no reader of this format"}
    bpy.ops.wm.read_factory_settings(use_empty=True); {"stl": bpy.ops.wm.stl_import, "obj": bpy.ops.wm.obj_import, "ply": bpy.ops.wm.ply_import}[kind](filepath=path); own = collections.Counter(border=0)
    for o in bpy.context.scene.objects:
        if o.type != "MESH": continue
        bm = bmesh.new(); bm.from_mesh(o.data); own.update(vertices=len(bm.verts), faces=len(bm.faces), border=sum(e.is_boundary for e in bm.edges)); bm.free()
    return dict(own) if own["vertices"] else {"error": "no mesh"}
def pymeshlab(path):
    import pymeshlab as pm
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
    return out
def blender(path):
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
    return out
def cgal(path):
    from CGAL.CGAL_Polyhedron_3 import Polyhedron_3
    import CGAL.CGAL_Polygon_mesh_processing as pmp
    p = Polyhedron_3(path); _, f = read_off(path); built = p.size_of_facets() == len(f) and len(f) > 0; out = {"built": built, "closed": built and p.is_closed()}
    if built:
        for i, t in enumerate(p.facets()): t.set_id(i)
        found = []; pmp.self_intersections(p, found); out["pairs that meet"] = sorted({edge(q.first.id(), q.second.id()) for q in found}); out["faces that meet others"] = sorted({i for q in out["pairs that meet"] for i in q})
        out["border edges"] = int(p.size_of_border_edges()) if p.normalize_border() is None else None
        if out["closed"] and not found: out["outward"] = bool(pmp.is_outward_oriented(p))
    return out
TOOLS = {"pymeshlab": pymeshlab, "blender": blender, "cgal": cgal}; READERS = {"pymeshlab": pymeshlab_reads, "blender": blender_reads}
if sys.argv[1:2] == ["--worker"]:
    said = os.dup(1); os.dup2(2, 1)
    for line in sys.stdin:
        how, path = line.rstrip("\n").split("\t")
        try: answer = (READERS if how == "read" else TOOLS)[sys.argv[2]](path)
        except Exception as e: answer = {"error": f"{type(e).__name__}: {str(e).strip().splitlines()[-1] if str(e).strip() else ''}"[:120]}
        os.write(said, (json.dumps(answer) + "\n").encode())
    sys.exit()

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", required=True); p.add_argument("--only", nargs="*"); p.add_argument("--save"); p.add_argument("--load"); o = p.parse_args()

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
            rounded = np.array(v, np.float32).astype(float)
            if (rounded != np.array(v)).any(): write_off(os.path.join(d, "rounded.off"), rounded.tolist(), f); row["rounded"] = ours(os.path.join(d, "rounded.off"))["pairs"]
            for name, worker in workers.items(): row[name] = worker.ask("find", mesh)
            for name in READERS: row[name]["own"] = workers[name].ask("read", source)
            try: row["soup"] = json.loads(subprocess.run([cgal_peer, "si", mesh, "-"], capture_output=True, timeout=LIMIT).stdout)["count"]
            except (ValueError, OSError, subprocess.TimeoutExpired): row["soup"] = None
        rows.append(row)
    return rows
rows = json.load(open(o.load)) if o.load else collect()
if o.save and not o.load: json.dump(rows, open(o.save, "w"))

KINDS = ("self-intersection", "overlap", "touch")
flat = lambda x: {tuple(sorted(i)) if isinstance(i, (list, tuple)) else i for i in x}
usable = [r for r in rows if "error" not in r]; known = lambda r, tool, key: key in r[tool]
def pairs_of(r): return {tuple(p): c for c in KINDS for p in r["ours"]["pairs"][c]}
def corners(r, i): return tuple(sorted(r["faces"][i]))
def at_edges(r, edges): return {i for i, t in enumerate(r["faces"]) if any(edge(t[k], t[(k + 1) % 3]) in edges for k in range(3))}
CLASSES = [("edges of three triangles or more", "blender", lambda r: flat(r["ours"]["non-manifold edges"]), "non-manifold edges"),
           ("faces at such edges", "pymeshlab", lambda r: at_edges(r, flat(r["ours"]["non-manifold edges"])), "faces at non-manifold edges"),
           ("non-manifold vertices", "blender", lambda r: flat(r["ours"]["non-manifold vertices"]), "non-manifold vertices"),
           ("non-manifold vertices", "pymeshlab", lambda r: flat(r["ours"]["non-manifold vertices"]), "non-manifold vertices"),
           ("edges whose two triangles run in one direction", "blender", lambda r: flat(r["ours"]["edges between opposite directions"]), "edges between opposite directions"),
           ("isolated vertices", "blender", lambda r: flat(r["ours"]["isolated vertices"]), "isolated vertices"),
           ("duplicate triangles", "pymeshlab", lambda r: {corners(r, i) for i in r["ours"]["duplicates"]}, "duplicate triangles"),
           ("triangles with three corners on a line", "pymeshlab", lambda r: {corners(r, i) for i in r["ours"]["collinear"]}, "degenerate triangles"),
           ("triangles with three corners on a line", "blender", lambda r: {corners(r, i) for i in r["ours"]["collinear"]}, "degenerate triangles"),
           ("the same, Blender's default limit of area 0.0001", "blender", lambda r: {corners(r, i) for i in r["ours"]["collinear"]}, "degenerate triangles, limit 0.0001"),
           ("faces that meet others", "pymeshlab", lambda r: {i for p in pairs_of(r) for i in p}, "faces that meet others"),
           ("pairs of faces that meet", "blender", lambda r: set(pairs_of(r)), "pairs that meet"), ("pairs of faces that meet", "cgal", lambda r: set(pairs_of(r)), "pairs that meet")]
commit = subprocess.run(["git", "log", "-1", "--format=%h", "--", "src"], cwd=root, capture_output=True, text=True).stdout.strip()
print(f"# Findings beside other tools\n\n{len(usable)} STL, OBJ, OFF and PLY files of the corpus ({len(rows) - len(usable)} more have no triangle to compare), engine of commit {commit}; made by `experiments/findings.py`.\n"
      "PyMeshLab's filters, Blender's checks for printing (through `bmesh` and its bounding volume tree) and CGAL's polyhedral surface.\n\n"
      "## Element by element\n\nThe same triangles for all, bit-equal positions joined, triangles with two corners at one position left out. *Files*: with such an element in either.\n\n"
      "| elements | tool | files | with the same set | elements in both | only ours | only theirs |\n|---|---|---|---|---|---|---|")
for name, tool, mine, key in CLASSES:
    files = same = both = we = they = 0
    for r in usable:
        if not known(r, tool, key) or (r["ours"]["truncated"] and "meet" in name): continue
        a, b = mine(r), flat(r[tool][key]); files += bool(a or b); same += bool(a or b) and a == b; both += len(a & b); we += len(a - b); they += len(b - a)
    print(f"| {name} | {tool} | {files} | {same} | {both:,} | {we:,} | {they:,} |")
print("\nWhere only counts are given:\n\n| count | tool | files | with the same count |\n|---|---|---|---|")
def count(name, tool, pairs): pairs = [p for p in pairs if p[0] is not None and p[1] is not None and (p[0] or p[1])]; print(f"| {name} | {tool} | {len(pairs)} | {sum(a == b for a, b in pairs)} |")
count("border edges", "blender", [(r["ours"]["counts"]["boundary_edges"], len(r["blender"]["border edges"]) if known(r, "blender", "border edges") else None) for r in usable])
count("border edges", "pymeshlab", [(r["ours"]["counts"]["boundary_edges"], r["pymeshlab"].get("counts", {}).get("border edges")) for r in usable])
count("border edges", "cgal, where it builds a surface", [(r["ours"]["counts"]["boundary_edges"], r["cgal"].get("border edges")) for r in usable])
count("edges of three triangles or more", "pymeshlab", [(len(r["ours"]["non-manifold edges"]), r["pymeshlab"].get("counts", {}).get("non-manifold edges")) for r in usable])
def triangles_at(r): of = flat(r["ours"]["non-manifold edges"]); return sum(edge(t[k], t[(k + 1) % 3]) in of for t in r["faces"] for k in range(3))
count("the same, counted once for each triangle there", "pymeshlab", [(triangles_at(r), r["pymeshlab"].get("counts", {}).get("non-manifold edges")) for r in usable])
count("pairs of faces that meet", "cgal, any triangles", [(sum(r["ours"]["codes"].get(k, 0) for k in KINDS), r.get("soup")) for r in usable])

print("\n## Faces that meet, by kind\n\nPairs that only we name, by our code and by how many vertices the two triangles share; Blender by pairs, PyMeshLab by faces none of whose pairs it told.\n\n| our code | shared vertices | pairs | not told by Blender | pairs of faces not told by PyMeshLab |\n|---|---|---|---|---|")
table = collections.defaultdict(lambda: [0, 0, 0]); extra = collections.Counter()
for r in usable:
    if r["ours"]["truncated"]: continue
    mine, shared_by = pairs_of(r), lambda p: len(set(r["faces"][p[0]]) & set(r["faces"][p[1]])); bl, pm = flat(r["blender"].get("pairs that meet", [])), flat(r["pymeshlab"].get("faces that meet others", []))
    for q, code in mine.items(): row = table[code, shared_by(q)]; row[0] += 1; row[1] += known(r, "blender", "pairs that meet") and q not in bl; row[2] += known(r, "pymeshlab", "faces that meet others") and not (q[0] in pm or q[1] in pm)
    rounded = {tuple(q) for c in KINDS for q in (r.get("rounded") or r["ours"]["pairs"])[c]}; dup = {corners(r, i) for i in r["ours"]["duplicates"]}; flat_ones = set(r["ours"]["collinear"])
    for q in bl - set(mine): extra["blender", "true of the float32 coordinates it stores" if q in rounded else "a copy of a duplicate triangle" if corners(r, q[0]) in dup or corners(r, q[1]) in dup else "they share a vertex and do not meet elsewhere" if shared_by(q) else "they share no vertex and do not meet"] += 1
    faces = {i for q in mine for i in q}; near = {i for q in rounded for i in q}
    for i in pm - faces: extra["pymeshlab", "a copy of a duplicate triangle" if corners(r, i) in dup else "a corner is on the line of the others" if i in flat_ones else "true of float32 coordinates" if i in near else "meets nothing in exact arithmetic"] += 1
    for q in flat(r["cgal"].get("pairs that meet", [])) - set(mine): extra["cgal", "a triangle with three corners on a line, paired with itself" if q[0] == q[1] and q[0] in flat_ones else "other"] += 1
for (code, n), row in sorted(table.items()): print(f"| {code} | {n} | {row[0]:,} | {row[1]:,} | {row[2]:,} |")
print("\n| only theirs | what it is | count |\n|---|---|---|")
for (tool, what), n in sorted(extra.items()): print(f"| {tool} | {what} | {n:,} |")

print("\n## Closed surfaces\n\n| ours: closed, manifold, oriented | CGAL builds a polyhedral surface | CGAL calls it closed | files |\n|---|---|---|---|")
word = lambda b: "yes" if b else "no"
def sound(r): q = r["ours"]["properties"]; return q["closed"] and q["edge_manifold"] and q["vertex_manifold"] and q["oriented"]
for k, n in sorted(collections.Counter((sound(r), r["cgal"].get("built"), r["cgal"].get("closed")) for r in usable).items(), key=str): print(f"| {word(k[0])} | {word(k[1])} | {word(k[2])} | {n} |")
print("\nOf surfaces that are sound so and meet nowhere:\n\n| our finding | CGAL: outward oriented | Blender turns triangles when asked for outward normals | files |\n|---|---|---|---|")
tell = lambda r: next((c for c in ("inverted-shell", "misnested-shell", "zero-volume-shell") if c in r["ours"]["codes"]), "none")
for k, n in sorted(collections.Counter((tell(r), word(r["cgal"]["outward"]), word(r["blender"].get("turned", 0) > 0)) for r in usable if "outward" in r["cgal"]).items()): print("| " + " | ".join(k) + f" | {n} |")

print("\n## As each tool reads the file\n\nBorder edges after the tool's own reader, beside ours (polygons count as they are in Blender, as triangles in the others).\n\n| tool | format | files | the same | more | fewer | not read |\n|---|---|---|---|---|---|---|")
for tool in READERS:
    for kind in ("stl", "obj", "ply", "off"):
        k, examples = collections.Counter(), []
        for r in usable:
            if r["kind"] != kind: continue
            own, mine = r[tool].get("own") or {"error": "none"}, r["original"]["counts"]["boundary_edges"]; k["not read" if "error" in own else "same" if own["border"] == mine else "more" if own["border"] > mine else "fewer"] += 1
        if sum(k.values()) > k["not read"]: print(f"| {tool} | {kind} | {sum(k.values())} | {k['same']} | {k['more']} | {k['fewer']} | {k['not read']} |")
odd = [(r["id"], t, (r[t].get("own") or {}).get("border"), r["original"]["counts"]["boundary_edges"]) for r in usable for t in READERS if "border" in (r[t].get("own") or {}) and r[t]["own"]["border"] < r["original"]["counts"]["boundary_edges"]]
if odd: print("\nFewer: " + "; ".join(f"{i} ({t} {a}, ours {b})" for i, t, a, b in odd) + ".")
failed = [(r["id"], t, r[t]["error"]) for r in rows for t in TOOLS if t in r and "error" in r[t]] + [(r["id"], t + ", reading", r[t]["own"]["error"]) for r in usable for t in READERS if "error" in (r[t].get("own") or {}) and r["kind"] != "off"]
print("\nNo answer: " + ("; ".join(f"{i} ({t}: {e})" for i, t, e in failed) or "none") + f". Left out of the lists of pairs, with more than the 10,000 that a report lists: {', '.join(r['id'] for r in usable if r['ours']['truncated']) or 'none'}.\n"
      f"Triangles with two corners at one position, left out above: {sum(r['points'] for r in usable if 'points' in r):,} in {sum(bool(r.get('points')) for r in usable)} files, all told as `coincident-corners` by the report of the file: "
      f"{'yes' if all(r['original']['codes'].get('coincident-corners', 0) == r['points'] for r in usable if 'points' in r) else 'no, see ' + ', '.join(r['id'] for r in usable if r['original']['codes'].get('coincident-corners', 0) != r.get('points', 0))}.")
