#!/usr/bin/env bash
# Installs missing packages, builds, and runs the tests. Needs no display and no GPU.
#
#   scripts/test.sh                all tests
#   scripts/test.sh --quick        some cases of every subject (tests/quick_cases.cmake), in under 3 minutes on two cores
#   scripts/test.sh --help         prints this
#   scripts/test.sh [--quick] ...  other arguments go to ctest, e.g. -R contact
#
# The exit code is ctest's.
set -euo pipefail
cd "$(dirname "$0")/.."

quick_seconds=180
selection=()
arguments=()
for argument in "$@"; do
  case "$argument" in
    --help | -h)
      awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' scripts/test.sh
      exit 0
      ;;
    --quick) selection=(--label-regex '^quick$') ;;
    *) arguments+=("$argument") ;;
  esac
done

scripts/setup.sh
scripts/build.sh

# One test per core runs at a time, so a software device gets no threads of its own: its kernels run on the thread that
# submits them.
export LP_NUM_THREADS="${LP_NUM_THREADS:-0}"
SECONDS=0
status=0
ctest --test-dir build/release --parallel "$(nproc 2>/dev/null || echo 2)" --output-on-failure \
  ${selection[@]+"${selection[@]}"} ${arguments[@]+"${arguments[@]}"} || status=$?
if [ "${#selection[@]}" -gt 0 ] && [ "$SECONDS" -gt "$quick_seconds" ]; then
  printf 'test: the quick cases took %d s; on two idle cores they should take under %d\n' \
    "$SECONDS" "$quick_seconds" >&2
fi
exit "$status"
