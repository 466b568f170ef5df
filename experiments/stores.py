#!/usr/bin/env python3
"""Servers that share their stores, killed, paused and cut off from their database at random points; prints Markdown.

usage: stores.py [--binary PATH] [--s3 PATH] [--cycles 500] [--seed 1] [--lines]
Two servers take requests and two run jobs, on PostgreSQL and S3. In each cycle one of them, the process of a job or the database is
killed, or a server that runs jobs is stopped past its lease, while clients send jobs, each with a key of its own, and send again
what was not answered; one in four brings its mesh in pieces before the job. At the end every accepted job must have ended once, and no file may be left that no row names.
With `--lines` the network to the database or to the bucket is cut instead, after some bytes in one direction: in the middle of a
statement, of an answer or of an upload.
"""
import argparse
import collections
import http.client
import json
import os
import random
import signal
import sys
import threading
import time

from campaign_server import commit, default_binary, quantile, sphere_stl
from shared_stores import Town, default_s3, killed, paused

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--s3", default=default_s3)
p.add_argument("--cycles", type=int, default=500)
p.add_argument("--seed", type=int, default=1)
p.add_argument("--clients", type=int, default=3)
p.add_argument("--lines", action="store_true")
o = p.parse_args()
dice, over, lock = random.Random(o.seed), threading.Event(), threading.Lock()
LEASE_S = 2
SMALL, LARGE = sphere_stl(12), sphere_stl(200)
# In several parts.
VAST = sphere_stl(300) if o.lines else LARGE
accepted_at, recovered, strange, brought = [], [], [], []
asked, unanswered = {}, collections.Counter()
begun = time.time()


def ask(server, method, path, body=None, headers={}, patience=30):
    """The status and the answer; `None`: there was none."""
    try:
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=patience)
        connection.request(method, path, body, headers)
        response = connection.getresponse()
        content = response.read()
        return response.status, content, response.headers
    except (OSError, http.client.HTTPException):
        return None


def patient(server, method, path):
    """The JSON of an answer that must come in the end."""
    until = time.time() + 120
    while time.time() < until:
        told = ask(server, method, path)
        if told and told[0] not in (429, 503):
            return told[0], json.loads(told[1]) if told[1] else None
        time.sleep(0.2)
    sys.exit(f"no answer to {method} {path}: {told}")


