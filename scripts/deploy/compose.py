"""The compose files of deploy/ are whole: their first lines make every file that they name, and their settings are settings.

    compose.py PROGRAM

PROGRAM says whether the settings of each service are settings. No container is started.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The services that are built from this tree.
SERVERS = {"compose.yaml": ["meshmend"], "compose.several.yaml": ["first", "second", "worker"]}


def main(program):
    (lines,) = [line for line in (ROOT / "Dockerfile").read_text().splitlines() if line.startswith("ENV MESHMEND_")]
    image = dict(re.findall(r"(MESHMEND_\w+)=(\S+)", lines))
    for name, servers in SERVERS.items():
        with tempfile.TemporaryDirectory() as folder:
            check(program, ROOT / "deploy" / name, pathlib.Path(folder), servers, image)
    print(f"{len(SERVERS)} compose files are whole")


def check(program, file, folder, servers, image):
    text = file.read_text()
    document = yaml.safe_load(text)
    # What a reader is told to do first.
    commands = [line[4:] for line in text.splitlines() if line.startswith("#   ") and "docker compose" not in line]
    environment = {"PATH": os.environ["PATH"], "KEY": "a key of this test"}
    subprocess.run(["bash", "-euo", "pipefail", "-c", "\n".join(commands)], cwd=folder, env=environment, check=True)
    (folder / "deploy").mkdir()
    shutil.copy(file, folder / "deploy")
    secrets = {secret: (folder / "deploy" / told["file"]).resolve() for secret, told in document["secrets"].items()}
    if missing := [secret for secret, path in secrets.items() if not path.is_file()]:
        sys.exit(f"{file.name}: nothing makes {missing}")
    built = [service for service, told in document["services"].items() if "build" in told]
    if built != servers:
        sys.exit(f"{file.name}: its servers are {built}")
    for service, told in document["services"].items():
        own = told.get("secrets", [])
        if unknown := set(own) - secrets.keys():
            sys.exit(f"{file.name}: {service} has no secret {unknown}")
        named = set(re.findall(r"/run/secrets/(\w+)", json.dumps(told)))
        if named != set(own):
            sys.exit(f"{file.name}: {service} names {named} and has {own}")
        if unknown := set(told.get("depends_on", [])) - document["services"].keys():
            sys.exit(f"{file.name}: {service} waits for {unknown}")
    for service in built:
        told = document["services"][service]
        if not (told["read_only"] and told["cap_drop"] == ["ALL"] and "no-new-privileges:true" in told["security_opt"]):
            sys.exit(f"{file.name}: {service} has rights that it does not need")
        settings = {**image, **told["environment"], "MESHMEND_DATA_DIR": str(folder)}
        settings = {key: re.sub(r"^/run/secrets/(\w+)$", lambda found: str(secrets[found[1]]), value) for key, value in settings.items()}
        checked = subprocess.run([program, "config", "check", "--strict"], env=settings, capture_output=True, text=True)
        if checked.returncode:
            sys.exit(f"{file.name}: {service}: {checked.stdout}{checked.stderr}")
    if "s3_config" in secrets:
        (identity,) = json.loads(secrets["s3_config"].read_text())["identities"]
        credentials = identity["credentials"][0]
        if secrets["bucket_key"].read_text().split("\n")[:2] != [credentials["accessKey"], credentials["secretKey"]]:
            sys.exit(f"{file.name}: the bucket has another key than the servers")


if __name__ == "__main__":
    main(sys.argv[1])
