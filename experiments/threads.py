#!/usr/bin/env python3
"""What a second thread brings to each stage of a command on a file; prints Markdown.

usage: threads.py [--binary PATH] [--runs 3] [--least 0.1] COMMAND ...    each as one word, such as "repair part.stl" or "simplify scan.stl --ratio 0.1"

Each command runs with one thread, with two threads, and as two copies of the run with one thread at the same time, in turn: what the copies lose is lost
to the machine. A stage is one of `timing_ms` in the report; those that take less than the share `--least` of the run with one thread are left out.
"""
import argparse, json, os, shlex, statistics, subprocess, sys, tempfile

from campaign_server import default_binary

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--runs", type=int, default=3)
p.add_argument("--least", type=float, default=0.1)
p.add_argument("commands", nargs="+", metavar="COMMAND")
o = p.parse_args()


def milliseconds(command, threads, copies):
    """For each stage, the milliseconds of one run, or the mean of copies that run at the same time; and the bytes of the output."""
    operation, *rest = shlex.split(command)
    with tempfile.TemporaryDirectory() as folder:
        outputs = [os.path.join(folder, f"{i}.stl") for i in range(copies)]
        words = [o.binary, operation, "--json", "--engine-threads", str(threads), *rest]
        writes = operation not in ("analyze", "verify")
        runs = [subprocess.Popen(words + (["-o", output] if writes else []), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) for output in outputs]
        reports = [json.loads(run.communicate()[0]) for run in runs]
        made = open(outputs[0], "rb").read() if writes else b""
    stages = {name for report in reports for name, value in report["timing_ms"].items() if value}
    return {name: statistics.mean(report["timing_ms"][name] for report in reports) for name in stages}, made


print("| command | stage | one thread, s | two threads, s | gain of two threads | gain of two copies | share |\n|---|---|---:|---:|---:|---:|---:|")
for command in o.commands:
    ways = {"one": (1, 1), "two": (2, 1), "copies": (1, 2)}
    runs = {way: [] for way in ways}
    outputs = set()
    for _ in range(o.runs):
        for way, (threads, copies) in ways.items():
            stages, made = milliseconds(command, threads, copies)
            runs[way].append(stages)
            outputs.add(made)
    if len(outputs) > 1:
        sys.exit(f"{command}: the bytes depend on the number of threads")
    median = {way: {name: statistics.median(run.get(name, 0.0) for run in runs[way]) for name in runs[way][0]} for way in ways}
    shown = " ".join(os.path.basename(word) for word in shlex.split(command))
    for name, one in sorted(median["one"].items(), key=lambda stage: (stage[0] == "total", -stage[1])):
        if one < o.least * median["one"]["total"]:
            continue
        gain, control = one / median["two"][name], 2 * one / median["copies"][name]
        print(f"| `{shown}` | {name} | {one / 1000:.2f} | {median['two'][name] / 1000:.2f} | {gain:.2f} | {control:.2f} | {gain / control:.2f} |", flush=True)
