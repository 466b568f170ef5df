#!/usr/bin/env python3
"""Real scans that are broken: findings before and after, what was done, the judge's word, other tools on the same file, and pictures; prints Markdown.

usage: scans.py --binary PATH [--judge PATH] [--only NAME ...] [--save FILE] [--load FILE] [--pictures | --no-peers]    with MESHMEND_SHARED and the peers' set-up; needs pyvista and pillow
The scans come with the peers: the Stanford dragon (their set-up fetches it), a range map and the Stanford bunny (PyMeshLab's own samples).
"""
import argparse, gzip, json, os, resource, select, shutil, subprocess, sys, tempfile, time
import numpy as np
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared")); sys.path.insert(0, os.path.join(shared, "judge"))
from meshfile import load_any, write_msh
peers = os.environ.get("MESH_PEERS_DIR") or os.path.join(tempfile.gettempdir(), "meshmend-peers")
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", required=True); p.add_argument("--judge", default=os.path.join(os.environ.get("MESH_JUDGE_DIR") or os.path.join(tempfile.gettempdir(), "meshmend-judge"), "judge"))
p.add_argument("--only", nargs="*"); p.add_argument("--save"); p.add_argument("--load"); p.add_argument("--pictures", action="store_true"); p.add_argument("--no-peers", action="store_true"); o = p.parse_args()
def samples():
    import importlib.util
    return os.path.join(os.path.dirname(importlib.util.find_spec("pymeshlab").origin), "tests/sample_meshes")
DRAGON = os.path.join(peers, "npm/package/models")
SCANS = [("bunny", "the Stanford bunny at 10,000 triangles, with five holes", os.path.join(samples(), "bunny10k_textured.obj"), (0.3, -1, 0.15), (0, 0, 1)),
         ("range-map", "one range map of a scanner, a face seen from the front", os.path.join(samples(), "rangemaps/face000.ply"), (0.15, 0.1, 1), (0, 1, 0)),
         ("dragon-res3", "the Stanford dragon as its authors decimated it to 47,794 triangles", os.path.join(DRAGON, "dragon_vrip_res3.ply.gz"), (0.25, 0.2, 1), (0, 1, 0)),
         ("dragon", "the Stanford dragon as reconstructed from its range images, whole", os.path.join(DRAGON, "dragon_vrip.ply"), (0.25, 0.2, 1), (0, 1, 0))]
PEERS = ("pymeshlab", "meshlib", "blender", "cgal_pmp", "cgal_wrap"); SECONDS = 120

def judged(*paths):
    try: return json.loads(subprocess.run([o.judge, *paths], capture_output=True, timeout=300).stdout)
    except (ValueError, subprocess.TimeoutExpired) as e: return {"error": str(e)[:60]}
def peer(name, source, out):
    """The peer's own pipeline (worker.py) on one mesh, in a process of its own."""
    child = subprocess.Popen([sys.executable, os.path.join(shared, "peers/worker.py"), name], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env={**os.environ, "MESH_PEERS_DIR": peers},
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS)))
    try:
        ready = child.stdout.readline()
        if not ready: return {"error": "did not start"}
        child.stdin.write(f"{source}\t{out}\n".encode()); child.stdin.flush()
        if not select.select([child.stdout], [], [], 4 * SECONDS)[0]: return {"error": f"no result in {4 * SECONDS} s"}
        line = child.stdout.readline(); answer = json.loads(line) if line else {"error": f"no result in {SECONDS} s of a processor"}
        return {**answer, "error": f"no result in {SECONDS} s of a processor"} if "rc -9" in answer.get("error", "") or "rc -24" in answer.get("error", "") else answer
    finally: child.kill(); child.wait()
def rows_of(v, f):
    """Each triangle as its three float32 positions in sorted order, one opaque value each."""
    t = v[f].astype(np.float32) + np.float32(0); order = np.argsort((t[..., 0].astype(np.float64) * 1.1 + t[..., 1] * 1.7 + t[..., 2] * 2.3), axis=1)
    t = np.take_along_axis(t, order[..., None], axis=1).reshape(len(f), 9); return np.ascontiguousarray(t).view(np.dtype((np.void, 36))).ravel()
def border(v, f):
    """Edges with one triangle after joining bit-equal positions, as pairs of vertex numbers."""
    _, number = np.unique(v + 0.0, axis=0, return_inverse=True); w = number.ravel()[f]; w = w[(w[:, 0] != w[:, 1]) & (w[:, 1] != w[:, 2]) & (w[:, 0] != w[:, 2])]
    first = np.zeros(number.max() + 1, int); first[number.ravel()] = np.arange(len(v)); e = np.sort(np.vstack([w[:, [0, 1]], w[:, [1, 2]], w[:, [2, 0]]]), axis=1); e, n = np.unique(e, axis=0, return_counts=True)
    return first[e[n == 1]]

