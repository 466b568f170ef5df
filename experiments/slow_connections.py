#!/usr/bin/env python3
"""Silent, half-header and slow-body connections beside normal requests; prints Markdown.

usage: slow_connections.py [--binary PATH] [--connections 2000] [--timeout 5]
"""
import argparse
import asyncio
import time

from campaign_server import Server, allow_many_files, commit, default_binary, quantile

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--connections", type=int, default=2000)
p.add_argument("--timeout", type=int, default=5)
o = p.parse_args()

CUBE = b"OFF 8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"
HEAD = b"POST /v1/verify HTTP/1.1\r\nHost: localhost\r\n"
KINDS = {
    "silent": b"",
    "half a head": HEAD,
    "slow body": HEAD + b"Content-Length: 1000000\r\n\r\n",
}


async def hold(port, kind, closed, opened):
    """One bad connection, until the server closes it; slow bodies bring a byte each half second."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    begun = time.monotonic()
    opened.append(1)
    writer.write(KINDS[kind])

    async def drip():
        while True:
            await asyncio.sleep(0.5)
            writer.write(b"x")
            await writer.drain()

    task = asyncio.create_task(drip()) if kind == "slow body" else None
    try:
        answer = await asyncio.wait_for(reader.read(-1), 20 * o.timeout)
        closed[kind].append((time.monotonic() - begun, answer[9:12].decode()))
    except (ConnectionError, asyncio.TimeoutError) as error:
        closed[kind].append((time.monotonic() - begun, type(error).__name__))
    finally:
        if task:
            task.cancel()
        writer.close()


async def ask(port):
    """One normal request: its status and how long it took."""
    begun = time.monotonic()
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(HEAD + b"Connection: close\r\nContent-Length: %d\r\n\r\n" % len(CUBE) + CUBE)
    answer = await asyncio.wait_for(reader.read(-1), 60)
    writer.close()
    return answer[9:12].decode(), time.monotonic() - begun


async def campaign(server):
    alone = [await ask(server.port) for _ in range(50)]
    closed, opened, beside = {kind: [] for kind in KINDS}, [], []
    kinds = list(KINDS)
    held = [asyncio.create_task(hold(server.port, kinds[i % 3], closed, opened)) for i in range(o.connections)]
    while len(opened) < o.connections and not any(task.done() and task.exception() for task in held):
        await asyncio.sleep(0.01)
    while not all(task.done() for task in held):
        beside.append(await ask(server.port))
        await asyncio.sleep(0.02)
    await asyncio.gather(*held)
    return alone, beside, closed, len(opened)


allow_many_files()
limits = [f"--{name}={o.timeout}s" for name in ("header-timeout", "upload-timeout")]
with Server(o.binary, *limits) as server:
    alone, beside, closed, opened = asyncio.run(campaign(server))
print(f"# Slow connections\n\n{opened} bad connections at one time, a third of each kind, `header_timeout` and `upload_timeout` {o.timeout} s, a byte of a "
      f"slow body each half second.\nMade by `scripts/campaign.sh slow-connections` at commit {commit()}.\n")
print("| kind | connections | closed by the server | answered | first after | last after |\n|---|---|---|---|---|---|")
for kind, ends in closed.items():
    times = [seconds for seconds, _ in ends]
    answers = sorted({word or "nothing" for _, word in ends})
    print(f"| {kind} | {len(ends)} | {sum(1 for _, w in ends if w != 'TimeoutError')} | {', '.join(answers)} | {min(times):.1f} s | {max(times):.1f} s |")
print("\n| requests | number | other than 200 | p50 | p99 | longest |\n|---|---|---|---|---|---|")
for name, rows in (("alone", alone), ("beside the bad connections", beside)):
    times = [seconds * 1e3 for _, seconds in rows]
    print(f"| {name} | {len(rows)} | {sum(1 for status, _ in rows if status != '200')} | {quantile(times, .5):.0f} ms | {quantile(times, .99):.0f} ms | {max(times):.0f} ms |")
on_time = all(word != "TimeoutError" and seconds < 3 * o.timeout for ends in closed.values() for seconds, word in ends)
fine = on_time and opened == o.connections and all(status == "200" for status, _ in beside)
print(f"\nEvery bad connection is closed within three times the limit, and every normal request is answered: {'yes' if fine else 'NO'}.")
raise SystemExit(not fine)
