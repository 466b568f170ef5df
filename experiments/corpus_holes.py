#!/usr/bin/env python3
"""Fills the holes of every file of the corpus whose manifest says that it is open, and says what became of each boundary loop and why; prints Markdown.

usage: corpus_holes.py [--binary PATH] [--faces 150000] [--seconds 120]      with MESHMEND_SHARED
"""
import argparse, collections, csv, json, os, subprocess, sys, tempfile
root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared")); corpus = os.path.join(shared, "corpus")
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary"); p.add_argument("--faces", type=int, default=150_000); p.add_argument("--seconds", type=float, default=120); o = p.parse_args()
if not os.path.exists(os.path.join(corpus, "MANIFEST.tsv")): sys.exit("the corpus is not here; set MESHMEND_SHARED")
if not o.binary: subprocess.run(["cargo", "build", "--release", "--locked", "-q"], cwd=root, check=True)
binary = o.binary or os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend")

FATES = ["filled", "rejected", "no-loop"]
def fill(path, to):
    """The report of one file, or why there is none."""
    try: done = subprocess.run([binary, "fill-holes", path, "-o", to, "--json"], capture_output=True, timeout=o.seconds)
    except subprocess.TimeoutExpired: return f"more than {o.seconds:g} s"
    try: return json.loads(done.stdout)
    except ValueError: return done.stderr.decode(errors="replace").strip().split("\n")[0][:90] or f"exit code {done.returncode}"
def why(hole):
    """The last reason of each method, in the order in which they were tried."""
    return ", ".join(f"{method}: {reason}" for method, reason in {one["method"]: one["reason"] for one in hole["rejected"]}.items())

with open(os.path.join(corpus, "MANIFEST.tsv"), newline="") as f: rows = [r for r in csv.DictReader(f, delimiter="\t") if "open" in r["classes"].split(",")]
sums, lines, larger = collections.Counter(), [], 0
for row in rows:
    if int(row["faces"]) > o.faces: larger += 1; continue
    path = os.path.join(corpus, row["path"]); own = os.path.splitext(path)[1].lower()
    with tempfile.TemporaryDirectory() as d: report = fill(path, os.path.join(d, "filled" + (own if own in (".stl", ".obj", ".off", ".ply") else ".off")))
    if isinstance(report, str): lines.append(f"| {row['#id']} | {row['faces']} | | | | {report} |"); sums["files without a report"] += 1; continue
    holes = report["holes"] or []; count = collections.Counter(hole["fate"] for hole in holes); sums.update(count); sums["files"] += 1
    sums["files without a loop"] += not holes; sums["files with every loop filled"] += bool(holes) and count["filled"] == len(holes)
    if count["filled"] == len(holes): continue
    reasons = collections.Counter(why(hole) for hole in holes if hole["fate"] == "rejected").most_common(1)
    told = f"{reasons[0][0]} ({reasons[0][1]})" if reasons else "faces there point against each other, or more than two faces meet"
    lines.append(f"| {row['#id']} | {row['faces']} | {count['filled']} | {count['rejected']} | {count['no-loop']} | {told} |")
commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
print(f"""# The boundary loops of the corpus

Engine of commit {commit}; made by `experiments/corpus_holes.py`. `fill-holes` by `auto` on the {sums['files'] + sums['files without a report']} files of the corpus that its manifest calls open and that have at most {o.faces:,} faces ({larger} are larger): of {sum(sums[f] for f in FATES):,} holes (boundary loops, or several that get one patch) {sums['filled']:,} are filled,
{sums['rejected']:,} have no sound patch and stay open, {sums['no-loop']} are no simple loop. Of the files {sums['files with every loop filled']} have no open loop any more, {sums['files without a loop']} had none,
and {sums['files without a report']} gave no report. Nothing is chosen to stay. The rest, one by one, with the reason that most of the loops that stay open have
([what the reasons mean](../holes.md#the-operation)). The border of a flat sheet, of a terrain or of a shell whose inside is full of other walls has no patch that meets nothing; `repair`
makes walls of sheets, and unites what passes through itself.
""")
print("| file | faces | filled | no sound patch | no loop | why |\n|---|---|---|---|---|---|"); print("\n".join(lines))
