#!/usr/bin/env python3
"""Repairs every STL, OBJ, OFF and PLY file of the corpus and has the independent judge look at each input and each result; prints Markdown.

usage: corpus.py [--judge PATH] [--limit N] [--binary PATH] [--only ID ...] [--save FILE]      with MESHMEND_SHARED; the judge is built by its own build.sh when no path is given
PLY needs numpy, trimesh, networkx, lxml and pillow (PyPI) in the Python that runs this, for the judge's reader.
"""
import argparse, collections, json, os, subprocess, sys, tempfile, time
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--judge"); p.add_argument("--limit", type=int, default=0); p.add_argument("--binary"); p.add_argument("--only", nargs="*")
p.add_argument("--save"); o = p.parse_args()
if not os.path.exists(os.path.join(shared, "corpus/MANIFEST.tsv")): sys.exit("the corpus is not here; set MESHMEND_SHARED")
sys.path.insert(0, os.path.join(shared, "judge"))
from meshfile import load_any, write_msh
judge = o.judge or subprocess.run(["bash", os.path.join(shared, "judge/build.sh")], capture_output=True, text=True, check=True).stdout.split()[-1]
if not o.binary: subprocess.run(["cargo", "build", "--release", "--locked", "-q"], cwd=root, check=True)
binary = o.binary or os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend")

def readable(path, d, name):
    """The judge reads STL, OBJ and OFF itself; PLY is converted, index for index."""
    if path.lower().endswith((".stl", ".obj", ".off")): return path
    V, F, _ = load_any(path); q = os.path.join(d, name); write_msh(q, V, F); return q
def judged(*paths):
    try: return json.loads(subprocess.run([judge, *paths], capture_output=True, timeout=300).stdout)
    except Exception as e: return {"error": str(e)[:100]}
good = lambda j: bool(j.get("printable")) and bool(j.get("stl_printable"))

rows = []
for line in open(os.path.join(shared, "corpus/MANIFEST.tsv")):
    if line.startswith("#"): continue
    id, path, *_, vertices, faces, classes, licence = line.rstrip("\n").split("\t")
    if path.lower().endswith(".3mf"): continue
    if o.limit and len(rows) >= o.limit: break
    if o.only and id not in o.only: continue
    src = os.path.join(shared, "corpus", path)
    with tempfile.TemporaryDirectory() as d:
        dst = os.path.join(d, "out." + path.rsplit(".", 1)[-1].lower()); start = time.time()
        try: run = subprocess.run([binary, "repair", src, "-o", dst, "--json"], capture_output=True, timeout=120); code = run.returncode
        except subprocess.TimeoutExpired: code = "timeout"
        seconds = time.time() - start
        try: report = json.loads(run.stdout)
        except ValueError: report = None
        try: before = judged(readable(src, d, "in.msh"), "--only")
        except Exception as e: before = {"error": str(e)[:100]}
        after = judged(readable(src, d, "in.msh"), readable(dst, d, "out.msh")) if os.path.exists(dst) else {}
        same = os.path.exists(dst) and open(src, "rb").read() == open(dst, "rb").read()
    rows.append(dict(id=id, src=src, classes=classes, code=code, seconds=seconds, report=report, before=before, after=after, same=same,
                     error=(run.stderr.decode("utf-8", "replace").strip().splitlines() or [""])[0] if code != "timeout" else "timeout"))
    if o.save: json.dump(rows, open(o.save, "w"))
outcome = lambda r: ((r["report"] or {}).get("verdict") or {}).get("outcome") or ("unreadable" if r["code"] == 2 else f"exit {r['code']}")
valid = [r for r in rows if good(r["before"])]; broken = [r for r in rows if not good(r["before"])]
returned = [r for r in rows if r["after"]]; fixed = [r for r in broken if r["after"]]
faithful = [r for r in fixed if good(r["after"]) and r["after"].get("vis_lost", 9) <= 0.01]
commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
print(f"# The corpus, repaired and judged\n\n{len(rows)} STL, OBJ, OFF and PLY files nobody here made, commit {commit}; made by `experiments/corpus.py`.\n"
      "The judge is an independent exact program; *printable* is its verdict both as written and after the float32 weld.\n")
