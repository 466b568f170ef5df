#!/usr/bin/env python3
"""Ten times the load that can be sustained: what is done, what is refused and how quickly; then small meshes beside huge ones; prints Markdown.

usage: overload.py [--binary PATH] [--seconds 60] [--factor 10] [--warm 30]
Every request has a mesh of its own, so that none is answered from an earlier one.
"""
import argparse
import asyncio
import math
import os
import time

from campaign_server import Server, allow_many_files, commit, default_binary, processor_ticks, quantile, share_taken, sphere_stl

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--seconds", type=int, default=60)
p.add_argument("--factor", type=float, default=10)
p.add_argument("--warm", type=int, default=30)
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


def broken_stl():
    """A sphere of 1 MB without some of its triangles."""
    whole = sphere_stl(71)
    kept = [whole[i:i + 50] for n, i in enumerate(range(84, len(whole), 50)) if n % 997]
    return bytes(80) + len(kept).to_bytes(4, "little") + b"".join(kept)


def verify_body():
    """The small mesh with a comment of its own, so that no other request has the same bytes."""
    return SMALL + b"\n# %d\n" % next(counter)


BROKEN = broken_stl()


def repair_body():
    """The broken mesh under a header of its own."""
    return b"%-80d" % next(counter) + BROKEN[80:]


# What is asked for: the path, a body that no other request has, and further headers. Clients such as curl ask before they
# send a large body.
LOADS = {
    "verify": (b"/v1/verify", verify_body, b"Accept: application/json\r\n"),
    "repair": (b"/v1/repair", repair_body, b"Accept: application/json\r\nExpect: 100-continue\r\n"),
}


class Line:
    """A connection that is kept."""

    def __init__(self, port):
        self.port, self.writer = port, None

    async def ask(self, method, path, body=lambda: b"", more=b""):
        """Status, headers and seconds of one request. The body is made when it is sent."""
        begun = time.monotonic()
        try:
            if self.writer and self.reader.at_eof():
                # The server has ended it while it was not used.
                self.close()
            if self.writer is None:
                self.reader, self.writer = await asyncio.open_connection("127.0.0.1", self.port)
            has_asked = b"Expect:" in more
            content = BROKEN if has_asked else body()
            head = b"%s %s HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n%s\r\n" % (method, path, len(content), more)
            self.writer.write(head if has_asked else head + content)
            status, headers = await self.head()
            if has_asked and status == 100:
                self.writer.write(body())
                status, headers = await self.head()
            elif has_asked:
                # The server may still wait for the body.
                headers["connection"] = "close"
            await self.reader.readexactly(int(headers.get("content-length", 0)))
            if headers.get("connection") == "close":
                self.close()
            return status, headers, time.monotonic() - begun
        except (OSError, asyncio.IncompleteReadError):
            self.close()
            return 0, {}, time.monotonic() - begun

    async def head(self):
        """Status and headers of an answer."""
        head = (await self.reader.readuntil(b"\r\n\r\n")).decode().split("\r\n")
        return int(head[0].split()[1]), dict(line.lower().split(": ", 1) for line in head[1:] if line)

    def close(self):
        if self.writer:
            self.writer.close()
        self.writer = None


async def send(line, load="verify"):
    path, body, more = LOADS[load]
    return await line.ask(b"POST", path, body, more)


async def sustained(server, load, clients, seconds):
    """Requests a second of clients that ask again when they have been answered."""
    done, end = [], time.monotonic() + seconds

    async def client():
        line = Line(server.port)
        while time.monotonic() < end:
            answer = await send(line, load)
            # What is answered later was not done in this time.
            if time.monotonic() < end:
                done.append(answer)
        line.close()

    await asyncio.gather(*(client() for _ in range(clients)))
    return sum(1 for status, *_ in done if status == 200) / seconds


async def overload(server, load, rate, seconds):
    """Requests at a fixed rate, whatever becomes of them."""
    idle, done, ready = [], [], []
    end = time.monotonic() + seconds

    async def one():
        line = idle.pop() if idle else Line(server.port)
        done.append(await send(line, load))
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
    huge = [await line.ask(b"POST", b"/v1/jobs?operation=verify", lambda: HUGE + b"\n# %d\n" % next(counter)) for _ in range(6)]
    begun, done = time.monotonic(), []
    while time.monotonic() - begun < seconds:
        done.append(await send(line))
    line.close()
    return huge, done


