#!/usr/bin/env bash
# Makes what of the clients is made: their types of openapi.yaml, and the synchronous half of the Python client.
#
#   scripts/clients/generate.sh           into clients/
#   scripts/clients/generate.sh FOLDER    into FOLDER, to be compared
#
# Needs target/clients as scripts/test.sh sets it up.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
into=${1:-clients}
python=target/clients/python/bin
source=clients/python/src/meshmend
mkdir -p "$into/python/src/meshmend" "$into/typescript/src"

"$python/python" scripts/clients/schemas.py openapi.yaml >target/clients/schemas.json
"$python/datamodel-codegen" --input target/clients/schemas.json --input-file-type openapi --openapi-scopes schemas \
  --output "$into/python/src/meshmend/types.py" --output-model-type typing.TypedDict --no-use-closed-typed-dict \
  --target-python-version 3.11 --enum-field-as-literal all --use-standard-collections --use-union-operator \
  --use-schema-description --use-field-description --disable-timestamp --formatters ruff-format --strict-refs
target/clients/node/node_modules/.bin/openapi-typescript target/clients/schemas.json --root-types \
  --root-types-no-schema-prefix -o "$into/typescript/src/types.ts"
"$python/python" scripts/clients/without_async.py "$source/_async.py" >"$into/python/src/meshmend/_sync.py"
