"""Checks that every dependency can be used under a licence that deny.toml allows. Needs nothing but cargo."""

import json
import re
import subprocess
import sys
import tomllib

allowed = set(tomllib.load(open("deny.toml", "rb"))["licenses"]["allow"])
metadata = subprocess.run(
    ["cargo", "metadata", "--locked", "--format-version", "1", "--all-features"], check=True, stdout=subprocess.PIPE
).stdout
packages = json.loads(metadata)["packages"]


def holds(expression: str) -> bool:
    """Evaluates an SPDX expression; `/` is an old way to write OR."""
    words = re.findall(r"\(|\)|[^\s()/]+(?:\s+WITH\s+[^\s()]+)?", expression.replace("/", " OR "))
    operators = {"(": "(", ")": ")", "AND": "and", "OR": "or"}
    return eval(" ".join(operators.get(word, str(" ".join(word.split()) in allowed)) for word in words))


refused = [f"{p['name']} {p['version']}: {p['license']}" for p in packages if not (p["license"] and holds(p["license"]))]
print("\n".join(refused) or f"the licences of {len(packages)} packages are permissive")
sys.exit(bool(refused))
