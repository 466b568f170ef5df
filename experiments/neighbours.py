#!/usr/bin/env python3
"""One owner floods a service with files that are dear for their size while another sends small meshes; prints Markdown. Ends with 1 when the other one's p99 is more than three times that without the flood, or something of it is lost.

usage: neighbours.py [--binary PATH] [--seconds 60] [--clients 8] [--pause 0.25]

The service runs on its defaults, with a key for each owner. Every request has a mesh of its own, so that none is answered from an earlier one.
"""
import argparse
import collections
import http.client
import http.server
import json
import os
import sys
import tempfile
import threading
import time

import hostile_files
from campaign_server import Server, commit, default_binary, free_ports, processor_ticks, quantile, share_taken

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--seconds", type=float, default=60)
p.add_argument("--clients", type=int, default=8, help="connections of the one who floods")
p.add_argument("--pause", type=float, default=0.25, help="between two requests of the other one, in seconds")
o = p.parse_args()
TIMES_MAX = 3
counter = iter(range(1, 1 << 40))

# Of the campaign `hostile`, those that cost most for their bytes.
DEAR = [(hostile_files.random_triangles, 240), (hostile_files.random_triangles, 5000), (hostile_files.crossing_planes, 20),
        (hostile_files.crossing_planes, 1000), (hostile_files.rotated_beams, 100), (hostile_files.random_faces_at_one_vertex, 1000)]
CUBE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n"


def small():
    """A cube without a side, as OBJ."""
    return f"{CUBE}# {next(counter)}\n".encode()


def dear(stl):
    """The same mesh under a header of its own."""
    return b"%-80d" % next(counter) + stl[80:]


def ask(port, key, method, path, body=None, headers=None):
    """Status, body and time of one request on a connection of its own."""
    begun = time.monotonic()
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=600)
    try:
        connection.request(method, path, body, {"Authorization": f"Bearer {key}", **(headers or {})})
        answer = connection.getresponse()
        return answer.status, answer.read(), time.monotonic() - begun
    except (OSError, http.client.HTTPException) as error:
        return type(error).__name__, b"", time.monotonic() - begun
    finally:
        connection.close()


BOUNDARY = "a-line-that-no-mesh-has"


def form(hook, mesh):
    """A job with a webhook."""
    job = json.dumps({"operation": "repair", "webhook": {"url": hook, "secret": "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"}}).encode()
    part = lambda name, more, content: b"--%s\r\nContent-Disposition: form-data; name=%s%s\r\n\r\n%s\r\n" % (BOUNDARY.encode(), name, more, content)
    return part(b"job", b"\r\nContent-Type: application/json", job) + part(b"mesh", b"; filename=cube.obj", mesh) + b"--%s--\r\n" % BOUNDARY.encode()


class Calls(http.server.BaseHTTPRequestHandler):
    """Notes which jobs a webhook tells of."""
    told = []

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        Calls.told.append(json.loads(body))
        self.send_response(204)
        self.end_headers()

    def log_message(self, *_):
        pass


def quiet(server, seconds, hook):
    """Small repairs one after the other, and a job with a webhook beside each tenth: times, statuses, and the jobs."""
    times, statuses, jobs = [], collections.Counter(), []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        status, _, took = ask(server.port, "quiet-key", "POST", "/v1/repair", small())
        statuses[status] += 1
        times.append(took)
        if len(times) % 10 == 0:
            status, body, _ = ask(server.port, "quiet-key", "POST", "/v1/jobs", form(hook, small()), {"Content-Type": f"multipart/form-data; boundary={BOUNDARY}"})
            statuses[status] += 1
            jobs += [json.loads(body)["id"]] if status == 202 else []
        time.sleep(o.pause)
    return times, statuses, jobs


def flood(server, files, until, statuses, number):
    """Dear files without a pause, half of them waited for."""
    i = number
    while not until.is_set():
        i += 1
        path = "/v1/repair" if i // len(files) % 2 else "/v1/jobs?operation=repair"
        status, _, _ = ask(server.port, "loud-key", "POST", path, dear(files[i % len(files)]), {"Prefer": "wait=20"})
        statuses[status] += 1


