#!/usr/bin/env bash
# Runs the tests of one campaign at their full counts and writes the table to docs/campaigns/NAME.md.
#
#   scripts/campaign.sh NAME          one of the names below
#   scripts/campaign.sh kill PART     part 1, 2, ... of a campaign of more cycles, each with random numbers of its own
#
# A campaign is a filter on test names; the tests print their figures as lines that begin with `| `.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

declare -A filters=(
  [certificate]="certificate"
  [predicates]="predicates"
  [contacts]="contacts"
  [formats]="formats"
  [analysis]="analysis"
  [repair]="repair"
  [corpus]="corpus"
  [cancel]="cancel"
  [determinism]="determinism"
  [simplify]="simplify"
  [cut]="cut_and_stitch"
  [modeller]="modeller_"
  [wrap]="bad_soup"
  [injected]="injected_defect"
  [arrangement]="arrangement::tests"
  [random-holes]="random_holes"
  [kill]="killed_at_random_points"
  [claims]="claims_at_a_steady_pace"
)

# Where the tests of a campaign are, when not everywhere: the rest is not built.
declare -A places=(
  [modeller]="--test properties"
  [wrap]="--test properties"
  [arrangement]="--lib"
  [random-holes]="--test properties"
  [kill]="--test service"
  [claims]="--lib"
)

# Campaigns that are scripts and print their page: of those against a running service each starts its own server on loopback.
declare -A scripts=(
  [slow-connections]="slow_connections.py"
  [disk-full]="disk_full.py"
  [overload]="overload.py"
  [overhead]="overhead.py"
  [restarts]="restarts.py"
  [service-cancel]="cancel.py"
  [uploads]="uploads.py"
  [holes-bench]="holes.py"
  [hostile]="hostile.py"
  [neighbours]="neighbours.py"
  [holes-speed]="holes_speed.py"
  [stores]="stores.py"
  [stores-cut]="stores.py --lines --cycles 100"
  [versions]="versions.py"
  [sleepers]="sleepers.py"
  [processors]="processors.py"
  [fuzz]="fuzz.py"
  [migration-kill]="migration_kill.py"
)

# What a script needs beside the program.
declare -A programs=(
  [stores]="--example s3_server"
  [stores-cut]="--example s3_server"
  [versions]="--example s3_server"
  [sleepers]="--example s3_server --example sleeper"
  [migration-kill]="--example s3_server"
)

name=${1:-}
script=${scripts[$name]:-}
if [ -n "$script" ]; then
  shift
  mkdir -p docs/campaigns target
  read -ra more <<< "${programs[$name]:-}"
  # The fuzz targets are built by their script.
  [ "$name" = fuzz ] || cargo build --release --locked --bins "${more[@]}"
  result=0
  # A page that is begun and not ended is not kept.
  read -ra command <<< "$script"
  python3 "experiments/${command[0]}" "${command[@]:1}" "$@" > "target/campaign-$name.md" || result=$?
  [ -s "target/campaign-$name.md" ] && cp "target/campaign-$name.md" "docs/campaigns/$name.md" && echo "wrote docs/campaigns/$name.md"
  exit $result
fi
filter=${filters[$name]:-}
if [ -z "$filter" ]; then
  echo "usage: scripts/campaign.sh NAME, where NAME is one of: $(printf '%s\n' "${!filters[@]}" "${!scripts[@]}" | sort | tr '\n' ' ')" >&2
  exit 2
fi

part=${2:-}
[[ "$part" =~ ^([1-9][0-9]*)?$ ]] || { echo "PART is a number from 1 on, not $part" >&2; exit 2; }
page=$name${part:+-$part}
commit=$(git rev-parse --short HEAD)
[ -z "$(git status --porcelain)" ] || commit="$commit with local changes"
log=target/campaign-$page.log
mkdir -p docs/campaigns target
begin=$SECONDS
result=passed
read -ra place <<< "${places[$name]:---lib --tests}"
MESHMEND_CAMPAIGN=${part:-1} cargo test --release --locked --no-fail-fast "${place[@]}" -- "$filter" --nocapture --test-threads=1 \
  2>&1 | tee "$log" || result=FAILED

{
  echo "# Campaign \`$name\`"
  echo
  echo "Made by \`scripts/campaign.sh $name${part:+ $part}\` at commit $commit: $result in $((SECONDS - begin)) s on $(nproc) cores."
  echo "Seeds are fixed in the tests."
  echo
  grep -h '^| ' "$log" || true
  echo
  echo '```'
  grep -hE '^test .* \.\.\. |^test result: .* [1-9][0-9]* passed|^test result: FAILED' "$log" | sed -E 's/; finished in .*//' || true
  echo '```'
} > "docs/campaigns/$page.md"
echo "wrote docs/campaigns/$page.md"
[ "$result" = passed ]
