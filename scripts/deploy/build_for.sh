#!/bin/sh
# Builds the program of a release for a processor, here on Debian, whatever processor this one is: for the image.
#
#   build_for.sh ARCHITECTURE FILE    the architecture as images name it: amd64, arm64; empty: this one
set -eu

here=$(dpkg --print-architecture)
wanted=${1:-$here}
case "$wanted" in
  amd64) cpu=x86_64 ;;
  arm64) cpu=aarch64 ;;
  *) echo "no image is made for the processor '$wanted': amd64 and arm64 are known" >&2; exit 2 ;;
esac
target=$cpu-unknown-linux-gnu
if [ "$wanted" != "$here" ]; then
  # The C parts (SQLite, cryptography) need a compiler for it, and Rust its standard library.
  tools=$cpu-linux-gnu
  package=gcc-$(echo "$tools" | tr _ -)
  if ! command -v "$tools-gcc" > /dev/null; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends "$package" "libc6-dev-$wanted-cross" > /dev/null
  fi
  [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || rustup target add "$target"
  name=$(echo "$target" | tr - _)
  linker=CARGO_TARGET_$(echo "$name" | tr '[:lower:]' '[:upper:]')_LINKER
  export "CC_$name=$tools-gcc" "AR_$name=$tools-ar" "$linker=$tools-gcc"
fi
cargo build --release --locked --bin meshmend --target "$target"
cp "target/$target/release/meshmend" "$2"
