#!/usr/bin/env python3
"""Bodies of one file that pass through each other, united by Meshmend, by manifold-rust and by CGAL's autorefinement with iterative snap rounding, alternating in one run. Prints Markdown.

usage: union_speed.py --manifold-rust PATH --autorefine PATH [--binary PATH] [--judge PATH] [--scan FILE.stl] [--rounds 5]

manifold-rust's program is `manifold_rust` of the peers' scripts; CGAL's is `autorefine.cpp` beside this script, which needs CGAL 6.1 or later.
CGAL's only divides and rounds triangles, and leaves what lies inside. Needs numpy.
"""
import argparse, json, os, re, statistics, subprocess, sys, tempfile, time
import numpy as np

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=os.path.join(root, "target/release/meshmend"))
p.add_argument("--manifold-rust", required=True)
p.add_argument("--autorefine", required=True)
p.add_argument("--judge", help="looks at the results of Meshmend and manifold-rust")
p.add_argument("--scan", help="one more file, a binary STL")
p.add_argument("--rounds", type=int, default=5)
o = p.parse_args()
SECONDS = 300


def sphere(edge, center):
    """An octahedron whose edges are divided into `edge` parts, drawn out to a unit sphere: `8 * edge**2` triangles."""
    steps, triangles = [(i, j) for i in range(edge) for j in range(edge - i)], []
    for signs in np.ndindex(2, 2, 2):
        sign = 1 - 2 * np.array(signs)
        at = lambda i, j: sign * (i, j, edge - i - j)
        face = [(at(i, j), at(i + 1, j), at(i, j + 1)) for i, j in steps]
        face += [(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i, j in steps if i + j < edge - 1]
        triangles += face if sign.prod() > 0 else [triangle[::-1] for triangle in face]
    corners = np.array(triangles, float)
    return corners / np.linalg.norm(corners, axis=2, keepdims=True) + center


def beam(length, width, parts):
    """A square beam along x in the middle of the origin, its sides divided into `parts` along its length: `8 * parts + 4` triangles."""
    ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    at = lambda x, k: (length * (x / parts - 0.5), width / 2 * ring[k % 4][0], width / 2 * ring[k % 4][1])
    sides = [t for x in range(parts) for k in range(4) for t in ((at(x, k), at(x + 1, k), at(x + 1, k + 1)), (at(x, k), at(x + 1, k + 1), at(x, k + 1)))]
    ends = [(at(0, 0), at(0, k), at(0, k + 1)) for k in (1, 2)] + [(at(parts, 0), at(parts, k + 1), at(parts, k)) for k in (1, 2)]
    return np.array([tuple(reversed(t)) for t in sides] + [tuple(reversed(t)) for t in ends], float)


def beams(count, parts):
    """`count` beams in either direction, in one plane, turned as a whole so that no face lies along an axis."""
    one, quarter = beam(count, 0.4, parts), np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1.0]])
    places = np.arange(count) - (count - 1) / 2
    all = [one + (0, y, 0) for y in places] + [one @ quarter + (x, 0, 0.11) for x in places]
    turn, _ = np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))
    return np.concatenate(all) @ (turn * np.linalg.det(turn))


def write_stl(path, corners):
    record = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    record["corners"] = corners
    open(path, "wb").write(b"\0" * 80 + np.uint32(len(corners)).tobytes() + record.tobytes())


