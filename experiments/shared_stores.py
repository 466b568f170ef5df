"""A PostgreSQL server, an S3 server and several servers of the service that share them, each in a folder that goes with it."""

import glob
import os
import pwd
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

from campaign_server import Server, free_ports, root

target = os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target"))
default_s3 = os.path.join(target, "release/examples/s3_server")
BUCKET, KEY = "meshes", "an-id\na secret\n"


class Database:
    """Debian's PostgreSQL in a folder, without a port."""

    def __init__(self, **settings):
        found = sorted(glob.glob("/usr/lib/postgresql/*/bin"), key=lambda path: int(path.split("/")[4]))
        if not found:
            sys.exit("PostgreSQL is not installed (Debian's package postgresql)")
        self.programs, self.folder = found[-1], tempfile.mkdtemp(prefix="meshmend-postgres-")
        # The server refuses to run as root.
        self.user = pwd.getpwnam("nobody").pw_uid if os.geteuid() == 0 else None
        if self.user is not None:
            os.chown(self.folder, self.user, -1)
        self.settings = " ".join(f"-c {name}={value}" for name, value in settings.items())
        self.run("initdb", "-U", "meshmend", "--auth=trust", "--encoding=UTF8", "--locale=C")
        self.control("start")
        self.url = f"host={self.folder} user=meshmend dbname=postgres"

    def run(self, program, *arguments):
        done = subprocess.run([f"{self.programs}/{program}", "-D", f"{self.folder}/data", *arguments], cwd=self.folder, user=self.user,
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(f"{program}: {done.stderr}")

    def control(self, word, mode="immediate"):
        options = f"-k {self.folder} -c listen_addresses='' -c max_connections=200 {self.settings}"
        self.run("pg_ctl", "-w", "-l", f"{self.folder}/log", "-o", options, *(["-m", mode] if word != "start" else []), word)

    def ask(self, sql):
        """The rows of an answer, as texts."""
        command = [f"{self.programs}/psql", "-h", self.folder, "-U", "meshmend", "-d", "postgres", "-XAtF", "\t", "-c", sql]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        return [line.split("\t") for line in done.stdout.splitlines()]

    def stop(self):
        self.control("stop")
        shutil.rmtree(self.folder, ignore_errors=True)


class Bucket:
    """An S3 server with one bucket."""

    def __init__(self, program):
        self.folder, (self.port,) = tempfile.mkdtemp(prefix="meshmend-bucket-"), free_ports(1)
        self.process = subprocess.Popen([program, self.folder, str(self.port)], stdin=subprocess.PIPE)
        for _ in range(200):
            try:
                return socket.create_connection(("127.0.0.1", self.port), timeout=1).close()
            except OSError:
                time.sleep(0.05)
        sys.exit("the S3 server did not start")

    def files(self):
        """The paths of all files of jobs, by their keys."""
        base = f"{self.folder}/{BUCKET}/shop"
        return {f"{kind}/{name}": f"{base}/{kind}/{name}" for kind in ("in", "out", "pieces") if os.path.isdir(f"{base}/{kind}")
                for name in os.listdir(f"{base}/{kind}")}

    def age(self, seconds):
        """Makes every file look older."""
        for path in self.files().values():
            then = os.stat(path).st_mtime - seconds
            os.utime(path, (then, then))

    def stop(self):
        self.process.stdin.close()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


class Line:
    """The network between servers and one thing that they share: a proxy that can be cut in the middle of what it passes on."""

    def __init__(self, connect):
        self.connect, (self.port,) = connect, free_ports(1)
        self.change, self.pairs, self.whole, self.closes = threading.Condition(), set(), True, False
        # After so many bytes in that direction the line is cut, which is told by `cut`.
        self.left, self.direction, self.seconds = None, None, 0
        self.cut = threading.Event()
        threading.Thread(target=self.accept, args=(socket.create_server(("127.0.0.1", self.port), backlog=500),), daemon=True).start()

    def cut_after(self, count, direction, closes, seconds):
        """Cuts it for a time after `count` more bytes "to" the server or "from" it. Connections are closed, or nothing comes through."""
        self.cut.clear()
        with self.change:
            self.left, self.direction, self.closes, self.seconds = count, direction, closes, seconds

    def cut_now(self):
        with self.change:
            self.fire()

    def fire(self):
        self.left, self.whole = None, False
        if self.closes:
            self.close_all()
        self.cut.set()
        timer = threading.Timer(self.seconds, self.mend)
        # The campaign may end before.
        timer.daemon = True
        timer.start()

    def mend(self):
        with self.change:
            self.whole = True
            # What was under way when nothing came through does not go on.
            self.close_all()
            self.change.notify_all()

    def close_all(self):
        for pair in self.pairs:
            for end in pair:
                try:
                    end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                    end.shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass
        self.pairs.clear()

    def accept(self, listener):
        while True:
            client, _ = listener.accept()
            with self.change:
                refuses = not self.whole and self.closes
            try:
                server = None if refuses else self.connect()
            except OSError:
                server = None
            if server is None:
                client.close()
                continue
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            pair = (client, server)
            with self.change:
                self.pairs.add(pair)
            for one, other, direction in ((client, server, "to"), (server, client, "from")):
                threading.Thread(target=self.pass_on, args=(one, other, direction, pair), daemon=True).start()

    def pass_on(self, one, other, direction, pair):
        try:
            while piece := one.recv(1 << 16):
                with self.change:
                    self.change.wait_for(lambda: self.whole)
                    if pair not in self.pairs:
                        break
                    if self.left is not None and direction == self.direction:
                        before, self.left = piece[:self.left], self.left - len(piece)
                        if self.left <= 0:
                            other.sendall(before)
                            self.fire()
                            piece = piece[len(before):]
                            self.change.wait_for(lambda: self.whole)
                            if pair not in self.pairs:
                                break
                other.sendall(piece)
            other.shutdown(socket.SHUT_WR)
        except OSError:
            pass
        finally:
            if direction == "from":
                with self.change:
                    self.pairs.discard(pair)
                for end in pair:
                    end.close()


class Town:
    """What servers share."""

    def __init__(self, binary, s3, **database_settings):
        self.binary, self.database, self.bucket = binary, Database(**database_settings), Bucket(s3)
        self.folder = tempfile.mkdtemp(prefix="meshmend-town-")
        with open(f"{self.folder}/key", "w") as file:
            file.write(KEY)
        self.shared = ["--database-url", self.database.url, "--database-connections-max", "8", "--blobs-url", f"s3://{BUCKET}/shop",
                       "--blobs-endpoint", f"http://127.0.0.1:{self.bucket.port}", "--blobs-key-file", f"{self.folder}/key"]

    def with_lines(self):
        """Puts lines that can be cut before the database and the bucket. Both."""
        def to_database():
            found = socket.socket(socket.AF_UNIX)
            found.connect(f"{self.database.folder}/.s.PGSQL.5432")
            return found

        lines = Line(to_database), Line(lambda: socket.create_connection(("127.0.0.1", self.bucket.port)))
        for setting, value in (("--database-url", f"host=127.0.0.1 port={lines[0].port} user=meshmend dbname=postgres sslmode=disable"),
                               ("--blobs-endpoint", f"http://127.0.0.1:{lines[1].port}")):
            self.shared[self.shared.index(setting) + 1] = value
        return lines

    def server(self, role, *settings):
        return Server(self.binary, "--role", role, *self.shared, *settings)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.bucket.stop()
        self.database.stop()
        shutil.rmtree(self.folder, ignore_errors=True)


def killed(server):
    """Kills a server at once and starts it again."""
    server.process.send_signal(signal.SIGKILL)
    server.process.wait()
    server.start()


def paused(server, seconds):
    """Stops a server, as a machine that is suspended does, and lets it go on."""
    server.process.send_signal(signal.SIGSTOP)
    time.sleep(seconds)
    server.process.send_signal(signal.SIGCONT)
