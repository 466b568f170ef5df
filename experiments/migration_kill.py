#!/usr/bin/env python3
"""`migrate` killed at random points and run again; prints Markdown. Ends with 1 when a job or a file is lost, doubled or left over.

usage: migration_kill.py [--binary PATH] [--s3 PATH] [--cycles 250] [--jobs 40] [--seed 1]
A server of one machine takes jobs, most of which end, and is killed. In each cycle the shared stores, PostgreSQL and S3, are emptied;
`migrate` is killed one to three times, at a random moment of the time that it took lately, and then runs to its end.
"""
import argparse
import collections
import hashlib
import http.client
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time

from campaign_server import Server, commit, default_binary, sphere_stl
from shared_stores import BUCKET, Town, default_s3

p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
p.add_argument("--binary", default=default_binary)
p.add_argument("--s3", default=default_s3)
p.add_argument("--cycles", type=int, default=250)
p.add_argument("--jobs", type=int, default=40)
p.add_argument("--seed", type=int, default=1)
o = p.parse_args()
dice = random.Random(o.seed)


def ask(server, method, path, body=None):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    connection.request(method, path, body)
    response = connection.getresponse()
    return response.status, response.read()


def digests(folder):
    """The digest of every file under a folder, by its path."""
    found = {}
    for base, _, names in os.walk(folder):
        for name in names:
            with open(os.path.join(base, name), "rb") as file:
                found[os.path.relpath(os.path.join(base, name), folder)] = hashlib.sha256(file.read()).hexdigest()
    return found


def migrate(town, data):
    return subprocess.Popen([o.binary, "migrate", "--data-dir", data, *town.shared], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, text=True, env={})


def emptied(town):
    town.database.ask("DROP SCHEMA public CASCADE; CREATE SCHEMA public")
    shutil.rmtree(f"{town.bucket.folder}/{BUCKET}/shop", ignore_errors=True)


def faults(town, ids, source):
    """What is wrong in the shared stores."""
    found = [row[0] for row in town.database.ask("SELECT id FROM jobs ORDER BY id")]
    named = {row[0] for row in town.database.ask("SELECT DISTINCT key FROM names")}
    stored = town.bucket.files()
    wrong = [f"job {id} is lost" for id in ids - set(found)] + [f"job {id} is there and was not" for id in set(found) - ids]
    wrong += [f"job {id} is there twice" for id, count in collections.Counter(found).items() if count > 1]
    wrong += [f"file {key} is left over" for key in stored.keys() - named] + [f"file {key} is lost" for key in named - stored.keys()]
    for key in named & stored.keys():
        with open(stored[key], "rb") as file:
            if hashlib.sha256(file.read()).hexdigest() not in source:
                wrong.append(f"file {key} is damaged")
    return wrong


begun = time.time()
server = Server(o.binary, "--slots", "2")
ids, results = set(), {}
for number in range(o.jobs):
    mesh = sphere_stl(12 if number % 4 else 120)
    if number % 5 == 0:
        mesh = mesh[:-50]
    status, told = ask(server, "POST", f"/v1/jobs?operation={'verify' if number % 3 == 0 else 'repair'}", f"{number:<80}".encode() + mesh[80:])
    job = json.loads(told)
    if status != 202:
        sys.exit(f"{status}: {told}")
    ids.add(job["id"])
    # The last ones are not waited for: they are under way or wait when the server is killed.
    until = time.time() + 60
    while number < o.jobs - 6 and time.time() < until:
        job = json.loads(ask(server, "GET", f"/v1/jobs/{job['id']}")[1])
        if job["state"] not in ("queued", "running"):
            break
        time.sleep(0.02)
    status, result = ask(server, "GET", f"/v1/jobs/{job['id']}/result") if job["state"] == "succeeded" else (404, None)
    if status == 200:
        results[job["id"]] = hashlib.sha256(result).hexdigest()
server.process.send_signal(signal.SIGKILL)
server.process.wait()
data = os.path.join(server.folder, "data")
before = digests(data)

counts, wrong = collections.Counter(), []
with Town(o.binary, o.s3) as town:
    at = time.time()
    whole = migrate(town, data)
    if whole.wait():
        sys.exit(f"migrate: {whole.stderr.read()}")
    took = time.time() - at
    for cycle in range(o.cycles):
        emptied(town)
        ended = False
        for _ in range(dice.randint(1, 3)):
            run = migrate(town, data)
            time.sleep(dice.uniform(0, 1.1 * took))
            run.send_signal(signal.SIGKILL)
            if run.wait() == 0:
                counts["ended before the kill"] += 1
                ended, took = True, 0.9 * took
                break
            counts["kills"] += 1
            # How long it takes depends on what else the machine does.
            took *= 1.03
            counts["kills after all rows were there"] += bool(town.database.ask("SELECT to_regclass('jobs')")[0][0]) and town.database.ask("SELECT count(*) FROM jobs")[0][0] != "0"
        if not ended:
            run = migrate(town, data)
            code = run.wait()
            told = run.stderr.read()
            # Killed between the last row and its own end, it has done all.
            if code and f"holds {len(ids)} jobs already" not in told:
                wrong.append(f"cycle {cycle}: {told.strip()}")
        wrong += [f"cycle {cycle}: {what}" for what in faults(town, ids, set(before.values()))]
        if cycle % 50 == 49 or cycle + 1 == o.cycles:
            with town.server("api") as api:
                for id, digest in results.items():
                    status, result = ask(api, "GET", f"/v1/jobs/{id}/result")
                    if status != 200 or hashlib.sha256(result).hexdigest() != digest:
                        wrong.append(f"cycle {cycle}: the result of job {id} is another one ({status})")
                    counts["results compared"] += 1
                api.stop()
if digests(data) != before:
    wrong.append("the data directory has changed")
shutil.rmtree(server.folder, ignore_errors=True)

print(f"""# `migrate`, killed

Made by `scripts/campaign.sh migration-kill` at commit {commit()}, seed {o.seed}, in {time.time() - begun:.0f} s on {os.cpu_count()} cores.
{o.cycles} times the {len(ids)} jobs of one machine with {len(before)} files, some of which have ended, failed, run or wait, are carried over to
empty stores, PostgreSQL and S3. `migrate` is killed with SIGKILL one to three times, at a random moment, and
then runs to its end. Then every job must be there once, every file that a row names must be there with its digest and no other,
and the data directory must be as it was.

| what | number |
|---|---|
| kills | {counts["kills"]} |
| of them after all rows were there | {counts["kills after all rows were there"]} |
| runs that ended before their kill | {counts["ended before the kill"]} |
| results read through a server and compared | {counts["results compared"]} |
| jobs or files lost, doubled, damaged or left over | {len(wrong)} |
""")
for what in wrong[:20]:
    print(f"- {what}")
sys.exit(bool(wrong))
