#!/usr/bin/env bash
# The clients in clients/: what is made in them is as committed, their types hold, and one scenario runs with each of them,
# and the programs of their READMEs.
#
#   scripts/clients/scenarios.sh URL NEIGHBOUR_PORT
#
# The server at URL must send webhooks to 127.0.0.1:NEIGHBOUR_PORT. Needs target/clients as scripts/test.sh sets it up; what is
# made lands there. The scenario in a browser is left out where there is no Chromium.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
url=$1 port=$2
here=http://127.0.0.1:$port
tools=$PWD/target/clients/python/bin
modules=$PWD/target/clients/node/node_modules
run=$PWD/target/clients/scenario
source=$PWD/scripts/clients
rm -rf "$run" && mkdir -p "$run/made" "$run/folder" "$run/files" "$run/printed"

# --- what is made of the contract
scripts/clients/generate.sh "$run/made" >"$run/generate.log" 2>&1 || { cat "$run/generate.log"; exit 1; }
for file in python/src/meshmend/types.py python/src/meshmend/_sync.py typescript/src/types.ts; do
  cmp "$run/made/$file" "clients/$file" || { echo "clients/$file is not up to date: run scripts/clients/generate.sh"; exit 1; }
done

# --- Python: installed as a user does it, with nothing but what it asks for
python3 -m venv "$run/python"
"$run/python/bin/pip" install -q --disable-pip-version-check --retries 5 -c scripts/clients/requirements.txt ./clients/python
mkdir "$run/programs"
cp "$source/scenario_async.py" "$run/programs/"
"$tools/python" "$source/without_async.py" "$source/scenario_async.py" >"$run/programs/scenario_sync.py"
"$tools/python" "$source/readme_blocks.py" clients/python/README.md python "$url" "$run/programs" py
"$tools/mypy" --python-executable "$run/python/bin/python" --cache-dir target/clients/mypy --strict clients/python/src
for program in "$run"/programs/*.py; do
  "$tools/mypy" --python-executable "$run/python/bin/python" --cache-dir target/clients/mypy --strict "$program" >"$run/mypy.log" ||
    { cat "$run/mypy.log"; exit 1; }
done

# --- TypeScript: packed, and installed from the package
cp -r clients/typescript "$run/typescript"
rm -rf "$run/typescript/node_modules" "$run/typescript/dist"
ln -s "$modules" "$run/typescript/node_modules"
(cd "$run/typescript" && npm pack --silent --pack-destination "$run" >/dev/null)
mkdir "$run/node"
echo '{"private":true,"type":"module"}' >"$run/node/package.json"
cp "$source"/scenario*.ts "$source/tsconfig.json" "$run/node/"
"$tools/python" "$source/readme_blocks.py" clients/typescript/README.md ts "$url" "$run/node" ts
npm install --prefix "$run/node" --no-audit --no-fund --silent "$run"/meshmend-*.tgz
[ "$(ls "$run/node/node_modules")" = meshmend ] || { echo "the package brings others along"; exit 1; }
ln -s "$modules/@types" "$modules/undici-types" "$run/node/node_modules/"
"$modules/.bin/tsc" -p "$run/node"

# --- the neighbour, and what the page in a browser loads from it
python3 "$source/slow_mesh.py" 300 "$run/folder/slow.stl"
cp -r fixtures "$run/folder/slow.stl" "$source/scenario.html" "$run/node/"scenario*.js "$run/files/"
cp -r "$run/node/node_modules/meshmend/dist" "$run/files/meshmend"
python3 "$source/neighbour.py" "$port" "$url" "$run/files" 2>"$run/neighbour.log" &
processes=($!)
trap 'kill "${processes[@]}" 2>/dev/null || true; wait' EXIT
for _ in $(seq 100); do curl -sf "$here/nobody/asked" >/dev/null && break; sleep 0.1; done

# --- the scenario, with each of them; only what hangs meets the time limit
timeout 300 "$run/python/bin/python" "$run/programs/scenario_async.py" "$here" python-async fixtures "$run/folder" | tee "$run/printed/python-async"
timeout 300 "$run/python/bin/python" "$run/programs/scenario_sync.py" "$here" python-sync fixtures "$run/folder" >"$run/printed/python-sync"
timeout 300 node "$run/node/scenario_node.js" "$here" node fixtures "$run/folder" >"$run/printed/node"
names=(python-async python-sync node)
for name in python-sync node; do diff "$run/printed/python-async" "$run/printed/$name"; done
if command -v chromium >/dev/null; then
  timeout 300 chromium --headless --no-sandbox --disable-gpu --no-first-run --user-data-dir="$run/chromium" \
    "$here/files/scenario.html#browser" >"$run/chromium.log" 2>&1 &
  processes+=($!)
  for _ in $(seq 600); do
    curl -sf "$here/browser/printed" >"$run/printed/browser" && [ -s "$run/printed/browser" ] && break
    sleep 0.5
  done
  diff <(grep -v '^streamed: ' "$run/printed/python-async") "$run/printed/browser"
  names+=(browser)
else
  echo "not run in a browser: there is no chromium"
fi
"$tools/python" "$source/all_asked.py" openapi.yaml "$here" "${names[@]}"
echo "the same lines from ${names[*]}"

# --- what the READMEs show
cp fixtures/valid/two_parts.stl "$run/programs/part.stl"
cp fixtures/valid/two_parts.stl "$run/node/part.stl"
for program in "$run"/programs/readme_*.py; do
  (cd "$run/programs" && "$run/python/bin/python" "$program" >"$program.log" && rm repaired.stl)
done
for program in "$run"/node/readme_*.js; do
  (cd "$run/node" && node "$program" >"$program.log" && rm repaired.stl)
done
echo "the programs of both READMEs run"
