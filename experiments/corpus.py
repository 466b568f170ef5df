#!/usr/bin/env python3
"""Repairs every STL, OBJ, OFF and PLY file of the corpus and has the independent judge look at each input and each result; prints Markdown.

usage: corpus.py [--judge PATH] [--limit N] [--binary PATH] [--only ID ...] [--save FILE] [--load FILE] [--seconds 120] [--no-volumes]      with MESHMEND_SHARED; the judge is built by its own build.sh when no path is given
numpy is needed for the volumes; PLY needs trimesh, networkx, lxml and pillow (PyPI) as well in the Python that runs this, for the judge's reader.
"""
import argparse, collections, json, os, signal, subprocess, sys, tempfile, time
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--judge"); p.add_argument("--limit", type=int, default=0); p.add_argument("--binary"); p.add_argument("--only", nargs="*")
p.add_argument("--no-volumes", action="store_true"); p.add_argument("--save"); p.add_argument("--load"); p.add_argument("--seconds", type=float, default=120); o = p.parse_args()
if not os.path.exists(os.path.join(shared, "corpus/MANIFEST.tsv")): sys.exit("the corpus is not here; set MESHMEND_SHARED")
sys.path.insert(0, os.path.join(shared, "judge"))
from meshfile import load_any, write_msh
from winding_volume import cleaned, open_edges, oriented, winding_volume
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
# A child's peak begins with that of the process it was forked from, so a small one stands between.
LAUNCHER = "import os, sys; child = os.posix_spawn(sys.argv[2], sys.argv[2:], os.environ); _, status, used = os.wait4(child, 0); open(sys.argv[1], 'w').write(f'{os.waitstatus_to_exitcode(status)} {used.ru_maxrss}')"
def measured(*command):
    """Runs a command for at most `--seconds`: code or "timeout", its two outputs, and the largest resident memory of the process in bytes (at least some 10 MiB)."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err, tempfile.NamedTemporaryFile("r") as told:
        child = subprocess.Popen([sys.executable, "-I", "-S", "-c", LAUNCHER, told.name, *command], stdout=out, stderr=err, start_new_session=True)
        try: child.wait(o.seconds)
        except subprocess.TimeoutExpired: os.killpg(child.pid, signal.SIGKILL); child.wait()
        words = told.read().split(); out.seek(0); err.seek(0); code, peak = (int(words[0]), int(words[1]) * 1024) if words else ("timeout", 0)
        return code, out.read(), err.read(), peak
def stop_after(seconds):
    """Raises TimeoutError in the main thread that late; 0 takes it back."""
    def late(*_): raise TimeoutError
    signal.signal(signal.SIGALRM, late); signal.alarm(seconds)
def volume(path, returned):
    """{winding number >= 1} of an input without open borders after orientation, with its standard error; or why there is none."""
    stop_after(60)
    try:
        v, f, _ = load_any(path); v, f = cleaned(v, f)
        if not len(f): return {"none": "no triangle"}
        if (n := open_edges(f)[0]): return {"none": "open", "edges": n}
        f = oriented(v, f)
        if (n := open_edges(f)[1]): return {"none": "directions do not cancel", "edges": n}
        mean, error, lost = winding_volume(v, f, returned); return {"volume": mean, "error": error, "lost": lost}
    except TimeoutError: return {"none": "60 s"}
    except Exception as e: return {"none": str(e)[:80]}
    finally: stop_after(0)
good = lambda j: bool(j.get("printable")) and bool(j.get("stl_printable"))

rows = []
if o.load: rows = json.load(open(o.load))
for line in () if o.load else open(os.path.join(shared, "corpus/MANIFEST.tsv")):
    if line.startswith("#"): continue
    id, path, *_, vertices, faces, classes, licence = line.rstrip("\n").split("\t")
    if path.lower().endswith(".3mf"): continue
    if o.limit and len(rows) >= o.limit: break
    if o.only and id not in o.only: continue
    src = os.path.join(shared, "corpus", path)
    with tempfile.TemporaryDirectory() as d:
        dst = os.path.join(d, "out." + path.rsplit(".", 1)[-1].lower()); start = time.time()
        code, said, complaint, peak = measured(binary, "repair", src, "-o", dst, "--json"); seconds = time.time() - start
        try: report = json.loads(said)
        except ValueError: report = None
        try: before = judged(readable(src, d, "in.msh"), "--only")
        except Exception as e: before = {"error": str(e)[:100]}
        after = judged(readable(src, d, "in.msh"), readable(dst, d, "out.msh")) if os.path.exists(dst) else {}
        same = os.path.exists(dst) and open(src, "rb").read() == open(dst, "rb").read()
    rows.append(dict(id=id, src=src, classes=classes, code=code, seconds=seconds, report=report, before=before, after=after, same=same, peak=peak, volume={"none": "not asked"} if o.no_volumes else volume(src, after.get("vol")),
                     error=(complaint.decode("utf-8", "replace").strip().splitlines() or [""])[0] if code != "timeout" else "timeout"))
    if o.save: json.dump(rows, open(o.save, "w"))
outcome = lambda r: ((r["report"] or {}).get("verdict") or {}).get("outcome") or ("unreadable" if r["code"] == 2 else f"exit {r['code']}")
valid = [r for r in rows if good(r["before"])]; broken = [r for r in rows if not good(r["before"])]
returned = [r for r in rows if r["after"]]; fixed = [r for r in broken if r["after"]]
faithful = [r for r in fixed if good(r["after"]) and r["after"].get("vis_lost", 9) <= 0.01]
commit = subprocess.run(["git", "log", "-1", "--format=%h", "--", "src"], cwd=root, capture_output=True, text=True).stdout.strip()
print(f"# The corpus, repaired and judged\n\n{len(rows)} STL, OBJ, OFF and PLY files nobody here made, commit {commit}; made by `experiments/corpus.py`.\n"
      "The judge is an independent exact program; *printable* is its verdict both as written and after the float32 weld.\n")
print("| figure | value |\n|---|---|")
print(f"| files without a report or a positioned error (panic, hang, signal) | {sum(r['report'] is None and r['code'] != 2 for r in rows)} |")
print(f"| valid by the judge | {len(valid)} |\n| of those byte-identical | {sum(r['same'] for r in valid)} |")
print(f"| returned as printable | {len(returned)} |\n| of those printable by the judge | {sum(good(r['after']) for r in returned)} |")
print(f"| broken by the judge | {len(broken)} |\n| of those repaired | {len(fixed)} ({100 * len(fixed) / max(1, len(broken)):.0f} %) |")
print(f"| of those faithful (at most 1 % of the visible surface lost) | {len(faithful)} |")
print(f"| longest, mean seconds a file (whole process) | {max(r['seconds'] for r in rows):.2f}, {sum(r['seconds'] for r in rows) / len(rows):.3f} |")
largest = max(rows, key=lambda r: r["peak"])
print(f"| largest peak of resident memory (whole process) | {largest['peak'] / 2**20:.0f} MiB ({largest['id']}) |")
print("\n## Outcomes\n\n| outcome | files |\n|---|---|")
for k, n in sorted(collections.Counter(map(outcome, rows)).items()): print(f"| {k} | {n} |")
print("\n## Distances\n\nTwo-sided Hausdorff distance by the judge's samples, as a share of the diagonal, and visible surface lost.\n\n| outcome | files | Hausdorff, median | 95 % | visible surface lost, median | 95 % |\n|---|---|---|---|---|---|")
def at(share, values): values = sorted(values); return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")
for k in ("repaired", "rebuilt", "partial"):
    of = [r["after"] for r in rows if outcome(r) == k and r["after"]]
    columns = [[j[key] for j in of if isinstance(j.get(key), (int, float))] for key in ("hausdorff", "vis_lost")]
    if of: print(f"| {k} | {len(of)} | " + " | ".join(f"{at(0.5, c):.4f} | {at(0.95, c):.4f}" for c in columns) + " |")
print("\n## Memory\n\nPeak of resident memory of the process that repairs, the container's allocator settings not made.\n\n| | files | median MiB | 95 % | most |\n|---|---|---|---|---|")
for k in ("identical", "repaired", "rebuilt"):
    of = [r["peak"] / 2**20 for r in rows if outcome(r) == k]
    if of: print(f"| {k} | {len(of)} | {at(0.5, of):.0f} | {at(0.95, of):.0f} | {max(of):.0f} |")
print("\n## Volumes\n\nOf inputs without open borders: the volume of {winding number >= 1} after orientation (experiments/winding_volume.py: 2,704 lines, one in each cell of a grid,\n"
      "in each of eight random directions, and of up to 128 while the standard error is above 0.3 % or the answer open; the length inside is exact along each) against the volume\nof the returned mesh by the judge. The standard error is that of the directions.\n\n| | files | within 2 % | largest difference within | largest standard error |\n|---|---|---|---|---|")
def difference(r): return (r["after"]["vol"] - r["volume"]["volume"]) / r["volume"]["volume"]
asked = [r for r in rows if r["volume"].get("volume", 0) > 10 * r["volume"].get("error", 0) and "vol" in r["after"]]; beyond = lambda r: abs(difference(r)) > 0.02
for name, of in (("valid by the judge", [r for r in asked if good(r["before"])]), ("broken", [r for r in asked if not good(r["before"])])):
    near = [r for r in of if not beyond(r)]
    if of: print(f"| {name} | {len(of)} | {len(near)} | {100 * max((abs(difference(r)) for r in near), default=0):.2f} % | {100 * max(r['volume']['error'] / r['volume']['volume'] for r in of):.2f} % |")
why = collections.Counter(r["volume"].get("none") or ("nothing returned" if not r["after"] else "volume not positive") for r in rows if r not in asked)
print("\nNot asked: " + ", ".join(f"{k} {n}" for k, n in why.most_common()) + ".\n")
if any(map(beyond, asked)): print("| beyond 2 % | classes | outcome | {winding >= 1} | returned | difference |\n|---|---|---|---|---|---|")
for r in filter(beyond, asked): print(f"| {r['id']} | {r['classes']} | {outcome(r)} | {r['volume']['volume']:.6g} (error {r['volume']['error']:.1g}) | {r['after']['vol']:.6g} | {100 * difference(r):+.1f} % |")
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
