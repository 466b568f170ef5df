"""The list of what the program is made of (scripts/sbom.py), read from standard input, is a CycloneDX document and names every part once."""

import json
import sys

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

text = sys.stdin.read()
if error := JsonStrictValidator(SchemaVersion.V1_5).validate_str(text):
    sys.exit(f"not CycloneDX: {error}")
document = json.loads(text)
components = document["components"]
references = [component["bom-ref"] for component in components]
if len(set(references)) != len(references):
    sys.exit("a part is named twice")
if bare := [component["name"] for component in components if not component.get("licenses") or not component.get("hashes")]:
    sys.exit(f"without a licence or a digest: {', '.join(bare)}")
needed = {name for entry in document["dependencies"] for name in entry["dependsOn"]}
if needed != set(references):
    sys.exit(f"needed and not named, or the other way round: {needed ^ set(references)}")
# Parts that only build or test the program, and one that is in it.
if {"proptest", "serde_derive", "cc"} & {component["name"] for component in components} or "tokio" not in {component["name"] for component in components}:
    sys.exit("not what is compiled into the program")
print(f"{len(components)} parts, each with its licence and digest")
