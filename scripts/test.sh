#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Needs no display and no GPU. Arguments go to ctest, e.g.
#   scripts/test.sh -R contact
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
scripts/build.sh

# Tests run beside each other, one a core. A software device that took all cores in each of them would only wait for itself.
export LP_NUM_THREADS="${LP_NUM_THREADS:-1}"
exec ctest --test-dir build/release --parallel "$(nproc 2>/dev/null || echo 2)" --output-on-failure "$@"
