"""A client has made every call of the contract, but for the contract itself and those of uploads that it has no use for.

    all_asked.py openapi.yaml NEIGHBOUR_URL NAME...
"""

import json
import re
import sys
import urllib.request

import yaml


# What the server can do is known to the client; an upload goes with its job or by itself; URLs of the bucket are for callers without one.
UNUSED = {("OPTIONS", "/v1/uploads"), ("DELETE", "/v1/uploads/{id}"), ("POST", "/v1/uploads/presigned")}


def main(path, url, *names):
    with open(path, encoding="utf-8") as file:
        paths = yaml.safe_load(file)["paths"]
    calls = {(method.upper(), path) for path, item in paths.items() for method in item if path.startswith("/v1/")} - UNUSED
    for name in names:
        with urllib.request.urlopen(f"{url}/{name}/asked") as answer:
            asked = [(entry["method"], entry["path"]) for entry in json.load(answer)]
        left = [(method, path) for method, path in sorted(calls) if not any(m == method and matches(path, p) for m, p in asked)]
        if left:
            sys.exit(f"{name} has not made these calls: {left}")
    print(f"each client has made all {len(calls)} calls of the contract")


def matches(template, path):
    return re.fullmatch(re.sub(r"\{\w+\}", "[^/]+", template), path) is not None


main(*sys.argv[1:])
