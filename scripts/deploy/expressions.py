"""Writes the queries of the dashboard as rules, so that promtool can read them.

    expressions.py dashboard.json > rules.json
"""

import json
import sys


def main(path):
    with open(path, encoding="utf-8") as file:
        panels = json.load(file)["panels"]
    queries = [target["expr"] for panel in panels for target in panel["targets"]]
    for variable, value in (("$__rate_interval", "5m"), ("$job", "meshmend"), ("$instance", ".*")):
        queries = [query.replace(variable, value) for query in queries]
    rules = [{"record": f"dashboard:query{number}", "expr": query} for number, query in enumerate(queries)]
    json.dump({"groups": [{"name": "dashboard", "rules": rules}]}, sys.stdout)


main(*sys.argv[1:])
