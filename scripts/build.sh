#!/usr/bin/env bash
# Configures and builds the release preset in build/release; up-to-date files are kept. Arguments are the targets
# (default: everything). The output goes to a log, which is shown if something fails.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build
log=build/build.log

quietly() {
  "$@" >"$log" 2>&1 || {
    tail -n 60 "$log" >&2
    printf 'build: "%s" failed; the whole output is in %s\n' "$*" "$log" >&2
    exit 1
  }
}

# Memory also bounds the number of jobs: a compiler takes up to 1 GiB.
memory=$(awk '/MemAvailable/ { print int($2 / 1048576) }' /proc/meminfo 2>/dev/null || echo 4)
cores=$(nproc 2>/dev/null || echo 2)
jobs=$((memory < cores ? (memory < 1 ? 1 : memory) : cores))

targets=()
for target in "$@"; do targets+=(--target "$target"); done
[ -f build/release/build.ninja ] || printf 'build: configuring\n'
quietly cmake --preset release
printf 'build: building with %d jobs, which takes minutes the first time; its output goes to %s\n' "$jobs" "$log"
quietly cmake --build --preset release --parallel "$jobs" ${targets[@]+"${targets[@]}"}
