#!/usr/bin/env python3
"""Ten times the load that can be sustained: what is done, what is refused and how quickly; then small meshes beside huge ones; prints Markdown.

usage: overload.py [--binary PATH] [--seconds 60] [--factor 10] [--warm 15]
Every request has a mesh of its own, so that none is answered from an earlier one.
"""
import argparse
import asyncio
import math
import time

from campaign_server import Server, allow_many_files, commit, default_binary, quantile

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--seconds", type=int, default=60)
p.add_argument("--factor", type=float, default=10)
p.add_argument("--warm", type=int, default=15)
o = p.parse_args()
counter = iter(range(1 << 40))


def sphere(rings, scale):
    """A closed surface of about 2 * rings^2 triangles, as OFF."""
    n = 2 * rings
    v = [(0, 0, 1)] + [(math.sin(math.pi * i / rings) * math.cos(math.pi * 2 * j / n), math.sin(math.pi * i / rings) * math.sin(math.pi * 2 * j / n), math.cos(math.pi * i / rings))
                       for i in range(1, rings) for j in range(n)] + [(0, 0, -1)]
    at = lambda i, j: 1 + (i - 1) * n + j % n
    f = [(0, at(1, j), at(1, j + 1)) for j in range(n)] + [(len(v) - 1, at(rings - 1, j + 1), at(rings - 1, j)) for j in range(n)]
    f += [t for i in range(1, rings - 1) for j in range(n) for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1)))]
    lines = [f"OFF {len(v)} {len(f)} 0"] + ["%.7f %.7f %.7f" % tuple(scale * x for x in p) for p in v] + ["3 %d %d %d" % t for t in f]
    return "\n".join(lines).encode()


SMALL, HUGE = sphere(24, 10), sphere(260, 50)


def body_of(mesh):
    """The mesh with a comment of its own, so that no other request has the same bytes."""
    return mesh + b"\n# %d\n" % next(counter)


class Line:
    """A connection that is kept."""

    def __init__(self, port):
        self.port, self.writer = port, None

    async def ask(self, method, path, body=b"", more=b""):
        """Status, headers and seconds of one request."""
        begun = time.monotonic()
        if self.writer is None:
            self.reader, self.writer = await asyncio.open_connection("127.0.0.1", self.port)
        try:
            self.writer.write(b"%s %s HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n%s\r\n" % (method, path, len(body), more) + body)
            head = (await self.reader.readuntil(b"\r\n\r\n")).decode().split("\r\n")
            headers = dict(line.lower().split(": ", 1) for line in head[1:] if line)
            await self.reader.readexactly(int(headers.get("content-length", 0)))
            if headers.get("connection") == "close":
                self.close()
            return int(head[0].split()[1]), headers, time.monotonic() - begun
        except (OSError, asyncio.IncompleteReadError):
            self.close()
            return 0, {}, time.monotonic() - begun

    def close(self):
        if self.writer:
            self.writer.close()
        self.writer = None


async def verify(line):
    return await line.ask(b"POST", b"/v1/verify", body_of(SMALL), b"Accept: application/json\r\n")


async def sustained(server, clients, seconds):
    """Requests a second of clients that ask again when they have been answered."""
    done, end = [], time.monotonic() + seconds

    async def client():
        line = Line(server.port)
        while time.monotonic() < end:
            answer = await verify(line)
            done.append(answer)
        line.close()

    await asyncio.gather(*(client() for _ in range(clients)))
    return sum(1 for status, *_ in done if status == 200) / seconds


async def overload(server, rate, seconds):
    """Requests at a fixed rate, whatever becomes of them."""
    idle, done, ready = [], [], []
    end = time.monotonic() + seconds

    async def one():
        line = idle.pop() if idle else Line(server.port)
        done.append(await verify(line))
        idle.append(line)

    async def probe():
        line = Line(server.admin_port)
        while time.monotonic() < end:
            ready.append(await line.ask(b"GET", b"/readyz"))
            await asyncio.sleep(0.1)
        line.close()

    probing = asyncio.create_task(probe())
    begun, tasks, number = time.monotonic(), set(), 0
    while time.monotonic() < end:
        due = int((time.monotonic() - begun) * rate)
        while number < due:
            task = asyncio.create_task(one())
            tasks.add(task)
            task.add_done_callback(tasks.discard)
            number += 1
        await asyncio.sleep(0.005)
    at_end = [row for row in done if row[0] == 200]
    await probing
    if tasks:
        await asyncio.wait(tasks, timeout=90)
    for line in idle:
        line.close()
    return number, done, len(at_end) / seconds, ready


