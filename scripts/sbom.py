"""What the program is made of, as a CycloneDX document (JSON) on standard output: every crate that is compiled into it.

    sbom.py [--target TRIPLE ...] [--features LIST]

Needs nothing but Python and cargo. By default for both processors that images are built for. Crates that only build or test
the program are left out. The document is the same for the same Cargo.lock.
"""

import argparse
import json
import pathlib
import subprocess
import tomllib
import uuid

root = pathlib.Path(__file__).resolve().parents[1]
parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--target", nargs="*", default=["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu"])
parser.add_argument("--features", default="default")
options = parser.parse_args()


def metadata(target: str) -> dict:
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target, "--features", options.features]
    return json.loads(subprocess.run(command, cwd=root, check=True, stdout=subprocess.PIPE).stdout)


packages, edges = {}, {}
for target in options.target:
    told = metadata(target)
    by_id = {package["id"]: package for package in told["packages"]}
    nodes = {node["id"]: node for node in told["resolve"]["nodes"]}
    program, seen = told["resolve"]["root"], set()
    left = [program]
    while left:
        if (package := left.pop()) in seen:
            continue
        seen.add(package)
        packages[package] = by_id[package]
        # `kind` is null for what is compiled into its user; a macro runs while its user is compiled.
        needed = [dependency["pkg"] for dependency in nodes[package]["deps"] if any(kind["kind"] is None for kind in dependency["dep_kinds"])]
        needed = [package for package in needed if not any("proc-macro" in target["kind"] for target in by_id[package]["targets"])]
        edges.setdefault(package, set()).update(needed)
        left += needed

sums = {(entry["name"], entry["version"]): entry.get("checksum") for entry in tomllib.loads((root / "Cargo.lock").read_text())["package"]}


def reference(package: dict) -> str:
    return f"pkg:cargo/{package['name']}@{package['version']}"


def component(package: dict, kind: str) -> dict:
    made = {"type": kind, "bom-ref": reference(package), "name": package["name"], "version": package["version"], "purl": reference(package)}
    if package["license"]:
        # `/` is an old way to write OR.
        made["licenses"] = [{"expression": package["license"].replace("/", " OR ")}]
    if digest := sums.get((package["name"], package["version"])):
        made["hashes"] = [{"alg": "SHA-256", "content": digest}]
    return made


crates = sorted((package for id, package in packages.items() if id != program), key=lambda package: (package["name"], package["version"]))
document = {
    "$schema": "http://cyclonedx.org/schema/bom-1.5.schema.json",
    "bomFormat": "CycloneDX",
    "specVersion": "1.5",
    "version": 1,
    "metadata": {"component": component(packages[program], "application")},
    "components": [component(package, "library") for package in crates],
    "dependencies": [
        {"ref": reference(packages[id]), "dependsOn": sorted({reference(packages[needed]) for needed in edges[id]})}
        for id in sorted(packages, key=lambda id: reference(packages[id]))
    ],
}
document["serialNumber"] = f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(document, sort_keys=True))}"
print(json.dumps(document, indent=1))
