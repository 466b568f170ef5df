"""Every metric that an alert, the dashboard or the runbook names is one that the service has, with the labels it has.

    names.py

Names are read out of the sources; what only a histogram has (`_bucket`, `_sum`, `_count`) counts as its name.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLACES = ["deploy/monitoring/alerts.yaml", "deploy/monitoring/alerts_test.yaml", "deploy/monitoring/dashboard.json", "docs/runbook.md"]
# Labels that Prometheus adds.
ADDED = {"job", "instance", "le", "__name__"}


def main():
    # One call of a macro each: its name, and the labels behind it.
    sources = "\n".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "src").rglob("*.rs")))
    constants = dict(re.findall(r'const (\w+): &str = "(meshmend_\w+)";', sources))
    labels = {}
    for kind, name, rest in re.findall(r"\b(counter|gauge|histogram)!\(\s*(\"meshmend_\w+\"|[A-Z_]+)([^;]*?)\)\s*\.", sources):
        name = constants.get(name, name.strip('"'))
        labels.setdefault(name, set()).update(re.findall(r'"(\w+)"\s*=>', rest))
        if kind == "histogram":
            for end in ("bucket", "sum", "count"):
                labels.setdefault(f"{name}_{end}", set()).update(labels[name])
    wrong, seen = [], 0
    for place in PLACES:
        text = (ROOT / place).read_text(encoding="utf-8").replace('\\"', '"')
        for name, selector in re.findall(r"\b(meshmend_\w+)(?:\{([^{}]*)\})?", text):
            seen += 1
            if name not in labels:
                wrong.append(f"{place}: there is no metric {name}")
            for label in re.findall(r"(\w+)\s*(?:=~|!~|!=|=)", selector or ""):
                if label not in labels.get(name, ()) and label not in ADDED:
                    wrong.append(f"{place}: {name} has no label {label}")
    if wrong or seen < 30:
        sys.exit("\n".join(wrong) or f"only {seen} names were found")
    print(f"{seen} names of {len(labels)} metrics are right")


main()
