#!/usr/bin/env python3
"""What two binaries make of the same files: outcome, steps and digest of the result of `repair`. Prints the files on which they differ.

usage: repair_results.py BINARY [BINARY] [--seconds 120] [--save FILE] [--folders FOLDER ...]

Without folders: the fixtures, and the corpus in `shared` beside the project (or MESHMEND_SHARED) where there is one. With one binary all results
are printed, a line each. Needs nothing but Python.
"""
import argparse, hashlib, json, os, subprocess, sys, tempfile

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("binaries", nargs="+")
p.add_argument("--seconds", type=float, default=120, help="for one run")
p.add_argument("--most", type=int, default=1 << 40, help="leave larger files out")
p.add_argument("--save", help="write the results of the last binary as JSON")
p.add_argument("--load", help="results of an earlier run, in place of a first binary")
p.add_argument("--folders", nargs="*", default=[os.path.join(root, "fixtures"), os.path.join(shared, "corpus")])
o = p.parse_args()


def result(binary, path):
    """Outcome, steps, digest."""
    with tempfile.TemporaryDirectory() as folder:
        made = os.path.join(folder, "made" + os.path.splitext(path)[1].lower())
        try:
            ran = subprocess.run([binary, "repair", path, "--json", "-o", made], capture_output=True, timeout=o.seconds)
        except subprocess.TimeoutExpired:
            return ["time", [], None]
        try:
            report = json.loads(ran.stdout or ran.stderr)
        except ValueError:
            return [f"exit {ran.returncode}", [], None]
        digest = hashlib.sha256(open(made, "rb").read()).hexdigest()[:16] if os.path.exists(made) else None
        outcome = (report.get("verdict") or {}).get("outcome") or report.get("code")
        return [outcome, [action["step"] for action in report.get("actions", [])], digest]


files = []
for folder in o.folders:
    for base, _, names in os.walk(folder):
        files += [os.path.join(base, name) for name in names if name.lower().endswith((".stl", ".obj", ".off", ".ply", ".glb", ".gltf", ".3mf"))]
files = [path for path in sorted(files) if os.path.getsize(path) <= o.most]
before = json.load(open(o.load)) if o.load else {}
now, differ = {}, 0
for path in files:
    name = os.path.join(*path.split(os.sep)[-2:])
    results = [result(binary, path) for binary in o.binaries]
    now[name] = results[-1]
    if name in before:
        results.insert(0, before[name])
    if len(results) < 2 or results[0] != results[1]:
        differ += 1
        for outcome, steps, digest in results:
            print(name, outcome, digest or "-", ",".join(steps), sep="\t", flush=True)
if o.save:
    json.dump(now, open(o.save, "w"), indent=1)
print(f"{len(files)} files, {differ} listed")
