#!/usr/bin/env python3
"""What a binary makes of every fixture and of every file of ../shared/corpus: exit code, SHA-256 of the result, steps with their changes.
Two binaries that print the same make the same bytes by the same steps.

usage: digests.py BINARY [--operations repair,cut-stitch] [--seconds 120] > before.tsv     then `diff before.tsv after.tsv`
"""
import argparse, concurrent.futures, glob, hashlib, json, os, subprocess, tempfile
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("binary"); p.add_argument("--operations", default="repair,cut-stitch,fill-holes,convert"); p.add_argument("--seconds", type=float, default=120)
p.add_argument("--formats", default="obj,stl,off,ply", help="endings of the files that are taken"); o = p.parse_args()
folders = [os.path.join(root, "fixtures"), os.path.join(shared, "corpus")]
endings = tuple("." + ending for ending in o.formats.split(","))
files = sorted(f for folder in folders for f in glob.glob(os.path.join(folder, "**/*"), recursive=True) if f.lower().endswith(endings))

def row(job):
    path, operation = job
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out" + os.path.splitext(path)[1].lower())
        try: done = subprocess.run([o.binary, operation, path, "-o", out, "--json"], capture_output=True, timeout=o.seconds)
        except subprocess.TimeoutExpired: return f"{os.path.relpath(path, root)}\t{operation}\tnot done after {o.seconds:.0f} s"
        digest = hashlib.sha256(open(out, "rb").read()).hexdigest() if os.path.exists(out) else "-"
        report = json.loads(done.stdout) if done.stdout.strip().startswith(b"{") else {}
        steps = [(a.get("step"), a.get("changes")) for a in report.get("actions") or []]
        return f"{os.path.relpath(path, root)}\t{operation}\t{done.returncode}\t{digest}\t{json.dumps(steps, sort_keys=True)}"
jobs = [(path, operation) for path in files for operation in o.operations.split(",")]
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for line in pool.map(row, jobs): print(line, flush=True)
