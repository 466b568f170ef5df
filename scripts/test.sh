#!/usr/bin/env bash
# Installs what the tests need and runs all of them at their small, fixed-seed size.
#
#   scripts/test.sh              every step
#   scripts/test.sh STEP...      only these (see `steps` below)
#
# Needs Rust (rustup or Debian) and a C compiler; python3 with venv, PostgreSQL, for the step `instructions` Valgrind, for the
# step `clients` Java and Node, and for the step `browser` Chromium and Node, are installed where they are missing and root or
# sudo allows it. Where that is not possible, that step says so and is left out. Everything else lands under target/.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CARGO_TERM_COLOR=${CARGO_TERM_COLOR:-never} CARGO_INCREMENTAL=0 PYTHONDONTWRITEBYTECODE=1
# Settings of the caller's own service must not reach the tests.
for name in $(compgen -e | grep '^MESHMEND_' | grep -v -e '^MESHMEND_CORPUS$'); do unset "$name"; done

steps=(format lint lint_engine build tests instructions doc_tests documentation fixtures contract fuzz_contract clients browser gltf_rules deploy licences)
scratch=target/test-run
python=target/python/bin
server_pid=
server_url=

note() { printf '\n== %s\n' "$*"; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo -n "$@"; else return 1; fi
}

install_packages() {
  echo "installing $*"
  as_root apt-get update -q &&
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "$@"
}

# --- what the tests need -------------------------------------------------------------------------------------------