def write_msh(path, stl):
    """The same triangles with shared vertices, as manifold-rust's program reads them."""
    record = np.frombuffer(open(stl, "rb").read(), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")], offset=84)
    vertices, index = np.unique(record["corners"].reshape(-1, 3), axis=0, return_inverse=True)
    open(path, "wb").write(b"MSH1" + np.array([len(vertices), len(record)], "<i8").tobytes() + vertices.astype("<f8").tobytes() + index.astype("<i4").tobytes())


def run(*words):
    """Standard output, seconds, and peak of memory in MiB, of a process; no output where it fails."""
    peak = 0
    with tempfile.NamedTemporaryFile("r") as out:
        begin = time.monotonic()
        process = subprocess.Popen(words, stdout=open(out.name, "w"), stderr=subprocess.DEVNULL)
        while process.poll() is None:
            # What the system counts for a child begins with the memory of this process.
            found = re.search(r"VmHWM:\s+(\d+)", open(f"/proc/{process.pid}/status").read())
            peak = max(peak, int(found[1]) if found else 0)
            if time.monotonic() - begin > SECONDS:
                process.kill()
            time.sleep(0.001)
        return (out.read() if process.returncode == 0 else None), time.monotonic() - begin, peak / 1024


def judged(path):
    if not o.judge:
        return ""
    found = json.loads(subprocess.run([o.judge, path, "--only"], capture_output=True, text=True).stdout)
    return "yes" if found.get("printable") and found.get("stl_printable") else "no"


print(f"""# Uniting beside other programs

Bodies of one file that pass through each other. Meshmend reads, repairs, certifies and writes; its *pass* is the time of the stage `repair`
of its report. manifold-rust's program reads, orients, unites by winding number and writes. CGAL's reads, divides and rounds by iterative snap
rounding, and leaves what lies inside; its pass leaves reading out. Medians of {o.rounds} alternating runs on {os.cpu_count()} cores; peak is of the whole process. Made by `experiments/union_speed.py`
at commit {subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()}.

| file | triangles | program | pass, s | whole process, s | peak, MiB | triangles of the result | printable by the judge |
|---|---:|---|---:|---:|---:|---:|---|""")
with tempfile.TemporaryDirectory() as folder:
    in_folder = lambda name: os.path.join(folder, name)
    files = []
    for name, corners in [
        ("two spheres", np.concatenate([sphere(64, 0), sphere(64, (0.31, 0.17, 0.23))])),
        ("eight spheres", np.concatenate([sphere(32, 0.37 * np.array(place)) for place in np.random.default_rng(7).normal(size=(8, 3))])),
        ("100 x 100 turned beams, sides in 4 parts", beams(100, 4)),
        ("180 x 180 turned beams, sides in 12 parts", beams(180, 12)),
    ]:
        files.append((name, in_folder(f"{len(files)}.stl")))
        write_stl(files[-1][1], corners)
    if o.scan:
        files.append((os.path.basename(o.scan), o.scan))
    for name, stl in files:
        write_msh(in_folder("in.msh"), stl)
        mine, manifold, cgal = [], [], []
        for _ in range(o.rounds):
            mine.append(run(o.binary, "repair", stl, "-o", in_folder("out.stl"), "--json"))
            manifold.append(run(o.manifold_rust, in_folder("in.msh"), in_folder("out.msh")))
            cgal.append(run(o.autorefine, stl))
        median = lambda runs, which: f"{statistics.median(r[which] for r in runs):.3f}"
        peak = lambda runs: f"{max(r[2] for r in runs):.0f}"
        row = lambda *cells: print("| " + " | ".join(cells) + " |", flush=True)
        triangles = f"{(os.path.getsize(stl) - 84) // 50:,}"
        reports = [json.loads(r[0]) for r in mine if r[0]]
        told = reports[0]["verdict"]["outcome"] if reports else "no report"
        passes = f"{statistics.median(r['timing_ms']['repair'] for r in reports) / 1000:.3f}" if reports else ""
        count = f"{reports[0]['after']['counts']['triangles']:,}" if reports and reports[0].get("after") else told
        row(name, triangles, f"Meshmend ({told})", passes, median(mine, 1), peak(mine), count, judged(in_folder("out.stl")))
        if manifold[0][0] is None:
            row(name, triangles, "manifold-rust", "", f"refused after {median(manifold, 1)}", peak(manifold), "", "")
        else:
            count = int.from_bytes(open(in_folder("out.msh"), "rb").read(20)[12:], "little")
            row(name, triangles, "manifold-rust", "", median(manifold, 1), peak(manifold), f"{count:,}", judged(in_folder("out.msh")))
        results = [json.loads(r[0]) for r in cgal if r[0]]
        if results:
            passes = f"{statistics.median(r['seconds'] for r in results):.3f}"
            row(name, triangles, "CGAL" if results[0]["done"] else "CGAL (gave up rounding)", passes, median(cgal, 1), peak(cgal), f"{results[0]['triangles']:,}", "")
        else:
            row(name, triangles, "CGAL", "", f"ended without a result after {median(cgal, 1)}", peak(cgal), "", "")
