"""Takes from the contract what the types of the clients are made of: its schemas, without the forms that carry files.

    schemas.py openapi.yaml > schemas.json

Paths, answers and headers are the business of the hand-written layer of each client.
"""

import json
import sys

import yaml


def main(path):
    with open(path, encoding="utf-8") as file:
        contract = yaml.safe_load(file)
    schemas = {name: schema for name, schema in contract["components"]["schemas"].items() if not name.endswith("Form")}
    made = {"openapi": contract["openapi"], "info": contract["info"], "paths": {}, "components": {"schemas": schemas}}
    json.dump(made, sys.stdout, indent=1, ensure_ascii=False)


main(*sys.argv[1:])