async def beside_huge(server, seconds):
    """Times of small meshes that are waited for while huge ones run and wait."""
    line = Line(server.port)
    huge = [await line.ask(b"POST", b"/v1/jobs?operation=verify", body_of(HUGE)) for _ in range(6)]
    begun, done = time.monotonic(), []
    while time.monotonic() - begun < seconds:
        done.append(await verify(line))
    line.close()
    return huge, done


async def campaign(server):
    await sustained(server, 2, 2)
    peak = max([await sustained(server, clients, o.warm / 3) for clients in (2, 4, 8)])
    loaded = await overload(server, peak * o.factor, o.seconds)
    alone = Line(server.port)
    quiet = [await verify(alone) for _ in range(30)]
    alone.close()
    return peak, *loaded, quiet, *await beside_huge(server, 10)


allow_many_files()
with Server(o.binary) as server:
    peak, number, done, goodput, ready, quiet, huge, beside = asyncio.run(campaign(server))
ms = lambda rows: [seconds * 1e3 for _, _, seconds in rows]
good, refused = [r for r in done if r[0] == 200], [r for r in done if r[0] == 429]
other = [r for r in done if r[0] not in (200, 429)]
without = [r for r in refused if "retry-after" not in r[1]]
print(f"# Overload\n\nSmall meshes ({len(SMALL) // 1000} kB) to `/v1/verify`, first from clients that wait for their answers (the best of 2, 4 and 8), then at {o.factor:g} times that rate for "
      f"{o.seconds} s.\nThe client is on the same machine and takes its share of the processor. Made by `scripts/campaign.sh overload` at commit {commit()}.\n")
print("| | |\n|---|---|")
for name, value in [
    ("peak without overload", f"{peak:.0f} a second"),
    ("requests sent", f"{number} ({number / o.seconds:.0f} a second)"),
    ("answered 200", f"{len(good)}"),
    ("goodput", f"{goodput:.0f} a second, {goodput / peak:.0%} of the peak"),
    ("refused with 429", f"{len(refused)}, of which without Retry-After {len(without)}"),
    ("time of a refusal", f"p50 {quantile(ms(refused), .5):.1f} ms, p99 {quantile(ms(refused), .99):.1f} ms, longest {max(ms(refused), default=0):.0f} ms"),
    ("time of a 200", f"p50 {quantile(ms(good), .5):.0f} ms, p99 {quantile(ms(good), .99):.0f} ms"),
    ("other answers", ", ".join(f"{s}: {sum(1 for r in other if r[0] == s)}" for s in sorted({r[0] for r in other})) or "none"),
    ("readiness probes", f"{len(ready)}, p99 {quantile(ms(ready), .99):.1f} ms, other than 200: {sum(1 for r in ready if r[0] != 200)}"),
]:
    print(f"| {name} | {value} |")
print(f"\nSmall meshes from one client, alone and while {sum(1 for r in huge if r[0] == 202)} huge ones ({len(HUGE) // 1000} kB each) run and wait:\n")
print("| | answered 200 | p50 | p99 |\n|---|---|---|---|")
for name, rows in (("alone", quiet), ("beside huge ones", beside)):
    print(f"| {name} | {sum(1 for r in rows if r[0] == 200)} of {len(rows)} | {quantile(ms(rows), .5):.0f} ms | {quantile(ms(rows), .99):.0f} ms |")
targets = {
    "goodput at least 90 % of the peak": goodput >= 0.9 * peak,
    "every refusal has Retry-After": not without,
    "refusals below 50 ms (p99)": quantile(ms(refused), .99) < 50,
    "readiness below 100 ms (p99)": quantile(ms(ready), .99) < 100,
    "no other answer": not other,
    "small meshes are answered beside huge ones": len(beside) > 1 and all(r[0] == 200 for r in beside),
}
print()
for name, is_met in targets.items():
    print(f"- {name}: {'yes' if is_met else 'NO'}")
raise SystemExit(not all(targets.values()))
