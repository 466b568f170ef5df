#!/usr/bin/env bash
# Makes clients of openapi.yaml with three generators; each uses the server.
#
#   scripts/clients/run.sh URL
#
# Needs target/clients as scripts/test.sh sets it up; what is made lands in target/clients/made.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
url=$1
python=$PWD/target/clients/python/bin
node=$PWD/target/clients/node/node_modules
made=$PWD/target/clients/made
mesh=$PWD/fixtures/valid/cube.off
rm -rf "$made" && mkdir -p "$made/typescript"

"$python/python" scripts/clients/yaml_1_1.py openapi.yaml "$url"

# A warning is a part of the contract that the generator leaves out, so it is shown.
"$python/openapi-python-client" generate --path openapi.yaml --meta none --output-path "$made/meshmend_client"
PYTHONPATH=$made "$python/python" scripts/clients/with_openapi_python_client.py "$url" "$mesh"

"$python/openapi-generator-cli" generate -g python -i openapi.yaml -o "$made/generated" \
  --package-name meshmend_generated --global-property apiTests=false,modelTests=false,apiDocs=false,modelDocs=false \
  >"$made/openapi-generator.log" 2>&1 || { tail -20 "$made/openapi-generator.log"; exit 1; }
PYTHONPATH=$made/generated "$python/python" scripts/clients/with_openapi_generator.py "$url" "$mesh"

cd "$made/typescript"
ln -s "$node" node_modules
cp ../../../../scripts/clients/with_openapi_typescript.ts .
echo '{"type":"module"}' >package.json
node_modules/.bin/openapi-typescript ../../../../openapi.yaml -o schema.d.ts
node_modules/.bin/tsc --strict --skipLibCheck --target es2022 --module nodenext --moduleResolution nodenext \
  --types node with_openapi_typescript.ts
node with_openapi_typescript.js "$url" "$mesh"
