"""Readers of YAML 1.1 take the contract for the same as readers of JSON: `off` and `no` are texts.

    yaml_1_1.py openapi.yaml URL
"""

import json
import sys
import urllib.request

import yaml


def main(path, url):
    with open(path, encoding="utf-8") as file:
        read = yaml.safe_load(file)
    with urllib.request.urlopen(f"{url}/openapi.json") as answer:
        sent = json.load(answer)
    assert read == sent, "openapi.yaml as YAML 1.1 is not /openapi.json"
    print("openapi.yaml reads the same as YAML 1.1 and as JSON")


main(*sys.argv[1:])
