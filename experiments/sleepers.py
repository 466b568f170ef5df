#!/usr/bin/env python3
"""Jobs that only sleep: how many a second servers on one database run, and what callers cost who wait; prints Markdown.

usage: sleepers.py [--binary PATH] [--s3 PATH] [--sleeper PATH] [--workers 1 2 4 8 16 32 64] [--sleep 4] [--waiters 10000]
The parts are those of docs/stores.md: one server that takes requests, workers with one slot each, PostgreSQL and an S3 server. The workers
are `examples/sleeper.rs`, the service with an engine that sleeps.
"""
import argparse
import asyncio
import http.client
import json
import os
import sys
import time

from campaign_server import allow_many_files, commit, default_binary
from shared_stores import Town, default_s3, target

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--s3", default=default_s3)
p.add_argument("--sleeper", default=os.path.join(target, "release/examples/sleeper"))
p.add_argument("--workers", type=int, nargs="*", default=[1, 2, 4, 8, 16, 32, 64])
p.add_argument("--sleep", type=float, default=4)
p.add_argument("--each", type=int, default=4, help="jobs for each worker")
p.add_argument("--waiters", type=int, default=10_000)
o = p.parse_args()
allow_many_files()
number = 0


def post(server, sleep):
    """Sends a job. Its id."""
    global number
    number += 1
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    connection.request("POST", "/v1/jobs?operation=repair", f"sleep {sleep * 1000:.0f} {number}\n")
    response = connection.getresponse()
    content = response.read()
    assert response.status == 202, content
    return json.loads(content)["id"]


def processor_seconds(pids):
    """User and system time of processes so far."""
    total = 0
    for pid in pids:
        try:
            fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
            total += sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
        except OSError:
            pass
    return total


def throughput(count):
    """Jobs a second of so many workers, and the share of the machine's processors that was in use."""
    with Town(o.binary, o.s3, max_connections=500) as town:
        api = town.server("api", "--queue-max", "100000", "--interactive-slots", "0")
        town.binary = o.sleeper
        town.shared[town.shared.index("--database-connections-max") + 1] = "2"
        workers = [town.server("worker", "--slots", "1", "--interactive-slots", "0") for _ in range(count)]
        jobs = [post(api, o.sleep) for _ in range(o.each * count)]
        busy = [int(field) for field in open("/proc/stat").readline().split()[1:9]]
        until = time.time() + o.sleep * o.each * 4 + 120
        while town.database.ask("SELECT count(*) FROM jobs WHERE state IN ('queued', 'running')") != [["0"]] and time.time() < until:
            time.sleep(0.5)
        then, busy = busy, [int(field) for field in open("/proc/stat").readline().split()[1:9]]
        idle = sum(busy[i] - then[i] for i in (3, 4)) / max(1, sum(busy) - sum(then))
        row = town.database.ask("SELECT count(*), max(finished_at) - min(started_at) FROM jobs WHERE finished_at IS NOT NULL")[0]
        assert int(row[0]) == len(jobs), row
        for server in [api, *workers]:
            server.__exit__()
        return len(jobs), int(row[1]) / 1e3, 1 - idle


async def waiter(port, path, gate, answers):
    """Waits for one job by a connection of its own; notes when the answer came and what it was."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n".encode())
    await writer.drain()
    gate.append(1)
    answer = await reader.read()
    answers.append((time.time(), answer.split(b" ", 2)[1], b'"state":"failed"' in answer.replace(b" ", b"")))
    writer.close()


def facts(server):
    """Threads, resident bytes and processor seconds of a server."""
    lines = dict(line.split(":", 1) for line in open(f"/proc/{server.process.pid}/status").read().splitlines())
    return int(lines["Threads"]), int(lines["VmRSS"].split()[0]) * 1024, processor_seconds([server.process.pid])


async def waiting(town, api):
    """What so many waiters cost, and how soon all are answered."""
    jobs = [post(api, 0.001) for _ in range(100)]
    before, gate, answers, tasks = facts(api), [], [], []
    for i in range(o.waiters):
        tasks.append(asyncio.create_task(waiter(api.port, f"/v1/jobs/{jobs[i % len(jobs)]}?wait=300", gate, answers)))
        if i % 100 == 99:
            await asyncio.sleep(0.05)
    while len(gate) < o.waiters:
        await asyncio.sleep(0.1)
    await asyncio.sleep(3)
    then = facts(api)
    await asyncio.sleep(10)
    now = facts(api)
    early = len(answers)
    if early:
        print(f"answered before: {answers[:3]}", file=sys.stderr)
    town.binary = o.sleeper
    begun = time.time()
    worker = town.server("worker", "--slots", "4")
    await asyncio.gather(*tasks)
    took = max(at for at, _, _ in answers) - begun
    for server in (worker, api):
        server.__exit__()
    good = sum(1 for _, status, ended in answers if status == b"200" and ended)
    return before, now, (now[2] - then[2]) / 10, early, good, took


rows = []
for count in o.workers:
    jobs, seconds, busy = throughput(count)
    rate, ideal = jobs / seconds, count / o.sleep
    rows.append(f"| {count} | {jobs} | {seconds:.1f} | {rate:.2f} | {ideal:.2f} | {100 * rate / ideal:.0f} % | {100 * busy:.0f} % |")
with Town(o.binary, o.s3, max_connections=500) as town:
    most = str(o.waiters + 100)
    api = town.server("api", "--queue-max", "100000", "--interactive-slots", "0", "--connections-max", most, "--address-connections-max", most)
    before, now, share, early, good, took = asyncio.run(waiting(town, api))

print(f"""# Campaign `sleepers`

Made by `experiments/sleepers.py` at commit {commit()} on {os.cpu_count()} cores; the load of the machine was {os.getloadavg()[2]:.1f} on average of the last 15 minutes.
Jobs sleep in place of an engine, each in a process of its own as ever, so that all else of a job can be seen: one server that takes requests, workers of one slot
each, PostgreSQL and an S3 server.

## Workers on one database

Each job sleeps {o.sleep:g} s; {o.each} jobs for each worker wait before the measurement ends. Time is from the first start of a run to the last end, by the
database's clock; at best, {o.each} runs of {o.sleep:g} s follow each other without a pause.

| workers | jobs | seconds | jobs a second | at best | share of that | processors in use, all programs |
| --- | --- | --- | --- | --- | --- | --- |
{chr(10).join(rows)}

## Callers who wait

{o.waiters:,} connections wait for 100 queued jobs at one server; then a worker is started.

| | before | while {o.waiters:,} wait |
| --- | --- | --- |
| threads of the server | {before[0]} | {now[0]} |
| resident memory, MiB | {before[1] / 2**20:.0f} | {now[1] / 2**20:.0f} |
| share of one processor | | {100 * share:.1f} % |

Before the worker was started {early} were answered. {good:,} of {o.waiters:,} were told the end of their job, the last {took:.1f} s after the start of the worker.
""")