def picture(name, before, after, found, view, up):
    """Whole and close-up, before and after, one camera each: red borders, magenta faces that meet others, orange faces at other defects, green new triangles."""
    import pyvista as pv
    from PIL import Image
    pv.global_theme.anti_aliasing = "ssaa"
    (v, f), (w, g) = before, after; mesh = lambda a, b: pv.PolyData.from_regular_faces(a, b)
    lo, hi = v[f.ravel()].min(0), v[f.ravel()].max(0); centre, size = (lo + hi) / 2, np.linalg.norm(hi - lo); new = np.nonzero(~np.isin(rows_of(w, g), rows_of(v, f)))[0]; all_new = len(new) > len(g) / 2
    lines = border(v, f); marked = {"magenta": found["meet"], "orange": found["other"]}
    places = np.vstack([v[f[x]].mean(1) for x in marked.values() if len(x)] + ([v[lines].mean(1)] if len(lines) else [])); direction = np.array(view, float) / np.linalg.norm(view)
    if len(found["meet"]): places = v[f[found["meet"]]].mean(1)
    seen = places[(places - centre) @ direction > -0.05 * size]; seen = seen if len(seen) else places; pick = seen[::max(1, len(seen) // 400)]
    edge = np.linalg.norm(v[f[:, 0]] - v[f[:, 1]], axis=1).mean(); spread = min(0.06 * size, 7 * edge); focus = pick[np.argmax([(np.linalg.norm(seen - q, axis=1) < spread).sum() for q in pick])]
    near = f[np.linalg.norm(v[f].mean(1) - focus, axis=1) < 0.5 * spread]; ahead = np.cross(v[near[:, 1]] - v[near[:, 0]], v[near[:, 2]] - v[near[:, 0]]).sum(0); ahead = ahead / np.linalg.norm(ahead) if np.linalg.norm(ahead) > 0 else direction
    plotter = pv.Plotter(off_screen=True, shape=(2, 2), window_size=(1080, 900), border=True, border_color="white")
    for row, (target, scale) in enumerate(((centre, 0.34 * size), (focus, spread))):
        for column, (title, m) in enumerate((("before", mesh(v, f)), ("after", mesh(w, g)))):
            plotter.subplot(row, column); plotter.add_mesh(m, color="#cfcfcf", show_edges=bool(row), edge_color="#808080", line_width=1, ambient=0.25, diffuse=0.75, backface_params={"color": "#d8b48c", "ambient": 0.35})
            if column == 0:
                for colour, x in marked.items():
                    if not len(x): continue
                    plotter.add_mesh(mesh(v, f[x]), color=colour, ambient=1, diffuse=0, show_edges=bool(row), edge_color="black")
                    if not row: plotter.add_points(v[f[x]].mean(1), color=colour, point_size=5 if len(found['other']) > 400 else 10)
                if len(lines): plotter.add_mesh(pv.PolyData(v, lines=np.c_[np.full(len(lines), 2), lines].ravel()), color="red", line_width=4 if not row else 6, lighting=False)
            elif len(new) and not all_new:
                plotter.add_mesh(mesh(w, g[new]), color="#28be5a", ambient=0.5, show_edges=bool(row), edge_color="black")
                if not row: plotter.add_points(w[g[new]].mean(1), color="#28be5a", point_size=4 if len(new) > 400 else 8)
            plotter.add_text(f"{title}{'' if not row else ', close-up'}", font_size=11, color="black"); plotter.camera.parallel_projection = True
            plotter.camera.focal_point = target; plotter.camera.position = target + (ahead * spread if row else direction * size * 2); plotter.camera.up = up if abs(np.dot(ahead, up)) < 0.95 or not row else (1, 0, 0)
            plotter.camera.parallel_scale = scale; plotter.camera.clipping_range = (spread * 0.01, size * 4)  # what is in front of a close-up is cut away
    os.makedirs(os.path.join(root, "docs/pictures"), exist_ok=True); file = os.path.join(root, f"docs/pictures/scan-{name}.png"); shot = Image.fromarray(plotter.screenshot(return_img=True)); plotter.close()
    for greys in (48, 32, 20, 14, 10):
        palette = Image.new("P", (1, 1)); ramp = lambda c: [[int(x * k / 6) for x in c] for k in range(1, 7)]; greyscale = [[round(255 * k / (greys - 1))] * 3 for k in range(greys)]
        palette.putpalette([x for c in greyscale + sum(map(ramp, ((255, 0, 0), (255, 0, 255), (255, 165, 0), (40, 190, 90), (216, 180, 140))), []) for x in c])
        shot.quantize(palette=palette, dither=Image.Dither.NONE).save(file, optimize=True)
        if os.path.getsize(file) <= 150_000: break
    return len(new)

results = json.load(open(o.load)) if o.load else []
for name, what, path, view, up in () if o.load else SCANS:
    if o.only and name not in o.only: continue
    if not os.path.exists(path): print(f"not here: {path}", file=sys.stderr); continue
    with tempfile.TemporaryDirectory() as d:
        source = os.path.join(d, os.path.basename(path).removesuffix(".gz"))
        with (gzip.open if path.endswith(".gz") else open)(path, "rb") as i, open(source, "wb") as t: shutil.copyfileobj(i, t)
        out = os.path.join(d, "out." + source.rsplit(".", 1)[-1]); start = time.time()
        report = json.loads(subprocess.run([o.binary, "repair", source, "-o", out, "--json", "--samples", "10000"], capture_output=True, timeout=600).stdout); seconds = time.time() - start
        v, f, _ = load_any(source); w, g, _ = load_any(out); a, b, c = (os.path.join(d, x) for x in ("in.msh", "out.msh", "peer.msh")); write_msh(a, v, f); write_msh(b, w, g)
        of = lambda codes: np.array(sorted({x["index"] for k in report["before"]["defects"] if k["code"] in codes for q in k["witnesses"] for x in q["faces"]}), int)
        found = {"meet": of(("self-intersection", "overlap", "touch")), "other": of(("non-manifold-edge", "duplicate-face", "opposite-duplicate-face", "coincident-corners", "isolated-face"))}
        edges = len(border(v, f)); said = report["before"]["counts"]["boundary_edges"]
        if edges != said: print(f"{name}: {edges} border edges here, {said} in the report", file=sys.stderr)
        new = picture(name, (v, f), (w, g), found, view, up)
        if o.pictures: continue
        row = dict(name=name, what=what, file=os.path.basename(source), report={k: report[k] for k in ("before", "after", "actions", "deviation", "verdict")}, seconds=seconds, new=new, before=judged(a, "--only"), after=judged(a, b), peers={})
        for q in ("before", "after"):
            for k in row["report"][q]["defects"]: k["witnesses"] = []
        for q in () if o.no_peers else PEERS:
            if os.path.exists(c): os.remove(c)
            row["peers"][q] = {**peer(q, a, c), "judge": judged(a, c) if os.path.exists(c) else {}}
    results.append(row)
    if o.save: json.dump(results, open(o.save, "w"))

commit = subprocess.run(["git", "log", "-1", "--format=%h", "--", "src"], cwd=root, capture_output=True, text=True).stdout.strip()
print(f"# Real scans, before and after\n\nScanned surfaces that are not valid solids as they are, engine of commit {commit}; made by `experiments/scans.py`.\n")
counts = lambda side: ", ".join(f"{k['code']} {k['count']:,}" for k in side["defects"]) or "none"
word = lambda j: "no answer" if "error" in j or not j else ("printable" if j.get("printable") and j.get("stl_printable") else "not printable") + "".join(f", {t} {j[k]:,}" for k, t in (("boundary", "border edges"), ("nm_edges", "non-manifold edges"), ("nm_verts", "non-manifold vertices"), ("degen", "degenerate"), ("dup", "duplicates"), ("si", "pairs that meet")) if j.get(k))
number = lambda x, form: "" if not isinstance(x, (int, float)) else format(x, form)
for r in results:
    t = r["report"]; dev, j = t["deviation"], r["after"]; done = "; ".join(f"{x['step']} (" + ", ".join(f"{q['name']} {q['count']:,}" for q in x["changes"] if q["count"]) + ")" for x in t["actions"] if any(q["count"] for q in x["changes"]))
    print(f"## {r['name']}: {r['what']}\n\n![{r['name']}, before and after](../pictures/scan-{r['name']}.png)\n\n| | before | after |\n|---|---|---|")
    print(f"| triangles, parts | {t['before']['counts']['triangles']:,}, {t['before']['counts']['components']} | {t['after']['counts']['triangles']:,}, {t['after']['counts']['components']} |")
    print(f"| findings | {counts(t['before'])} | {counts(t['after'])} |\n| the judge | {word(r['before'])} | {word(j)} |")
    print(f"\nOutcome `{t['verdict']['outcome']}`. Done: {done}.\n{100 * (dev['identical_triangle_share'] or 0):.2f} % of the triangles are bit-identical; {r['new']:,} triangles of the result are not in the file. "
          f"Hausdorff distance by the judge's samples {number(j.get('hausdorff'), '.5f')} of the diagonal, visible surface lost {number(j.get('vis_lost'), '.5f')}.\n")
    if r["peers"]: print("| tool | result | triangles | triangles kept | Hausdorff / diagonal | visible surface lost |\n|---|---|---|---|---|---|")
    for q, x in {"Meshmend": {"judge": j, "t": r["seconds"], "nf": t["after"]["counts"]["triangles"]}, **r["peers"]}.items() if r["peers"] else ():
        k = x["judge"]; print(f"| {q} | {x.get('error') or word(k)} | {number(x.get('nf'), ',')} | {number(k.get('untouched'), '.1%')} | {number(k.get('hausdorff'), '.4f')} | {number(k.get('vis_lost'), '.4f')} |")
    print()