with tempfile.TemporaryDirectory() as folder:
    keys = os.path.join(folder, "keys")
    open(keys, "w").write("loud-key\nquiet-key\n")
    os.chmod(keys, 0o600)
    files = [make(size)[1] for make, size in DEAR]
    [hook_port] = free_ports(1)
    receiver = http.server.ThreadingHTTPServer(("127.0.0.1", hook_port), Calls)
    threading.Thread(target=receiver.serve_forever, daemon=True).start()
    hook = f"http://127.0.0.1:{hook_port}/"
    # As by default, which other campaigns turn off.
    settings = ["--rate-per-minute", "1200", "--api-keys-file", keys, "--webhooks", "--webhook-private-hosts", f"127.0.0.1:{hook_port}"]
    with Server(o.binary, *settings) as server:
        before = processor_ticks()
        alone = quiet(server, o.seconds, hook)
        until, of_flood = threading.Event(), collections.Counter()
        loud = [threading.Thread(target=flood, args=(server, files, until, of_flood, n)) for n in range(o.clients)]
        for thread in loud:
            thread.start()
        try:
            time.sleep(3)
            beside = quiet(server, o.seconds, hook)
            # What the other one had is asked for while the flood goes on.
            lost = []
            for job in alone[2] + beside[2]:
                deadline = time.monotonic() + 60
                while True:
                    status, body, _ = ask(server.port, "quiet-key", "GET", f"/v1/jobs/{job}")
                    state = json.loads(body).get("state") if status == 200 else status
                    if state not in ("queued", "running") or time.monotonic() > deadline:
                        break
                    time.sleep(0.2)
                result, _, _ = ask(server.port, "quiet-key", "GET", f"/v1/jobs/{job}/result")
                lost += [job] if state != "succeeded" or result != 200 else []
            deadline = time.monotonic() + 30
            missing = lambda: [job for job in alone[2] + beside[2] if not any(job in json.dumps(call) for call in Calls.told)]
            while missing() and time.monotonic() < deadline:
                time.sleep(0.5)
            untold = missing()
        finally:
            until.set()
            for thread in loud:
                thread.join()
        taken = share_taken(before)
    receiver.shutdown()

p99 = [quantile(times, 0.99) for times, _, _ in (alone, beside)]
others = sum(count for run in (alone, beside) for status, count in run[1].items() if status not in (200, 202))
accepted = of_flood[200] + of_flood[202]
holds = p99[1] <= TIMES_MAX * p99[0] and not lost and not untold and others == 0 and accepted >= len(DEAR)
told = lambda times: " | ".join(f"{1000 * x:.0f} ms" for x in (quantile(times, 0.5), quantile(times, 0.99), max(times)))
print(f"""# Campaign `neighbours`

Made by `experiments/neighbours.py` at commit {commit()} on {os.cpu_count()} cores, of which the host gave {100 * taken:.0f} % to others. One owner repairs a small
mesh every {o.pause} s, first alone and then while another sends dear files of the campaign `hostile` over {o.clients} connections without a pause, for {o.seconds:.0f} s
each. Both have a key; the service runs on its defaults.

| | requests | p50 | p99 | longest |
|---|---:|---:|---:|---:|
| alone | {len(alone[0])} | {told(alone[0])} |
| beside the flood | {len(beside[0])} | {told(beside[0])} |

| what | number |
|---|---:|
| p99 beside the flood, as a multiple of that alone (at most {TIMES_MAX}) | {p99[1] / p99[0]:.1f} |
| answers other than 200 and 202 | {others} |
| jobs with a webhook | {len(alone[2]) + len(beside[2])} |
| of those without a result | {len(lost)} |
| of those without a call | {len(untold)} |
| answers to the flood | {", ".join(f"{count} of {status}" for status, count in of_flood.most_common())} |
""")
sys.exit(0 if holds else 1)