print("| figure | value |\n|---|---|")
print(f"| files without a report or a positioned error (panic, hang, signal) | {sum(r['report'] is None and r['code'] != 2 for r in rows)} |")
print(f"| valid by the judge | {len(valid)} |\n| of those byte-identical | {sum(r['same'] for r in valid)} |")
print(f"| returned as printable | {len(returned)} |\n| of those printable by the judge | {sum(good(r['after']) for r in returned)} |")
print(f"| broken by the judge | {len(broken)} |\n| of those repaired | {len(fixed)} ({100 * len(fixed) / max(1, len(broken)):.0f} %) |")
print(f"| of those faithful (at most 1 % of the visible surface lost) | {len(faithful)} |")
print(f"| longest, mean seconds a file (whole process) | {max(r['seconds'] for r in rows):.2f}, {sum(r['seconds'] for r in rows) / len(rows):.3f} |")
print("\n## Outcomes\n\n| outcome | files |\n|---|---|")
for k, n in sorted(collections.Counter(map(outcome, rows)).items()): print(f"| {k} | {n} |")
print("\n## Distances\n\nTwo-sided Hausdorff distance by the judge's samples, as a share of the diagonal, and visible surface lost.\n\n| outcome | files | Hausdorff, median | 95 % | visible surface lost, median | 95 % |\n|---|---|---|---|---|---|")
def at(share, values): values = sorted(values); return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")
for k in ("repaired", "rebuilt", "partial"):
    of = [r["after"] for r in rows if outcome(r) == k and r["after"]]
    columns = [[j[key] for j in of if isinstance(j.get(key), (int, float))] for key in ("hausdorff", "vis_lost")]
    if of: print(f"| {k} | {len(of)} | " + " | ".join(f"{at(0.5, c):.4f} | {at(0.95, c):.4f}" for c in columns) + " |")
print("\n## Disagreements with the judge\n")
disagree = [r for r in rows if good(r["before"]) != (outcome(r) == "identical") or (r["after"] and not good(r["after"]))]
print("None: `identical` exactly where the judge calls the input valid, and every returned file is printable to it." if not disagree else "| file | classes | ours | judge |\n|---|---|---|---|")
for r in disagree:
    with tempfile.TemporaryDirectory() as d:
        # Whether it is the judge's reader of the format that takes the file otherwise: the same indices as OFF, which it reads itself.
        copy = os.path.join(d, "copy.off"); subprocess.run([binary, "convert", r["src"], "-o", copy], capture_output=True)
        again = judged(copy, "--only")
    said = {k: r["before"].get(k) for k in ("nv", "nf", "boundary", "nm_verts", "comps", "si")}
    print(f"| {r['id']} | {r['classes']} | {outcome(r)} | {'valid' if good(r['before']) else 'not valid'} before ({said}); the same vertices and indices as an OFF file: "
          f"{'valid' if good(again) else 'not valid'}, {again.get('nv')} vertices |")
print("\n## Broken files\n\n| file | classes | outcome | first reason | bit-identical triangles | visible surface lost |\n|---|---|---|---|---|---|")
for r in broken:
    reasons = ((r["report"] or {}).get("verdict") or {}).get("reasons") or [r["error"]]
    first = reasons[0] if isinstance(reasons[0], str) else reasons[0].get("code", json.dumps(reasons[0])[:80])
    share = ((r["report"] or {}).get("deviation") or {}).get("identical_triangle_share")
    print(f"| {r['id']} | {r['classes']} | {outcome(r)} | {first} | {'' if share is None else f'{100 * share:.1f} %'} | {'' if not r['after'] else format(r['after'].get('vis_lost', float('nan')), '.4f')} |")
