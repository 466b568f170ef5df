"""A server for one campaign: free ports on loopback, a data folder that goes with it, and what the system says about it."""

import math
import os
import resource
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
default_binary = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release/meshmend")


def free_ports(count):
    """Ports of loopback that nobody listens on."""
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def allow_many_files():
    """Raises this process's limit on open files as far as it goes."""
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))


class Server:
    """The service, from start to stop."""

    def __init__(self, binary, *settings):
        self.folder = tempfile.mkdtemp(prefix="meshmend-campaign-")
        self.port, self.admin_port = free_ports(2)
        environment = {name: value for name, value in os.environ.items() if not name.startswith("MESHMEND_")}
        # One caller sends all that is measured.
        environment["MESHMEND_RATE_PER_MINUTE"] = "0"
        self.log = open(os.path.join(self.folder, "log"), "wb")
        self.environment = environment
        self.command = [binary, "serve", "--listen", f"127.0.0.1:{self.port}", "--admin-listen", f"127.0.0.1:{self.admin_port}",
                   "--data-dir", os.path.join(self.folder, "data"), "--log", "warn", *settings]
        self.start()

    def start(self):
        """Starts it and waits until it listens."""
        self.process = subprocess.Popen(self.command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.log, env=self.environment)
        for _ in range(200):
            try:
                socket.create_connection(("127.0.0.1", self.admin_port), timeout=1).close()
                return
            except OSError:
                if self.process.poll() is not None:
                    break
                time.sleep(0.05)
        sys.exit(f"the server did not start: {open(self.log.name).read()}")

    def __enter__(self):
        return self

    def stop(self):
        """Ends it as an operator would."""
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(45)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def restart(self):
        """Ends it, and starts it on the same ports and folder."""
        self.stop()
        self.start()

    def __exit__(self, *_):
        self.stop()
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def processes(self):
        """The server and its children."""
        pids, seen = [self.process.pid], []
        while pids:
            pid = pids.pop()
            seen.append(pid)
            try:
                for task in os.listdir(f"/proc/{pid}/task"):
                    pids += map(int, open(f"/proc/{pid}/task/{task}/children").read().split())
            except OSError:
                pass
        return seen

    def children_at_work(self):
        """Processes that run a job; they are called so from their task on."""
        at_work = []
        for pid in self.processes()[1:]:
            try:
                at_work += [pid] if open(f"/proc/{pid}/comm").read().strip() == "meshmend-job" else []
            except OSError:
                pass
        return at_work

    def anonymous_bytes(self):
        """Anonymous resident memory of the server and its children."""
        total = 0
        for pid in self.processes():
            try:
                lines = open(f"/proc/{pid}/status").read().splitlines()
                total += sum(int(line.split()[1]) * 1024 for line in lines if line.startswith("RssAnon:"))
            except OSError:
                pass
        return total


def commit():
    """The commit that is measured."""
    git = lambda *a: subprocess.run(["git", *a], cwd=root, capture_output=True, text=True).stdout.strip()
    return git("rev-parse", "--short", "HEAD") + (" with local changes" if git("status", "--porcelain") else "")


def processor_ticks():
    """Ticks of all processors so far, and of them those that the host of this virtual machine gave to others."""
    fields = [int(field) for field in open("/proc/stat").readline().split()[1:]]
    return sum(fields[:8]), fields[7]


def share_taken(before):
    """Share of the processors that the host gave to others since `before`, a reading of `processor_ticks`."""
    (all_now, taken_now), (all_then, taken_then) = processor_ticks(), before
    return (taken_now - taken_then) / max(1, all_now - all_then)


def quantile(values, share):
    """The value below which that share of the values lies."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else float("nan")


def sphere_stl(rings, radius=10, at=(0, 0, 0)):
    """A closed surface of 4 * rings * (rings - 1) triangles as binary STL, with 80 bytes of header that are free."""
    n = 2 * rings
    ring = lambda i: [tuple(radius * x + c for x, c in zip((math.sin(math.pi * i / rings) * math.cos(math.pi * 2 * j / n),
                      math.sin(math.pi * i / rings) * math.sin(math.pi * 2 * j / n), math.cos(math.pi * i / rings)), at)) for j in range(n)]
    rows = [[tuple(c + radius * (k == 2) for k, c in enumerate(at))] * n] + [ring(i) for i in range(1, rings)]
    rows += [[tuple(c - radius * (k == 2) for k, c in enumerate(at))] * n]
    triangles = []
    for i in range(rings):
        for j in range(n):
            a, b, c, d = rows[i][j], rows[i + 1][j], rows[i + 1][(j + 1) % n], rows[i][(j + 1) % n]
            triangles += ([(a, b, c)] if i < rings - 1 or b != c else []) + ([(a, c, d)] if i > 0 else [])
    pack = struct.Struct("<12fH").pack
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(pack(0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles)
