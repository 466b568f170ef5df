"""The Helm chart is without a complaint of Helm's, and what it makes is what Kubernetes takes and what deploy/ promises.

    chart.py PROGRAM

PROGRAM says whether the settings in the pod's environment are settings.
"""

import pathlib
import subprocess
import sys

import kubernetes_validate
import yaml
from helm_python.chart import Chart, lint
from helm_python.errors import HelmError

CHART = pathlib.Path(__file__).resolve().parents[2] / "deploy/helm/meshmend"
KUBERNETES = ["1.27", "1.34"]
KEYS = {"apiKeys": {"secretName": "keys"}}
ACCEPTED = {
    "keys": KEYS,
    "anonymous": {"allowAnonymous": True, "settings": {"allowed_hosts": "mesh.example", "rate_per_minute": 1200000}},
    "everything": {
        **KEYS,
        "image": {"repository": "registry.example/meshmend", "digest": "sha256:" + "0" * 64},
        "imagePullSecrets": [{"name": "registry"}],
        "webhooks": {"enabled": True, "secretName": "hooks"},
        "persistence": {"storageClassName": "fast", "accessModes": ["ReadWriteOncePod"]},
        "serviceMonitor": {"enabled": True, "labels": {"release": "prometheus"}},
        "networkPolicy": {"clients": [{"namespaceSelector": {}}], "monitoring": [{"namespaceSelector": {}}]},
        "podAnnotations": {"note": "a"}, "podLabels": {"team": "a"}, "nodeSelector": {"disk": "fast"},
        "tolerations": [{"key": "a", "operator": "Exists"}], "priorityClassName": "high",
    },
}
REFUSED = {
    "no keys": {},
    "a setting that the chart makes": {**KEYS, "settings": {"listen": "0.0.0.0:1"}},
    "a name that is none": {**KEYS, "persistance": {}},
    "a grace that is too short": {**KEYS, "terminationGracePeriodSeconds": 5},
}


def main(program):
    for name, values in ACCEPTED.items():
        report = lint(CHART, values, strict=True)
        # That there is no icon is told as information (1).
        wrong = [message for message in report["messages"] if message["severity"] > 1]
        if wrong or report["errors"]:
            sys.exit(f"{name}: {wrong} {report['errors']}")
        made = rendered(values)
        for document in made:
            # A kind of the Prometheus operator, of which Kubernetes has no schema.
            if document["kind"] != "ServiceMonitor":
                for version in KUBERNETES:
                    kubernetes_validate.validate(document, version, strict=True)
        environment = check_pod(next(document for document in made if document["kind"] == "StatefulSet"))
        check = subprocess.run([program, "config", "check", "--strict"], env=environment, capture_output=True, text=True)
        if check.returncode:
            sys.exit(f"{name}: {check.stdout}{check.stderr}")
        kinds = {document["kind"] for document in made}
        if not {"NetworkPolicy", "PodDisruptionBudget", "Service"} <= kinds or ("ServiceMonitor" in kinds) != (name == "everything"):
            sys.exit(f"{name}: it makes {kinds}")
    for name, values in REFUSED.items():
        try:
            rendered(values)
        except HelmError:
            continue
        sys.exit(f"{name} is taken")
    print(f"{len(ACCEPTED)} sets of values are taken, {len(REFUSED)} refused")


def rendered(values):
    with Chart.load(CHART) as chart:
        chart.validate_schema(values)
        manifests = chart.render(values, name="shop")
    return [document for text in manifests.values() for document in yaml.safe_load_all(text) if document]


def check_pod(document):
    """No root, no rights, nothing in the environment that Kubernetes puts there, and time to drain. Gives its environment."""
    pod = document["spec"]["template"]["spec"]
    container = pod["containers"][0]
    environment = {entry["name"]: entry["value"] for entry in container["env"]}
    promises = {
        "one owner of the store": document["spec"]["replicas"] == 1,
        "no service links": pod["enableServiceLinks"] is False,
        "no token": pod["automountServiceAccountToken"] is False,
        "no root": pod["securityContext"]["runAsNonRoot"] is True,
        "no rights": container["securityContext"]["capabilities"] == {"drop": ["ALL"]},
        "a file system that is read": container["securityContext"]["readOnlyRootFilesystem"] is True,
        "probes on the admin port": {container[f"{kind}Probe"]["httpGet"]["port"] for kind in ("liveness", "readiness", "startup")} == {"admin"},
        "time to drain": pod["terminationGracePeriodSeconds"] > 25,
        "keys or everybody": ("MESHMEND_API_KEYS_FILE" in environment) != ("MESHMEND_ALLOW_ANONYMOUS" in environment),
        "plain numbers": environment.get("MESHMEND_RATE_PER_MINUTE") in (None, "1200000"),
    }
    broken = [promise for promise, holds in promises.items() if not holds]
    if broken:
        sys.exit(f"the pod does not hold: {broken}")
    return environment


main(*sys.argv[1:])