def uploaded(server, body):
    """The request of a job whose mesh was brought in pieces, over as many connections as it took; `None`: not this time."""
    version = {"Tus-Resumable": "1.0.0"}
    made = ask(server, "POST", "/v1/uploads", None, {**version, "Upload-Length": str(len(body))})
    if not made or made[0] != 201:
        return None
    name, until = json.loads(made[1])["id"], time.time() + 60
    while time.time() < until:
        stands = ask(server, "HEAD", f"/v1/uploads/{name}", None, version)
        at = int(stands[2]["upload-offset"]) if stands and stands[0] == 200 else None
        if at == len(body):
            return json.dumps({"input": {"upload": name}})
        if at is not None:
            end = at + max(len(body) // 3, 1)
            bytes_of = {**version, "Content-Type": "application/offset+octet-stream", "Upload-Offset": str(at)}
            ask(server, "PATCH", f"/v1/uploads/{name}", body[at:end], bytes_of)
        else:
            time.sleep(0.1)
    return None


def client(number):
    count = 0
    while not over.is_set():
        count += 1
        key = f"{number}-{count}"
        mesh = VAST if count % 12 == 6 else LARGE if count % 3 == 0 else SMALL
        body = f"{key:<80}".encode() + mesh[80:]
        path, headers = f"/v1/jobs?operation=repair&labels=%7B%22n%22:%22{key}%22%7D", {"Idempotency-Key": key}
        if count % 4 == 1:
            body = uploaded(apis[(number + count) % len(apis)], body)
            if body is None:
                unanswered[number] += 1
                continue
            headers["Content-Type"] = "application/json"
            with lock:
                brought.append(key)
        with lock:
            asked[key] = None
        while not over.is_set():
            told = ask(apis[(number + count + unanswered[number]) % len(apis)], "POST", path, body, headers)
            if told and told[0] == 202:
                with lock:
                    asked[key] = json.loads(told[1])["id"]
                    accepted_at.append(time.time())
                break
            # 409: what was sent before the connection broke is still under way.
            if told and told[0] not in (429, 503) and not (told[0] == 409 and key in brought):
                # It would end this client only, and the others would hide that.
                strange.append(told[0])
                print(f"{told[0]}: {told[1][:500]}", file=sys.stderr, flush=True)
            unanswered[number] += 1
            time.sleep(0.1)
        time.sleep(0.2)


def until_accepted(begun, since):
    """Notes how long after `begun` a job was accepted that was accepted after `since`."""
    until = time.time() + 60
    while time.time() < until:
        with lock:
            later = [at for at in accepted_at[-50:] if at > since]
        if later:
            recovered.append(later[0] - begun)
            return
        time.sleep(0.02)
    recovered.append(60)


def cut():
    """The line to the database or the bucket is cut, at a random byte in a random direction. Its name."""
    which, closes, direction = dice.randrange(2), dice.random() < 0.5, dice.choice(["to", "from"])
    line, most = lines[which], [20_000, 12_000_000 if direction == "to" else 2_000_000][which]
    line.cut_after(int(most ** dice.random()), direction, closes, dice.choice([0.2, 1, 2 * LEASE_S]))
    hit = line.cut.wait(10)
    if not hit:
        line.cut_now()
    begun = time.time()
    with line.change:
        line.change.wait_for(lambda: line.whole)
    until_accepted(begun, time.time())
    how = "closed" if closes else "silent"
    print(f"{['database', 'bucket'][which]} {how} {'at' if hit else 'between'} bytes {direction}: {recovered[-1]:.1f} s", file=sys.stderr, flush=True)
    return f"{['database', 'bucket'][which]} {how} {'at' if hit else 'between'} bytes {direction} it"


def cycle():
    """One blow, at a random moment. Its name."""
    time.sleep(dice.uniform(0, 1.2))
    if o.lines:
        return cut()
    blow = dice.choice(["api", "worker", "worker", "child", "child", "pause", "database"])
    if blow == "api":
        killed(dice.choice(apis))
    elif blow == "worker":
        killed(dice.choice(workers))
    elif blow == "child":
        until = time.time() + 5
        while not (at_work := [pid for worker in workers for pid in worker.children_at_work()]):
            if time.time() > until:
                return "child, where none was at work"
            time.sleep(0.01)
        try:
            os.kill(dice.choice(at_work), signal.SIGKILL)
        except ProcessLookupError:
            return "child, where none was at work"
    elif blow == "pause":
        paused(dice.choice(workers), 2 * LEASE_S)
    else:
        begun = time.time()
        town.database.control("restart")
        until_accepted(begun, time.time())
    return blow


with Town(o.binary, o.s3) as town:
    lines = town.with_lines() if o.lines else ()
    settings = ["--lease", f"{LEASE_S}s", "--queue-max", "100000", "--slots", "2", "--owner-slots-max", "4"]
    apis, workers = [town.server("api", *settings) for _ in range(2)], [town.server("worker", *settings) for _ in range(2)]
    clients = [threading.Thread(target=client, args=(number,)) for number in range(o.clients)]
    for thread in clients:
        thread.start()
    blows = collections.Counter(cycle() for _ in range(o.cycles))
    over.set()
    for thread in clients:
        thread.join()
    accepted = {key: job for key, job in asked.items() if job}
    lost, doubles, states, attempts, without_files = [], 0, collections.Counter(), 0, 0
    for key in asked:
        made = patient(apis[0], "GET", f"/v1/jobs?label=n:{key}")[1]["jobs"]
        doubles += len(made) > 1
        known = accepted.get(key)
        if known and known not in [job["id"] for job in made]:
            lost.append(known)
        for job in made:
            until = time.time() + 300
            while True:
                ended = patient(apis[1], "GET", f"/v1/jobs/{job['id']}?wait=20")[1]
                if ended["state"] in ("succeeded", "failed", "cancelled") or time.time() > until:
                    break
            states[ended["state"] + (f" ({ended['problem']['code']})" if ended.get("problem") else "")] += 1
            attempts += ended["attempts"]
            without_files += (ended.get("problem") or {}).get("code") == "expired"
            if ended["state"] not in ("succeeded", "failed"):
                lost.append(job["id"])
            ends = town.database.ask(f"SELECT count(*) FROM changes WHERE job = '{job['id']}' AND state IN ('succeeded', 'failed', 'cancelled')")
            doubles += ends != [["1"]]
    if strange:
        for server in apis:
            sys.stderr.writelines(line for line in open(server.log.name, errors="replace") if " ERROR " in line or '"ERROR"' in line)
    fenced = sum(open(server.log.name, errors="replace").read().count("a run was in vain")
                 + open(server.log.name, errors="replace").read().count("the claim of a run is void") for server in workers)
    named = {row[0] for row in town.database.ask("SELECT key FROM names UNION SELECT key FROM pieces")}
    before = set(town.bucket.files())
    # Files are left alone for an hour, since somebody may be about to name them: it is made to be over.
    town.bucket.age(2 * 60 * 60)
    killed(workers[0])
    until = time.time() + 60
    while set(town.bucket.files()) - named and time.time() < until:
        time.sleep(0.2)
    after = set(town.bucket.files())
    # Servers end also while nothing answers them.
    for line in lines:
        line.closes, line.seconds = False, 3600
        line.cut_now()
    told = time.time()
    for server in apis + workers:
        server.process.send_signal(signal.SIGTERM)
    hung = 0
    for server in apis + workers:
        try:
            server.process.wait(60)
        except Exception:
            hung += 1
    ended_in = time.time() - told
    for server in apis + workers:
        server.__exit__()

kinds = ", ".join(f"{count} {blow}" for blow, count in sorted(blows.items()))
print(f"""# Campaign `{'stores-cut' if o.lines else 'stores'}`

Made by `experiments/stores.py` at commit {commit()}: {o.cycles} cycles with seed {o.seed} in {time.time() - begun:.0f} s on {os.cpu_count()} cores, where the
load of the machine was {os.getloadavg()[2]:.1f} on average of the last 15 minutes. Two servers for requests, two that run jobs (two slots each, lease {LEASE_S} s), PostgreSQL and an S3
server, all on one machine. Blows: {kinds}.

| what | number |
| --- | --- |
| requests, each with a key | {len(asked)} |
| of these with a mesh that came in pieces before | {len(brought)} |
| answers that did not come or were 503 or 429, sent again | {sum(unanswered.values())} |
| other answers to a request | {', '.join(map(str, strange)) or 'none'} |
| jobs accepted | {len(accepted)} |
| accepted jobs lost | {len(lost)} |
| accepted jobs whose files were lost | {without_files} |
| requests that made two jobs, jobs that ended twice | {doubles} |
{chr(10).join(f"| jobs {state} | {count} |" for state, count in sorted(states.items()))}
| runs lost and made again | {attempts} |
| runs that were told that their claim is void | {fenced} |
| files that no row named before the collection | {len(before - named)} |
| files that no row named after it | {len(after - named)} |
| files that a row names and that are not there | {len(named - after)} |
| seconds from {"a cut" if o.lines else "the order to restart the database"} until a job was accepted again: median, longest | {quantile(recovered, 0.5):.1f}, {max(recovered, default=0):.1f} |
| servers that had not ended 60 s after SIGTERM{" while neither the database nor the bucket answered" if o.lines else ""} (the last ended after {ended_in:.0f} s) | {hung} |
""")
sys.exit(bool(lost or doubles or without_files or after - named or named - after or hung))
