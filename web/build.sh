#!/usr/bin/env bash
# Makes web/bundle/ of web/src/: what the service embeds, committed so that building it needs no Node.
#
#   web/build.sh
#
# Needs Node and npm. The libraries and the bundler are pinned by package-lock.json.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
npm ci --silent --no-audit --no-fund --ignore-scripts

esbuild() { node_modules/.bin/esbuild "$@" --bundle --minify --target=es2022 --legal-comments=none --log-level=warning; }
mkdir -p bundle
# Properties with a leading underscore are private to three.js and get short names; its hook for developer tools is left out.
esbuild src/main.js --format=esm --mangle-props=^_ --define:__THREE_DEVTOOLS__=undefined --outfile=bundle/page.js
# Programs for the graphics card are indented by tabs, which nothing else begins a line with: these go, and comments after them.
sed -i -E '/^\t+\/\//d; s/^\t+//' bundle/page.js
esbuild src/mesh/worker.js --format=iife --outfile=bundle/worker.js
esbuild src/page.css --outfile=bundle/page.css --target=chrome123
{
  echo "page.js holds parts of three.js $(node -p 'require("./node_modules/three/package.json").version'):"
  echo
  cat node_modules/three/LICENSE
} >bundle/LICENCES.txt

# What the bundle was made of; a test compares it with what is there.
find index.html icon.svg package-lock.json build.sh src -type f | LC_ALL=C sort | xargs sha256sum >bundle/sources.sha256
for file in index.html bundle/page.js bundle/worker.js bundle/page.css; do
  printf '%7d bytes  %s\n' "$(gzip -9nc $file | wc -c)" "$file, compressed"
done
