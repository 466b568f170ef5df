"""The Helm chart is without a complaint of Helm's, and what it makes is what Kubernetes takes and what deploy/ promises.

    chart.py PROGRAM

PROGRAM says whether the settings in the pod's environment are settings.
"""

import base64
import pathlib
import subprocess
import sys
import tempfile

import kubernetes_validate
import yaml
from helm_python.chart import Chart, lint
from helm_python.errors import HelmError

# What stands in the files that secrets become.
FILES = {
    "MESHMEND_API_KEYS_FILE": "a key of this test\n",
    "MESHMEND_DATABASE_PASSWORD_FILE": "open\n",
    "MESHMEND_BLOBS_KEY_FILE": "id\nsecret\n",
    "MESHMEND_STORE_KEY_FILE": "",
    "MESHMEND_WEBHOOK_SECRET_FILE": f"whsec_{base64.b64encode(bytes(32)).decode()}\n",
}
CHART = pathlib.Path(__file__).resolve().parents[2] / "deploy/helm/meshmend"
KUBERNETES = ["1.27", "1.34"]
KEYS = {"apiKeys": {"secretName": "keys"}}
SHARED = {
    "enabled": True, "databaseUrl": "postgresql://meshmend@db.example/meshmend", "databasePassword": {"secretName": "db"},
    "blobsUrl": "s3://meshes/shop", "blobsEndpoint": "https://s3.example", "blobsKey": {"secretName": "bucket"},
}
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
    "several": {**KEYS, "shared": SHARED},
    "everything of several": {
        **KEYS,
        "shared": {**SHARED, "storeKey": {"secretName": "store"}},
        "webhooks": {"enabled": True, "secretName": "hooks"},
        "keda": {"enabled": True, "prometheus": "http://prometheus:9090"},
        "networkPolicy": {"stores": {"to": [{"namespaceSelector": {}}]}},
    },
}
REFUSED = {
    "no keys": {},
    "a setting that the chart makes": {**KEYS, "settings": {"listen": "0.0.0.0:1"}},
    "a name that is none": {**KEYS, "persistance": {}},
    "one of two stores": {**KEYS, "shared": {**SHARED, "blobsUrl": ""}},
    "a password for all to read": {**KEYS, "shared": {**SHARED, "databaseUrl": "postgresql://meshmend:open@db.example/meshmend"}},
    "webhooks whose secrets no other server could read": {**KEYS, "shared": SHARED, "webhooks": {"enabled": True}},
    "one node that becomes several": {**KEYS, "keda": {"enabled": True, "prometheus": "http://prometheus:9090"}},
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
            # Kinds of the Prometheus operator and of KEDA, of which Kubernetes has no schema.
            if document["kind"] not in ("ServiceMonitor", "ScaledObject"):
                for version in KUBERNETES:
                    kubernetes_validate.validate(document, version, strict=True)
        pods = [document for document in made if document["kind"] in ("StatefulSet", "Deployment")]
        for environment in map(check_pod, pods):
            check = checked(program, environment)
            if check.returncode:
                sys.exit(f"{name}: {check.stdout}{check.stderr}")
        kinds = {document["kind"] for document in made}
        if not {"NetworkPolicy", "PodDisruptionBudget", "Service"} <= kinds or ("ServiceMonitor" in kinds) != (name == "everything"):
            sys.exit(f"{name}: it makes {kinds}")
        if ("ScaledObject" in kinds) != (name == "everything of several"):
            sys.exit(f"{name}: it makes {kinds}")
        check_selectors(name, pods, made)
    for name, values in REFUSED.items():
        try:
            rendered(values)
        except HelmError:
            continue
        sys.exit(f"{name} is taken")
    print(f"{len(ACCEPTED)} sets of values are taken, {len(REFUSED)} refused")


def checked(program, environment):
    """What the program says about the settings of a pod, whose files are here for as long as that takes."""
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(environment)
        for name in FILES.keys() & environment.keys():
            file = pathlib.Path(folder, name)
            file.write_text(FILES[name])
            environment[name] = str(file)
        return subprocess.run([program, "config", "check", "--strict"], env=environment, capture_output=True, text=True)


def rendered(values):
    with Chart.load(CHART) as chart:
        chart.validate_schema(values)
        manifests = chart.render(values, name="shop")
    return [document for text in manifests.values() for document in yaml.safe_load_all(text) if document]


def check_selectors(name, pods, made):
    """Every pod has a policy and a budget of its own, and the service of requests finds exactly those that take them."""
    labels = {pod["metadata"]["name"]: pod["spec"]["template"]["metadata"]["labels"] for pod in pods}
    if len(pods) != (2 if "several" in name else 1):
        sys.exit(f"{name}: it makes {list(labels)}")

    def found(selector):
        return {pod for pod, own in labels.items() if selector.items() <= own.items()}

    for document in made:
        selector = document["spec"].get("podSelector" if document["kind"] == "NetworkPolicy" else "selector", {})
        if document["kind"] in ("NetworkPolicy", "PodDisruptionBudget") and len(found(selector["matchLabels"])) != 1:
            sys.exit(f"{name}: {document['kind']} {document['metadata']['name']} is one of {found(selector['matchLabels'])}")
        if document["kind"] == "Service" and not document["metadata"]["name"].endswith("-admin"):
            if any("worker" in pod for pod in found(selector)) or len(found(selector)) != 1:
                sys.exit(f"{name}: the service leads to {found(selector)}")


def check_pod(document):
    """No root, no rights, nothing in the environment that Kubernetes puts there, and time to drain. Gives its environment."""
    pod = document["spec"]["template"]["spec"]
    container = pod["containers"][0]
    environment = {entry["name"]: entry["value"] for entry in container["env"]}
    promises = {
        "one owner of the store": document["kind"] == "Deployment" or document["spec"]["replicas"] == 1,
        "shared stores for several": (document["kind"] == "Deployment") == ("MESHMEND_DATABASE_URL" in environment),
        "no service links": pod["enableServiceLinks"] is False,
        "no token": pod["automountServiceAccountToken"] is False,
        "no root": pod["securityContext"]["runAsNonRoot"] is True,
        "no rights": container["securityContext"]["capabilities"] == {"drop": ["ALL"]},
        "a file system that is read": container["securityContext"]["readOnlyRootFilesystem"] is True,
        "probes on the admin port": {container[f"{kind}Probe"]["httpGet"]["port"] for kind in ("liveness", "readiness", "startup")} == {"admin"},
        "time to drain": pod["terminationGracePeriodSeconds"] > 25,
        "keys or everybody, where requests are taken": environment["MESHMEND_ROLE"] == "worker" or ("MESHMEND_API_KEYS_FILE" in environment) != ("MESHMEND_ALLOW_ANONYMOUS" in environment),
        "plain numbers": environment.get("MESHMEND_RATE_PER_MINUTE") in (None, "1200000"),
    }
    broken = [promise for promise, holds in promises.items() if not holds]
    if broken:
        sys.exit(f"the pod does not hold: {broken}")
    return environment


main(*sys.argv[1:])
