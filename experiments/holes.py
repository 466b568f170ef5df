#!/usr/bin/env python3
"""Hole filling with known answers: holes cut into closed models, filled by each method and by other tools, measured against the surface that was removed; prints Markdown.

usage: holes.py [--corpus DIR] [--judge PROGRAM] [--binary PROGRAM] [--ours METHOD ...] [--tools NAME ...] [--work DIR] [--models NAME ...] [--again] [--page]
needs numpy and scipy (and trimesh for --corpus); the other tools are optional: see holes_tools.py, which says what each needs.
`--work` keeps the holes (one .npz each: what is left, the rim, the removed surface) and a line of results.jsonl for each hole and tool, so that an interrupted run goes on; `--page` only prints.
"""
import argparse, glob, json, os, subprocess, sys, tempfile, time, zlib
import numpy as np
here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(here)
sys.path.insert(0, here)
import holes_cut, holes_measure, holes_models, holes_page, holes_tools

METHODS = ("auto", "flat", "minimal", "smooth", "creased", "rbf")
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--corpus", help="folder with closed models in STL, OBJ, OFF or PLY"); p.add_argument("--corpus-models", type=int, default=26)
p.add_argument("--judge", help="exact judge of intersections: PROGRAM FILE.msh --only; without it they are not counted")
p.add_argument("--binary", default=os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend"))
p.add_argument("--ours", nargs="*", default=METHODS, help="methods, each with further flags after a blank if you like: 'rbf --kernel cubic'")
p.add_argument("--tools", nargs="*", default=holes_tools.NAMES); p.add_argument("--work", default=os.path.join(tempfile.gettempdir(), "meshmend-holes"))
p.add_argument("--models", nargs="*"); p.add_argument("--again", action="store_true", help="forget earlier results of the tools and methods of this run"); p.add_argument("--page", action="store_true", help="only print what is kept")


def prepared(judge):
    """Cuts the holes that are not there yet; (model, hole, file) with the models and the sizes in turn, so that a part of a run says something about all."""
    done = os.path.join(o.work, "holes/complete-corpus" if o.corpus else "holes/complete")
    if not os.path.exists(done):
        os.makedirs(os.path.join(o.work, "holes"), exist_ok=True)
        models = holes_models.generated()
        if o.corpus: models.update({"corpus_" + name: m for name, m in holes_models.from_folder(o.corpus, o.corpus_models).items()})
        for name, (v, f) in models.items():
            if judge and any(judge(v, f)): print(f"left out, it meets itself: {name}", file=sys.stderr); continue
            if glob.glob(os.path.join(o.work, f"holes/{name}--*.npz")): continue
            holes = holes_cut.holes_of(v, f, zlib.crc32(name.encode()))
            for hole in holes: np.savez(os.path.join(o.work, f"holes/{name}--{hole['id']}.npz"), truth=holes_measure.rim_of_truth(hole), of=len(f), **hole)
            print(name, len(f), len(holes), file=sys.stderr, flush=True)
        open(done, "w").close()
    rows = [(*os.path.basename(path)[:-4].split("--"), path) for path in glob.glob(os.path.join(o.work, "holes/*.npz"))]
    return sorted((r for r in rows if not o.models or r[0] in o.models), key=lambda r: (r[1].startswith("cut"), 7 * int(r[1].split("-")[1]) % 20, r[0]))


def loaded(path):
    with np.load(path) as file: return {k: file[k] if file[k].ndim else file[k].item() for k in file.files}


def by_us(method, v, f):
    """Our program on a file, as anybody would call it."""
    with tempfile.TemporaryDirectory() as d:
        holes_tools.write_off(d + "/in.off", v, f)
        name, *more = method.split()
        start = time.perf_counter()
        try: run = subprocess.run([o.binary, "fill-holes", d + "/in.off", "-o", d + "/out.off", "--method", name, *more, "--json"], capture_output=True, text=True, timeout=120)
        except subprocess.TimeoutExpired: return "longer than 120 s"
        seconds = time.perf_counter() - start
        if not os.path.exists(d + "/out.off"): return (run.stderr.strip() or f"exit {run.returncode}")[:200]
        return *holes_tools.read_off(d + "/out.off"), seconds


def main():
    kept = os.path.join(o.work, "results.jsonl")
    judge = holes_measure.outside_judge(o.judge) if o.judge else None
    methods = ["ours " + m for m in o.ours] if os.path.exists(o.binary) else []
    workers = {name: holes_tools.Worker(name) for name in o.tools}
    holes = prepared(judge)
    results = holes_page.read(kept)
    if o.again: results = {k: r for k, r in results.items() if k[2] not in {*methods, *workers}}; holes_page.write(kept, results)
    todo = [] if o.page else [(m, h, path, t) for m, h, path in holes for t in (*methods, *workers) if (m, h, t) not in results]
    absent, last, start = set(), None, time.time()
    with open(kept, "a") as out:
        for n, (model, name, path, who) in enumerate(todo):
            if who in absent: continue
            if last != path: hole, last = loaded(path), path
            filled = by_us(who[5:], hole["V"], hole["F"]) if who in methods else workers[who].fill(hole["V"], hole["F"])
            if isinstance(filled, str) and filled.startswith("absent"): absent.add(who); print(f"{who} is {filled}", file=sys.stderr); continue
            row = {"failed": filled} if isinstance(filled, str) else dict(holes_measure.measure(hole, *filled[:2], judge), seconds=filled[2])
            row.update(model=model, hole=name, tool=who, **{k: hole[k] for k in ("kind", "size", "shape", "corners", "removed", "of", "truth")})
            results[model, name, who] = row
            print(json.dumps(row), file=out, flush=True)
            if n % 200 == 0: print(f"{n} of {len(todo)}, {time.time() - start:.0f} s", file=sys.stderr, flush=True)
    for w in workers.values(): w.stop()
    commit = subprocess.run(["git", "log", "-1", "--format=%h", "--", "src"], cwd=root, capture_output=True, text=True).stdout.strip()
    holes_page.show(results, {(m, h) for m, h, _ in holes}, commit)


if __name__ == "__main__":
    o = p.parse_args()
    main()
