#!/usr/bin/env python3
"""Runs `analyze`, `verify` and `repair` on files that are small for the work they ask for (hostile_files.py), one after the other, each under limits of processor time and address space, and prints Markdown. Ends with 1 when a run is beyond the goal.

usage: hostile.py [--binary PATH] [--most BYTES] [--seconds 70] [--gib 4] [--only FAMILY ...] [--operations analyze verify repair] [--files FOLDER]

Needs nothing but the built binary and Python.
"""
import argparse, json, os, resource, subprocess, sys, tempfile
from hostile_files import cases, write

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.dirname(here)
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend"))
p.add_argument("--most", type=int, default=1 << 40, help="leave larger files out")
p.add_argument("--seconds", type=int, default=70, help="of processor time for a run on 4 MB; larger files get more in proportion")
p.add_argument("--gib", type=float, default=4, help="of address space for a run")
p.add_argument("--only", nargs="*", default=[])
p.add_argument("--operations", nargs="*", default=["analyze", "verify", "repair"])
p.add_argument("--files", help="keep the files there")
o = p.parse_args()

# The goal for files of up to 4 MB: seconds of processor time and MiB; larger ones in proportion.
SMALL = 4 << 20
SECONDS = {"analyze": 10, "verify": 10, "repair": 60}
MEMORY = 1024
# The file of a family that takes an option of its own.
OPTIONS = {"one_triangle": {"repair": ["--max-deviation-mm", "1e-9"]}}

# The child's peak begins with that of the process it was forked from, so a small one stands between.
LAUNCHER = """import os, resource, sys
seconds, space = int(sys.argv[2]), int(sys.argv[3])
resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5)); resource.setrlimit(resource.RLIMIT_AS, (space, space)); resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
child = os.posix_spawn(sys.argv[4], sys.argv[4:], os.environ)
_, status, used = os.wait4(child, 0)
open(sys.argv[1], 'w').write(f'{os.waitstatus_to_exitcode(status)} {used.ru_utime + used.ru_stime} {used.ru_maxrss}')"""


def run(operation, path, options, seconds):
    """Exit code (negative: the signal), seconds of processor time, peak in MiB, what was printed."""
    with tempfile.TemporaryDirectory() as folder:
        told, command = os.path.join(folder, "told"), [o.binary, operation, path, "--json", *options]
        if operation == "repair":
            command += ["-o", os.path.join(folder, "result" + os.path.splitext(path)[1])]
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            launch = [sys.executable, "-I", "-S", "-c", LAUNCHER, told, str(seconds), str(int(o.gib * (1 << 30))), *command]
            subprocess.run(launch, stdout=out, stderr=err)
            out.seek(0), err.seek(0)
            printed = out.read() or err.read()
        code, used, peak = open(told).read().split()
        return int(code), float(used), int(peak) >> 10, printed


def outcome_of(code, printed):
    """A word or two for the table."""
    if code < 0:
        return {-24: "**out of processor time**", -9: "**out of processor time**", -6: "**aborted**"}.get(code, f"**signal {-code}**")
    try:
        report = json.loads(printed)
    except ValueError:
        return f"**exit {code}**: {printed[:60].decode(errors='replace').strip()}"
    if report.get("code"):
        return report["code"] + (f" ({report['limit_name']})" if report.get("limit_name") else "")
    verdict = report["verdict"]
    if verdict["outcome"] == "refused":
        return f"refused: {verdict['reasons'][0]['code']}"
    if verdict["outcome"]:
        return verdict["outcome"]
    return "printable" if verdict["printable"] else "not printable"


rows, beyond = [], 0
with tempfile.TemporaryDirectory() as scratch:
    folder = o.files or scratch
    os.makedirs(folder, exist_ok=True)
    for make, size in cases(families=o.only):
        path = write(folder, make, size)
        length = os.path.getsize(path)
        share = max(1, length / SMALL)
        if length > o.most:
            continue
        for operation in o.operations:
            options = OPTIONS.get(make.__name__, {}).get(operation, [])
            code, used, peak, printed = run(operation, path, options, int(o.seconds * share))
            outcome = outcome_of(code, printed)
            is_beyond = used > SECONDS[operation] * share or peak > MEMORY * share or "**" in outcome
            beyond += is_beyond
            rows.append((make.__name__.replace("_", " "), size, length, operation, used, peak, outcome, "beyond" if is_beyond else ""))
            print(*rows[-1], sep="\t", file=sys.stderr, flush=True)
        if not o.files:
            os.remove(path)

commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
if subprocess.run(["git", "status", "--porcelain"], cwd=root, capture_output=True).stdout.strip():
    commit += " with local changes"
print(f"""# Files that are small for the work they ask for

Made by `scripts/campaign.sh hostile` at commit {commit} on {os.cpu_count()} cores. `experiments/hostile_files.py` makes the files, the same ones
each time. The goal: up to 4 MB, `repair` ends certified or with a typed refusal within {SECONDS["repair"]} s of processor time, `analyze` and `verify`
within {SECONDS["verify"]} s, each within {MEMORY} MiB; larger files in proportion. What bounds what is in [bounds.md](../bounds.md).

{len(rows)} runs, **{beyond} beyond the goal**.

| family | size | bytes | operation | processor time, s | peak, MiB | outcome | |
|---|---:|---:|---|---:|---:|---|---|""")
for family, size, length, operation, used, peak, outcome, mark in rows:
    print(f"| {family} | {size:,} | {length:,} | {operation} | {used:.2f} | {peak:,} | {outcome} | {mark} |")
sys.exit(1 if beyond else 0)
