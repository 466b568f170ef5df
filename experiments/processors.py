#!/usr/bin/env python3
"""The program for x86-64 and the one for 64-bit ARM on the same files: digests of results and of reports; prints Markdown.

usage: processors.py [--binary PATH] [--other PATH] [--emulator "qemu-aarch64-static -L /usr/aarch64-linux-gnu"] [--files 200] [--bytes 300000] [--seed 1]
Every fixture, and of the corpus in `shared` (or MESHMEND_SHARED) `--files` files of at most `--bytes`, drawn with the seed, are repaired and
analysed by both programs. Without `--other` the program for ARM is built, which needs gcc-aarch64-linux-gnu, libc6-dev-arm64-cross and
qemu-user-static (Debian), and the target aarch64-unknown-linux-gnu of the toolchain.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import random
import shlex
import subprocess
import sys
import tempfile
import time

from campaign_server import commit, default_binary, root

shared = os.environ.get("MESHMEND_SHARED", os.path.join(root, "../shared"))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--other")
p.add_argument("--emulator", default="qemu-aarch64-static -L /usr/aarch64-linux-gnu")
p.add_argument("--files", type=int, default=200)
p.add_argument("--bytes", type=int, default=300_000)
p.add_argument("--seed", type=int, default=1)
p.add_argument("--seconds", type=float, default=1200, help="most for one run")
o = p.parse_args()
MESHES = (".stl", ".obj", ".off", ".ply", ".glb", ".gltf", ".3mf")
begun = time.time()


def built():
    """The program for ARM: optimised as the one for releases, but for what passes from one part of the program to another."""
    into, target = os.path.join(root, "target/processors"), "aarch64-unknown-linux-gnu"
    tools = {"CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER": "aarch64-linux-gnu-gcc", "CC_aarch64_unknown_linux_gnu": "aarch64-linux-gnu-gcc",
             "AR_aarch64_unknown_linux_gnu": "aarch64-linux-gnu-ar", "CARGO_PROFILE_RELEASE_LTO": "false", "CARGO_PROFILE_RELEASE_CODEGEN_UNITS": "16"}
    subprocess.run(["cargo", "build", "--release", "--locked", "-q", "--bin", "meshmend", "--target", target, "--target-dir", into], cwd=root,
                   env={**os.environ, **tools}, check=True)
    return f"{into}/{target}/release/meshmend"


def without_times(report):
    """The same report without what a clock says."""
    if isinstance(report, dict):
        return {key: without_times(value) for key, value in report.items() if key != "timing_ms"}
    return [without_times(value) for value in report] if isinstance(report, list) else report


def digest(content):
    return hashlib.sha256(content).hexdigest()[:16]


def ran(program, path):
    """What a program makes of a file: by name, a digest or a word."""
    told = {}
    with tempfile.TemporaryDirectory() as folder:
        made = os.path.join(folder, "made" + os.path.splitext(path)[1].lower())
        for command, more in (("repair", ["-o", made]), ("analyze", [])):
            try:
                done = subprocess.run([*program, command, path, "--json", *more], capture_output=True, timeout=o.seconds)
            except subprocess.TimeoutExpired:
                told[f"report of {command}"] = "time"
                continue
            told[f"exit code of {command}"] = done.returncode
            try:
                report = without_times(json.loads(done.stdout))
                told[f"report of {command}"] = digest(json.dumps(report).encode())
            except ValueError:
                told[f"report of {command}"] = "none: " + digest(done.stdout + done.stderr)
        told["result"] = digest(open(made, "rb").read()) if os.path.exists(made) else "none"
    return told


def both(path):
    return ran([o.binary], path), ran([*shlex.split(o.emulator), other], path)


def meshes(folder):
    return sorted(os.path.join(base, name) for base, _, names in os.walk(folder) for name in names if name.lower().endswith(MESHES))


if not os.path.isdir(os.path.join(shared, "corpus")):
    sys.exit("the corpus is not here; set MESHMEND_SHARED")
other = o.other or built()
small = [path for path in meshes(os.path.join(shared, "corpus")) if os.path.getsize(path) <= o.bytes]
if len(small) < o.files:
    sys.exit(f"the corpus has only {len(small)} files of at most {o.bytes} bytes")
groups = {"fixtures": meshes(os.path.join(root, "fixtures")), "corpus": sorted(random.Random(o.seed).sample(small, o.files))}
counts, differing = collections.defaultdict(collections.Counter), []
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    # Small files first.
    order = sorted(((group, path) for group, paths in groups.items() for path in paths), key=lambda one: os.path.getsize(one[1]))
    runs = {pool.submit(both, path): (group, path) for group, path in order}
    for run in concurrent.futures.as_completed(runs):
        (group, path), (here, there) = runs[run], run.result()
        differ = [what for what in here if here[what] != there.get(what)]
        count = counts[group]
        count["files"] += 1
        count["equal"] += not differ
        count["results"] += here["result"] != "none"
        count["no result from either"] += here["result"] == there["result"] == "none"
        count["over time"] += "time" in [*here.values(), *there.values()]
        if differ:
            differing.append((os.path.relpath(path, root if group == "fixtures" else shared), ", ".join(differ)))
        print(f"{group} {count['files']}/{len(groups[group])} {os.path.basename(path)} {differ or 'equal'}", file=sys.stderr, flush=True)

differing.sort()
rows = "\n".join(f"| {group}: {what} | {count[what]} |" for group, count in sorted(counts.items())
                 for what in ("files", "equal", "results", "no result from either", "over time"))
named = "\n".join(f"| `{path}` | {what} |" for path, what in differing)
size = os.path.getsize
print(f"""# Campaign `processors`

Made by `experiments/processors.py` at commit {commit()} with seed {o.seed} in {time.time() - begun:.0f} s on {os.cpu_count()} cores: each file is repaired and
analysed by the program for x86-64 and by the one for 64-bit ARM, which an emulator runs (`{shlex.split(o.emulator)[0]}`). Compared are exit codes, the bytes
of the result, and both reports without their `timing_ms`. The files are all {len(groups["fixtures"])} fixtures ({sum(map(size, groups["fixtures"])):,} bytes), and of the corpus {o.files} files
drawn from the {len(small)} of at most {o.bytes:,} bytes ({sum(map(size, groups["corpus"])):,} bytes).

| what | number |
| --- | --- |
{rows}
| files on which the two differ in anything | {len(differing)} |
""")
if differing:
    print(f"| file | what differs |\n| --- | --- |\n{named}")
sys.exit(bool(differing))
