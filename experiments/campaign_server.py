"""A server for one campaign: free ports on loopback, a data folder that goes with it, and what the system says about it."""

import os
import resource
import shutil
import signal
import socket
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
        self.log = open(os.path.join(self.folder, "log"), "wb")
        command = [binary, "serve", "--listen", f"127.0.0.1:{self.port}", "--admin-listen", f"127.0.0.1:{self.admin_port}",
                   "--data-dir", os.path.join(self.folder, "data"), "--log", "warn", *settings]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.log, env=environment)
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

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(45)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
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


def quantile(values, share):
    """The value below which that share of the values lies."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else float("nan")
