#!/usr/bin/env python3
"""Runs every GLB and glTF file of ../shared/formats through the program and prints Markdown: what is read or refused and why, what a repair makes of it, and whether its result verifies.

usage: gltf.py [--binary PATH] [--speed N] [--seconds 120]      with MESHMEND_SHARED; --speed times a GLB of N triangles beside trimesh (PyPI, with numpy)
"""
import argparse, collections, json, os, struct, subprocess, sys, tempfile, time
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary"); p.add_argument("--speed", type=int, default=0); p.add_argument("--seconds", type=float, default=120); o = p.parse_args()
folder = os.path.join(shared, "formats")
if not os.path.exists(os.path.join(folder, "MANIFEST.tsv")): sys.exit("the files are not here; set MESHMEND_SHARED")
binary = o.binary or os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend")

def run(*args):
    start = time.time()
    try: done = subprocess.run([binary, *args], capture_output=True, timeout=o.seconds)
    except subprocess.TimeoutExpired: return "timeout", b"", [f"meshmend: not done after {o.seconds:.0f} s"], o.seconds
    return done.returncode, done.stdout, done.stderr.decode("utf-8", "replace").strip().splitlines(), time.time() - start
rows = []
for kind in ("glb", "gltf"):
    for name in sorted(os.listdir(os.path.join(folder, kind))):
        src = os.path.join(folder, kind, name)
        with tempfile.TemporaryDirectory() as d:
            dst = os.path.join(d, f"out.{kind}")
            code, said, complaint, seconds = run("repair", src, "-o", dst, "--json")
            report = json.loads(said) if said.strip() else None
            verified = same = None
            if os.path.exists(dst):
                verified = run("verify", dst)[0] == 0
                same = open(src, "rb").read() == open(dst, "rb").read()
        # A file that cannot be read has a problem in the place of a report.
        if report is not None and "schema" not in report: complaint, report = [report.get("detail") or report.get("title") or ""], None
        rows.append(dict(name=f"{kind}/{name}", code=code, report=report, why=complaint[0].removeprefix("meshmend: ").replace(f"{src}: ", "") if complaint else "", verified=verified, same=same, seconds=seconds))

def cells(r):
    report = r["report"]
    if not report: return ["refused" if r["code"] == 2 else f"{r['code']}", "", "", r["why"].replace("|", "\\|")]
    verdict = report.get("verdict") or {}; outcome = verdict.get("outcome") or f"exit {r['code']}"
    before = report.get("before") or {}; triangles = (before.get("counts") or {}).get("triangles", "")
    left = [f"{c['name']} {c['count']}" for a in report.get("actions") or [] if a.get("step") == "left_out" for c in a.get("changes") or []]
    share = (report.get("deviation") or {}).get("identical_triangle_share")
    reasons = [reason["message"] for reason in verdict.get("reasons") or []]
    note = "; ".join(left) or (reasons[0] if outcome == "refused" and reasons else "")
    return [outcome, triangles, "" if share is None else f"{100 * share:.1f} %", note]
commit = subprocess.run(["git", "log", "-1", "--format=%h", "--", "src"], cwd=root, capture_output=True, text=True).stdout.strip()
print(f"# GLB and glTF files nobody here made\n\n{len(rows)} files of trimesh, assimp and Online3DViewer, commit {commit}; made by `experiments/gltf.py`.\n")
print("| figure | value |\n|---|---|")
returned = [r for r in rows if r["verified"] is not None]
print(f"| files without a report or a named reason | {sum(r['report'] is None and r['code'] not in (2, 'timeout') for r in rows)} |")
print(f"| read | {sum(r['report'] is not None for r in rows)} |\n| refused by name | {sum(r['report'] is None and r['code'] == 2 for r in rows)} |")
print(f"| returned | {len(returned)} |\n| of those verified as valid solids | {sum(r['verified'] for r in returned)} |\n| of those byte for byte | {sum(r['same'] for r in returned)} |")
print(f"| longest, whole process | {max(r['seconds'] for r in rows):.2f} s |\n")
print("| outcome | files |\n|---|---|")
for k, n in sorted(collections.Counter(cells(r)[0] for r in rows).items()): print(f"| {k} | {n} |")
print("\n| file | outcome | triangles | triangles kept | left out, or why it is refused |\n|---|---|---|---|---|")
for r in rows: print(f"| {r['name']} | " + " | ".join(str(c) for c in cells(r)) + " |")

if o.speed:
    import numpy, trimesh
    n = int((o.speed / 2) ** 0.5); i, j = numpy.meshgrid(numpy.arange(n + 1), numpy.arange(n + 1), indexing="ij")
    v = numpy.stack([i, j, numpy.sin(i / 9) * numpy.cos(j / 7)], axis=-1).reshape(-1, 3).astype("<f4")
    at = lambda a, b: (a * (n + 1) + b).ravel(); a, b = numpy.meshgrid(numpy.arange(n), numpy.arange(n), indexing="ij")
    f = numpy.concatenate([numpy.stack([at(a, b), at(a + 1, b), at(a + 1, b + 1)], 1), numpy.stack([at(a, b), at(a + 1, b + 1), at(a, b + 1)], 1)]).astype("<u4")
    doc = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(v), "type": "VEC3", "min": v.min(0).tolist(), "max": v.max(0).tolist()}, {"bufferView": 1, "componentType": 5125, "count": f.size, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": v.nbytes}, {"buffer": 0, "byteOffset": v.nbytes, "byteLength": f.nbytes}], "buffers": [{"byteLength": v.nbytes + f.nbytes}]}).encode()
    doc += b" " * (-len(doc) % 4); data = v.tobytes() + f.tobytes()
    with tempfile.TemporaryDirectory() as d:
        path = os.path.join(d, "large.glb")
        with open(path, "wb") as out: out.write(b"glTF" + struct.pack("<II", 2, 28 + len(doc) + len(data)) + struct.pack("<I", len(doc)) + b"JSON" + doc + struct.pack("<I", len(data)) + b"BIN\0" + data)
        ours, theirs = [], []
        for _ in range(7):
            report = json.loads(run("analyze", path, "--json")[1]); ours.append(report["timing_ms"]["read"])
            start = time.time(); mesh = trimesh.load(path, process=False, force="mesh"); theirs.append(time.time() - start); assert len(mesh.faces) == len(f)
    print(f"\n## Reading a GLB of {len(f):,} triangles\n\nMedian of 7, alternating. trimesh makes arrays of the buffers; Meshmend also finds the vertices that are one.\n\n| | ms |\n|---|---|")
    median = lambda x: sorted(x)[len(x) // 2]
    print(f"| Meshmend | {median(ours):.0f} |\n| trimesh {trimesh.__version__} | {1000 * median(theirs):.0f} |")