set_up() {
  command -v cargo >/dev/null || { echo "cargo is missing: install Rust from https://rustup.rs"; return 1; }
  local missing=()
  command -v cc >/dev/null || missing+=(gcc libc6-dev)
  python3 -c 'import venv, ensurepip' 2>/dev/null || missing+=(python3 python3-venv)
  # The tests run every line of docs/http.md.
  command -v curl >/dev/null || missing+=(curl ca-certificates)
  if [ ${#missing[@]} -gt 0 ]; then
    install_packages "${missing[@]}" || { echo "cannot install ${missing[*]}: install them and run this again"; return 1; }
  fi
  # The stores that several servers share are tried on a real database; without it their tests say so and pass.
  if ! ls /usr/lib/postgresql/*/bin/initdb >/dev/null 2>&1; then
    install_packages postgresql || echo "PostgreSQL cannot be installed here: its tests are left out"
  fi
  cmp -s scripts/requirements.txt target/python/requirements.txt && return 0
  rm -rf target/python && python3 -m venv target/python &&
    $python/pip install -q --disable-pip-version-check --retries 5 -r scripts/requirements.txt &&
    cp scripts/requirements.txt target/python/requirements.txt
}

# --- steps ---------------------------------------------------------------------------------------------------------

format() { cargo fmt --check; }
# With every feature: what the features leave out is compiled by `lint_engine` and by `build`.
lint() { cargo clippy --locked --features otel --all-targets -- -D warnings; }
lint_engine() { cargo clippy --locked --no-default-features --all-targets -- -D warnings; }

# The program and all tests, in one go: the library is compiled twice, with unit tests and without, side by side.
build() {
  if command -v cargo-nextest >/dev/null; then
    cargo nextest run --locked --no-run
  else
    cargo test --locked --no-run --lib --bins --tests
  fi
}

tests() {
  if command -v cargo-nextest >/dev/null; then
    cargo nextest run --locked
    local result=$?
    python3 scripts/slowest_tests.py target/nextest/default/tests.xml
    return $result
  fi
  cargo test --locked --no-fail-fast --lib --bins --tests
}
# Instructions of the hot passes, which other work on the machine does not change, beside benches/instructions.json. The
# library is that of the tests.
instructions() {
  command -v valgrind >/dev/null || install_packages valgrind ||
    { echo "not run: Valgrind cannot be installed here"; return 0; }
  cargo bench --locked --profile dev --bench instructions
}
doc_tests() { cargo test --locked --doc; }
documentation() { RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps --lib; }

# Fixtures are made by a script of the project; what is committed must be what it makes.
fixtures() {
  rm -rf "$scratch/fixtures" && mkdir -p "$scratch/fixtures" || return 1
  python3 scripts/make_fixtures.py "$scratch/fixtures" || return 1
  local made
  made=$(cd "$scratch/fixtures" && find . -type f | sort)
  for file in $made; do
    cmp "$scratch/fixtures/$file" "fixtures/$file" || return 1
  done
  echo "$(wc -l <<<"$made") files are as committed"
}

# The committed openapi.yaml is compared with the routes by a test; here it is checked against the OpenAPI rules.
contract() { $python/openapi-spec-validator openapi.yaml; }

# Requests made from openapi.yaml, right and wrong ones, against the built server.
fuzz_contract() {
  start_server || return 1
  $python/schemathesis --config-file tests/service/schemathesis.toml run openapi.yaml --url "$server_url"
  end_server_with $?
}

# Clients that three generators make of openapi.yaml: each repairs a mesh, reads a report, waits for a job, reads events. Then
# those in clients/, which go through one scenario with a difficult neighbour between them and the server.
clients() {
  set_up_clients || { echo "not run: what the generators of clients need cannot be installed here"; return 0; }
  local neighbour_port
  read -r neighbour_port _ < <(free_ports) || return 1
  MESHMEND_WEBHOOKS=true MESHMEND_WEBHOOK_PRIVATE_HOSTS=127.0.0.1:$neighbour_port MESHMEND_WEBHOOK_PAUSE=1s \
    start_server || return 1
  scripts/clients/run.sh "$server_url" && scripts/clients/scenarios.sh "$server_url" "$neighbour_port"
  end_server_with $?
}

# Generators of clients are a jar and scripts.
set_up_clients() {
  local into=target/clients missing=()
  command -v java >/dev/null || missing+=(default-jre-headless)
  command -v npm >/dev/null || missing+=(nodejs npm)
  if [ ${#missing[@]} -gt 0 ]; then
    install_packages "${missing[@]}" || return 1
  fi
  mkdir -p "$into" || return 1
  if ! cmp -s scripts/clients/requirements.txt $into/python/requirements.txt; then
    rm -rf $into/python && python3 -m venv $into/python &&
      $into/python/bin/pip install -q --disable-pip-version-check --retries 5 -r scripts/clients/requirements.txt &&
      cp scripts/clients/requirements.txt $into/python/requirements.txt || return 1
  fi
  if ! cmp -s scripts/clients/package.json $into/node/installed.json; then
    rm -rf $into/node && mkdir -p $into/node && cp scripts/clients/package.json $into/node/ &&
      npm install --prefix $into/node --no-audit --no-fund --silent && cp scripts/clients/package.json $into/node/installed.json || return 1
  fi
}

# The page in a browser without a window, against the built server; its screenshots stay in target/browser/pictures.
browser() {
  set_up_browser || { echo "not run: Chromium or its driver cannot be installed here"; return 0; }
  start_server || return 1
  node tests/browser/run.mjs "$server_url" target/browser/pictures
  end_server_with $?
}

set_up_browser() {
  local into=target/browser missing=()
  command -v chromium >/dev/null || missing+=(chromium)
  command -v npm >/dev/null || missing+=(nodejs npm)
  if [ ${#missing[@]} -gt 0 ]; then
    install_packages "${missing[@]}" || return 1
  fi
  cmp -s tests/browser/package-lock.json $into/installed.json && return 0
  rm -rf $into && mkdir -p $into && cp tests/browser/package*.json $into/ &&
    npm ci --prefix $into --no-audit --no-fund --silent && cp tests/browser/package-lock.json $into/installed.json
}

# What the program writes as glTF, judged by the validator of the standard's makers.
gltf_rules() {
  set_up_gltf_rules || { echo "not run: the validator cannot be installed here"; return 0; }
  rm -rf "$scratch/gltf" && GLTF_VALIDATOR=target/gltf-validator node tests/gltf_rules/run.mjs target/debug/meshmend "$scratch/gltf"
}

set_up_gltf_rules() {
  local into=target/gltf-validator
  if ! command -v npm >/dev/null; then
    install_packages nodejs npm || return 1
  fi
  cmp -s tests/gltf_rules/package-lock.json $into/installed.json && return 0
  rm -rf $into && mkdir -p $into && cp tests/gltf_rules/package*.json $into/ &&
    npm ci --prefix $into --no-audit --no-fund --silent && cp tests/gltf_rules/package-lock.json $into/installed.json
}

# What the image is built from; what deploy/ has, by the tools of those who read it: Helm, the schemas of Kubernetes, promtool; the list of
# the image's parts by the schema of CycloneDX.
deploy() {
  python3 scripts/deploy/names.py && python3 scripts/deploy/image.py || return 1
  set_up_deploy || { echo "the rest is not run: what judges it cannot be installed here"; return 0; }
  target/deploy/python/bin/python scripts/deploy/chart.py target/debug/meshmend || return 1
  target/deploy/python/bin/python scripts/deploy/compose.py target/debug/meshmend || return 1
  python3 scripts/sbom.py >"$scratch/sbom.json" && target/deploy/python/bin/python scripts/deploy/sbom.py <"$scratch/sbom.json" || return 1
  local promtool=target/deploy/prometheus/usr/bin/promtool
  python3 scripts/deploy/expressions.py deploy/monitoring/dashboard.json >"$scratch/dashboard.json" &&
    $promtool check rules deploy/monitoring/alerts.yaml "$scratch/dashboard.json" &&
    $promtool test rules deploy/monitoring/alerts_test.yaml
}

# Prometheus is unpacked only: installed, it would run.
set_up_deploy() {
  local into=target/deploy
  mkdir -p $into || return 1
  if ! cmp -s scripts/deploy/requirements.txt $into/python/requirements.txt; then
    rm -rf $into/python && python3 -m venv $into/python &&
      $into/python/bin/pip install -q --disable-pip-version-check --retries 5 -r scripts/deploy/requirements.txt &&
      cp scripts/deploy/requirements.txt $into/python/requirements.txt || return 1
  fi
  [ -x $into/prometheus/usr/bin/promtool ] && return 0
  command -v dpkg >/dev/null || return 1
  { (cd $into && apt-get download -q prometheus) || { as_root apt-get update -q && (cd $into && apt-get download -q prometheus); }; } &&
    dpkg -x $into/prometheus_*.deb $into/prometheus
}

licences() {
  if command -v cargo-deny >/dev/null; then cargo deny --locked check licenses bans sources; else python3 scripts/licences.py; fi
}

# --- the server under test -----------------------------------------------------------------------------------------

# Starts the built server on free ports; its address is in server_url.
start_server() {
  local port admin_port log=$scratch/server.log data=$scratch/data
  read -r port admin_port < <(free_ports) || return 1
  rm -rf "$data" && mkdir -p "$data" || return 1
  MESHMEND_LISTEN=127.0.0.1:$port MESHMEND_ADMIN_LISTEN=127.0.0.1:$admin_port MESHMEND_DATA_DIR=$data \
    MESHMEND_RATE_PER_MINUTE=0 \
    target/debug/meshmend serve >"$log" 2>&1 &
  server_pid=$!
  server_url=http://127.0.0.1:$port
  wait_until_ready "$admin_port" || { tail -20 "$log"; return 1; }
}

# Stops it, and gives the result of the step, unless the server did not stop cleanly.
end_server_with() {
  stop_server || { echo "the server did not stop cleanly"; tail -20 "$scratch/server.log"; return 1; }
  return "$1"
}

free_ports() {
  python3 - <<'PY'
import socket
sockets = [socket.socket() for _ in range(2)]
for s in sockets:
    s.bind(("127.0.0.1", 0))
print(*(s.getsockname()[1] for s in sockets))
PY
}

wait_until_ready() {
  for _ in $(seq 100); do
    MESHMEND_ADMIN_LISTEN=127.0.0.1:$1 target/debug/meshmend healthcheck >/dev/null 2>&1 && return 0
    kill -0 "$server_pid" 2>/dev/null || return 1
    sleep 0.1
  done
  return 1
}

stop_server() {
  [ -n "$server_pid" ] || return 0
  kill -TERM "$server_pid" 2>/dev/null
  wait "$server_pid"
  local result=$?
  server_pid=
  return $result
}
trap stop_server EXIT

# --- run -----------------------------------------------------------------------------------------------------------

chosen=("${@:-${steps[@]}}")
for step in "${chosen[@]}"; do
  [[ " ${steps[*]} " == *" $step "* ]] || { echo "no step $step; there are: ${steps[*]}"; exit 2; }
done
mkdir -p "$scratch"
summary=()
failures=0
for step in set_up "${chosen[@]}"; do
  note "$step"
  begin=$SECONDS
  if $step </dev/null; then word=ok; else word=FAILED failures=$((failures + 1)); fi
  summary+=("$(printf '%-14s %-7s %4d s' "$step" "$word" $((SECONDS - begin)))")
  [ "$step" = set_up ] && [ "$word" = FAILED ] && break
done
note "summary"
printf '%s\n' "${summary[@]}"
if [ $failures -gt 0 ]; then echo "$failures of ${#summary[@]} steps failed"; exit 1; fi
echo "all ${#summary[@]} steps passed"
