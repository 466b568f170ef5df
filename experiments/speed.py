#!/usr/bin/env python3
"""Reading, analysis and certificate beside the peers on one mesh, alternating in one run; prints a Markdown table of ratios.

usage: speed.py [--rounds 3] [--mesh m1]     with MESHMEND_SHARED and the peers' own set-up done (see its README)
Ours is timed by `cargo bench --bench stages`; a peer by its `bench.py one`, a fresh process each. Every figure is a median of the rounds.
"""
import argparse, json, os, re, statistics, subprocess, sys, tempfile
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
peers = os.environ.get("MESH_PEERS_DIR") or os.path.join(tempfile.gettempdir(), "meshmend-peers")
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--rounds", type=int, default=3); p.add_argument("--mesh", default="m1"); o = p.parse_args()
python, bench = os.path.join(peers, "venv/bin/python"), os.path.join(shared, "peers/bench.py")
stl = os.path.join(peers, "bench", o.mesh + ".stl")
for f in (python, bench, stl):
    if not os.path.exists(f): sys.exit(f"not here: {f}; set up the peers first")
READ, ANALYZE = ("admesh", "meshlib", "trimesh", "pymeshlab"), ("meshlib", "cgal", "pymeshlab")
subprocess.run(["cargo", "build", "--release", "--locked", "-q"], cwd=root, check=True)
subprocess.run(["cargo", "bench", "--locked", "--bench", "stages", "--no-run", "-q"], cwd=root, check=True)

def ours():
    out = subprocess.run(["cargo", "bench", "--locked", "-q", "--bench", "stages", "--", stl, "3"], cwd=root, check=True, capture_output=True, text=True).stdout
    return json.loads(next(l for l in out.splitlines() if l.startswith("{")))
def peer(kind, name):
    out = subprocess.run([python, bench, "one", kind, name, o.mesh], capture_output=True, text=True).stdout
    return json.loads(out).get("t")
def peak_bytes(*command):
    """Largest resident memory of a whole process, as the system counts it."""
    code = "import resource,subprocess,sys; subprocess.run(sys.argv[1:],stdout=subprocess.DEVNULL); print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss*1024)"
    return int(subprocess.run([sys.executable, "-c", code, *command], capture_output=True, text=True, check=True).stdout)

seconds, mine = {}, []
for _ in range(o.rounds):
    mine.append(ours())
    for name in READ: seconds.setdefault(("read", name), []).append(peer("stl" if name == "trimesh" else "weld", name))
    for name in ANALYZE: seconds.setdefault(("analyze", name), []).append(peer("analyse", name))
med = lambda values: statistics.median(v for v in values if v is not None) if any(values) else None
read, both, cert = (med([m[k] for m in mine]) for k in ("read", "analyze_and_certify", "certify")); n = mine[0]["triangles"]
commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
print(f"# Speed beside other programs\n\n{n:,} triangles (binary STL), {os.cpu_count()} cores, commit {commit}, median of {o.rounds} alternating rounds.\n"
      f"Made by `experiments/speed.py --rounds {o.rounds} --mesh {o.mesh}`. Ratios hold for this run; the seconds are of one noisy machine.\n")
print("| what | program | seconds | ours is faster by |\n|---|---|---|---|")
print(f"| read + exact weld | Meshmend | {read:.3f} | 1 |")
for name in READ: t = med(seconds["read", name]); print(f"| read + exact weld | {name} | {t:.2f} | {t / read:.1f} x |" if t else f"| read + exact weld | {name} | failed | |")
print(f"| whole analysis with exact self-intersections, and the certificate | Meshmend | {both:.3f} (certificate alone {cert:.3f}) | 1 |")
for name in ANALYZE: t = med(seconds["analyze", name]); print(f"| topology and self-intersections | {name} | {t:.2f} | {t / both:.1f} x |" if t else f"| topology and self-intersections | {name} | failed | |")
binary = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend")
with tempfile.TemporaryDirectory() as d:
    print(f"\nPeak resident memory of the whole process: `analyze` {peak_bytes(binary, 'analyze', stl) / n:.0f} bytes per triangle, "
          f"`repair` {peak_bytes(binary, 'repair', stl, '-o', os.path.join(d, 'out.stl')) / n:.0f} bytes per triangle (the file itself: {os.path.getsize(stl) / n:.0f}).")
