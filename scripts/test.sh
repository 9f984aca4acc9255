#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Needs no display and no GPU. Arguments go to ctest, e.g.
#   scripts/test.sh -R contact
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
scripts/build.sh
exec ctest --test-dir build/release --output-on-failure "$@"
