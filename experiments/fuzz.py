#!/usr/bin/env python3
"""Runs the fuzz targets one after the other, each for some time, and prints Markdown: the lines of earlier parts from docs/campaigns/fuzz.md, then those of this part. Ends with 1 when an input was found that crashes a target, hangs it or takes too much memory; such inputs are kept in fuzz/artifacts.

usage: fuzz.py [--seconds 450] [--targets NAME ...] [--built FOLDER] [--hang-seconds 60]

Needs cargo-fuzz and a nightly toolchain, or with --built the folder of built targets. Inputs that reach new code are kept in fuzz/corpus from part to part.
"""
import argparse, glob, os, re, resource, shutil, subprocess, sys, time

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--seconds", type=int, default=450, help="for each target")
p.add_argument("--targets", nargs="*", default=sorted(os.path.basename(f)[:-3] for f in glob.glob(os.path.join(root, "fuzz/fuzz_targets/*.rs"))))
p.add_argument("--built", help="folder with the built targets")
p.add_argument("--hang-seconds", type=int, default=60, help="processor time of an input that is a hang; targets with a sanitizer and debug assertions take twenty times as long as the program")
o = p.parse_args()

# An input has at most 4 kB.
HANG_SECONDS = o.hang_seconds
LARGEST = 4096
MEMORY_MIB = 2048
SEEDS = {"read_obj": ["obj"], "read_stl": ["stl"], "read_off": ["off"], "read_ply": ["ply"], "read_gltf": ["glb", "gltf"], "read_3mf": ["3mf"]}
PAGE = os.path.join(root, "docs/campaigns/fuzz.md")


def git(*words):
    return subprocess.run(["git", *words], cwd=root, capture_output=True, text=True).stdout.strip()


def folder_of(kind, target):
    path = os.path.join(root, "fuzz", kind, target)
    os.makedirs(path, exist_ok=True)
    return path


def used():
    """Processor time of the children that have ended, in seconds."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def is_slow(binary, path):
    """libFuzzer looks at the clock, which runs on while others have the processor: the input once more, by processor time."""
    before = used()
    subprocess.run([binary, path, f"-timeout={100 * HANG_SECONDS}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return used() - before > HANG_SECONDS


def run(binary, target, part):
    """Processor time in seconds, number of executions, peak in MiB, and the inputs that failed, or how the target ended without one."""
    corpus, failed = folder_of("corpus", target), folder_of("artifacts", target)
    for ending in SEEDS.get(target, []):
        for seed in glob.glob(os.path.join(root, f"fixtures/**/*.{ending}"), recursive=True):
            if os.path.getsize(seed) <= LARGEST:
                shutil.copy(seed, corpus)
    before, end = used(), time.monotonic() + o.seconds
    executions, peak, inputs = 0, 0, set()
    # A run ends with the first input that fails.
    for turn in range(1000):
        left = int(end - time.monotonic())
        if left <= 0:
            break
        limits = [f"-max_total_time={left}", f"-timeout={HANG_SECONDS}", f"-report_slow_units={HANG_SECONDS}", f"-rss_limit_mb={MEMORY_MIB}", f"-max_len={LARGEST}", f"-seed={1000 * part + turn}"]
        ended = subprocess.run([binary, corpus, *limits, "-print_final_stats=1", f"-artifact_prefix={failed}/"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
        stat = lambda name: int((re.findall(rf"stat::{name}:\s+(\d+)", ended.stderr) or ["0"])[-1])
        executions, peak = executions + stat("number_of_executed_units"), max(peak, stat("peak_rss_mb"))
        # One that failed in an earlier part fails again, under the same name.
        inputs = set(re.findall(r"Test unit written to (\S+)", ended.stderr))
        if not ended.returncode:
            break
        if not inputs:
            return used() - before, executions, peak, [f"ended with {ended.returncode}"]
        for path in inputs:
            if not os.path.basename(path).startswith(("timeout-", "slow-unit-")) or is_slow(binary, path):
                return used() - before, executions, peak, sorted(map(os.path.basename, inputs))
            # It is no hang, and would not be one in the next run.
            os.remove(path)
    return used() - before, executions, peak, []


earlier = [line for line in open(PAGE) if re.match(r"\| \d", line)] if os.path.exists(PAGE) else []
part = 1 + max([int(line.split("|")[1]) for line in earlier], default=0)
commit = git("rev-parse", "--short", "HEAD") + (" with local changes" if git("status", "--porcelain", "src", "fuzz") else "")
if not o.built:
    build = ["cargo", "+nightly", "fuzz", "build", "--sanitizer", "none", "--features", "requests"]
    subprocess.run(build, cwd=root, check=True)
folder = o.built or os.path.join(root, "fuzz/target", subprocess.run(["rustc", "--print", "host-tuple"], capture_output=True, text=True, check=True).stdout.strip(), "release")
lines, failures = [], 0
for target in o.targets:
    seconds, executions, peak, failed = run(os.path.join(folder, target), target, part)
    failures += len(failed)
    kept = len(os.listdir(folder_of("corpus", target)))
    lines.append(f"| {part} | {commit} | `{target}` | {seconds / 3600:.2f} | {executions:,} | {kept:,} | {peak} | {', '.join(failed) or 'none'} |\n")
    print(lines[-1], end="", file=sys.stderr, flush=True)

lines = earlier + lines
hours = sum(float(line.split("|")[4]) for line in lines)
found = sum(line.split("|")[8].strip() != "none" for line in lines)
print(f"""# Fuzzing

Made by `scripts/campaign.sh fuzz`, in parts: {hours:.1f} hours of processor time altogether, {found} runs found an input that fails. What has to hold of any
bytes is in `fuzz/src/lib.rs`: readers end without a panic, within memory in proportion to the bytes, and what they read is the same after it was
written; a repair of any triangles is certified or refused within its bound of work; requests are refused or become options. An input that takes more than
{HANG_SECONDS} s of processor time is a hang. Inputs have up to {LARGEST:,} bytes and begin with those of `fixtures/`; what reaches new code is kept from part to part.

| part | commit | target | processor hours | executions | inputs kept | peak, MiB | inputs that fail |
|---:|---|---|---:|---:|---:|---:|---|
{''.join(lines)}""", end="")
sys.exit(1 if failures else 0)