async def campaign(server):
    loads = {}
    for load in LOADS:
        await sustained(server, load, 2, 2)
        ticks = processor_ticks()
        peak = max([await sustained(server, load, clients, o.warm / 3) for clients in (2, 4, 8)])
        taken_before = share_taken(ticks)
        used, ticks = time.process_time(), processor_ticks()
        number, done, goodput, ready = await overload(server, load, peak * o.factor, o.seconds)
        taken = taken_before, share_taken(ticks)
        loads[load] = peak, number, done, goodput, ready, (time.process_time() - used) / o.seconds, taken
        await asyncio.sleep(5)
    alone = Line(server.port)
    quiet = [await send(alone) for _ in range(30)]
    alone.close()
    return loads, quiet, *await beside_huge(server, 10)


def ms(rows):
    """Milliseconds of requests."""
    return [seconds * 1e3 for _, _, seconds in rows]


def columns(peak, number, done, goodput, ready, client, taken):
    """The figures of one load, and whether each target is met."""
    good, refused = [r for r in done if r[0] == 200], [r for r in done if r[0] == 429]
    other = [r for r in done if r[0] not in (200, 429)]
    without = [r for r in refused if "retry-after" not in r[1]]
    share = goodput / peak / (1 - client / os.cpu_count())
    figures = [
        f"{peak:.0f} a second",
        f"{number} ({number / o.seconds:.0f} a second)",
        f"{len(good)}",
        f"{goodput:.0f} a second, {goodput / peak:.0%} of the peak",
        f"{len(refused)}, of which without Retry-After {len(without)}",
        f"p50 {quantile(ms(refused), .5):.1f} ms, p99 {quantile(ms(refused), .99):.1f} ms, longest {max(ms(refused), default=0):.0f} ms",
        f"p50 {quantile(ms(good), .5):.0f} ms, p99 {quantile(ms(good), .99):.0f} ms",
        ", ".join(f"{s}: {sum(1 for r in other if r[0] == s)}" for s in sorted({r[0] for r in other})) or "none",
        f"{len(ready)}, p99 {quantile(ms(ready), .99):.1f} ms, other than 200: {sum(1 for r in ready if r[0] != 200)}",
        f"{client:.0%} of a core",
        f"{share:.0%}",
        "{:.1%} and {:.1%}".format(*taken),
    ]
    return figures, [share >= 0.9, not without, quantile(ms(refused), .99) < 50, quantile(ms(ready), .99) < 100, not other]


allow_many_files()
with Server(o.binary) as server:
    loads, quiet, huge, beside = asyncio.run(campaign(server))
tables = [columns(*loads[load]) for load in LOADS]
print(f"# Overload\n\nTwo loads, first from clients that wait for their answers (the best of 2, 4 and 8), then at {o.factor:g} times that rate for {o.seconds} s: `verify` of small\n"
      f"valid meshes ({len(SMALL) // 1000} kB), sent at once, and `repair` of broken ones ({len(BROKEN) / 1e6:.1f} MB), sent after `100 Continue` as curl does. No two requests have the\n"
      f"same mesh. The client is on the same machine and takes its share of the processor. Made by `scripts/campaign.sh overload` at commit {commit()}.\n")
print("| | verify | repair |\n|---|---|---|")
names = ["peak without overload", "requests sent", "answered 200", "goodput", "refused with 429", "time of a refusal", "time of a 200", "other answers", "readiness probes", "the client's own processor time", "goodput as a share of the peak with the processor that the client leaves", "processors that the host gave to others, before and in the overload"]
for name, *values in zip(names, *(figures for figures, _ in tables)):
    print(f"| {name} | {' | '.join(values)} |")
print(f"\nSmall meshes from one client, alone and while {sum(1 for r in huge if r[0] == 202)} huge ones ({len(HUGE) // 1000} kB each) run and wait:\n")
print("| | answered 200 | p50 | p99 |\n|---|---|---|---|")
for name, rows in (("alone", quiet), ("beside huge ones", beside)):
    print(f"| {name} | {sum(1 for r in rows if r[0] == 200)} of {len(rows)} | {quantile(ms(rows), .5):.0f} ms | {quantile(ms(rows), .99):.0f} ms |")
word = lambda is_met: "yes" if is_met else "NO"
targets = ["goodput at least 90 % of the peak, the client's processor time left out", "every refusal has Retry-After", "refusals below 50 ms (p99)", "readiness below 100 ms (p99)", "no other answer"]
print("\n| target | verify | repair |\n|---|---|---|")
for name, *met in zip(targets, *(met for _, met in tables)):
    print(f"| {name} | {' | '.join(map(word, met))} |")
is_small_answered = len(beside) > 1 and all(r[0] == 200 for r in beside)
print(f"\nSmall meshes are answered beside huge ones: {word(is_small_answered)}.")
raise SystemExit(not (is_small_answered and all(all(met) for _, met in tables)))
