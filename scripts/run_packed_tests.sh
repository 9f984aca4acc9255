#!/usr/bin/env bash
# Runs the tests of a pack (scripts/pack_tests.sh), in any folder, on the machine's Vulkan driver, with validation and
# synchronization validation. Uses ctest if it is installed, else runs as many tests at a time as there are cores. Tests
# that the machine cannot run are skipped with the reason. The exit code is 0 if none failed.
#
#   run.sh               all tests
#   run.sh -R contact    the tests whose names have this in them; -E leaves out, -j N: how many at a time
set -euo pipefail
cd "$(dirname "$(realpath "$0")")"
here=$PWD

only='' # extended regular expressions
but=''
jobs=$(nproc 2>/dev/null || echo 2)
[ "${1:-}" != --help ] || set -- -h
while getopts 'R:E:j:h' option; do
  case "$option" in
    R) only=$OPTARG ;;
    E) but=$OPTARG ;;
    j) jobs=$OPTARG ;;
    *)
      awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
      [ "$option" = h ]
      exit
      ;;
  esac
done

seconds_each=300
export LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export VK_LAYER_PATH="$here/layers"
export VOILE_TEST_SOURCES="$here/sources"
export LP_NUM_THREADS="${LP_NUM_THREADS:-0}" # like scripts/test.sh; real drivers ignore it
unset DISPLAY WAYLAND_DISPLAY

[ -f version ] && printf 'version: %s\n' "$(cat version)"
printf 'devices:\n'
bin/viewer --list-devices || { printf 'run: without a device there is nothing to test\n' >&2; exit 1; }

command -v ffmpeg >/dev/null 2>&1 || printf 'ffmpeg is not installed: tests of films are skipped\n'

# Tests left out of packs, with the reason.
not_packed=(
  'window: frames on a virtual display (needs a display)'
  'capture: the frame in RenderDoc (needs RenderDoc)'
  'consumer: install (needs the build folder)'
  'consumer: add_subdirectory (needs a compiler)'
  'consumer: find_package (needs a compiler)'
  'foreign_engine: a sheet falls on a ball (needs ctest, which checks its output)'
  'async_compute: each frame is drawn from its own vertices (needs ctest, which checks its output)'
)

# All tests, one per line: program, tab, name.
list_tests() {
  local program
  for program in bin/test_*; do
    "$program" --list-test-cases --no-version | grep -v -e '^===' -e '^\[doctest\]' | sed "s|^|$program\t|"
  done
}

# doctest splits filters at commas.
filter_of() { printf '%s' "${1//,/\\,}"; }

with_ctest() {
  local program name entry work=$here/ctest
  mkdir -p "$work"
  {
    while IFS=$'\t' read -r program name; do
      printf 'add_test([==[%s:%s]==] [==[%s]==] [==[--test-case=%s]==])\n' "${program#bin/}" "$name" "$here/$program" \
        "$(filter_of "$name")"
      printf 'set_tests_properties([==[%s:%s]==] PROPERTIES TIMEOUT %d SKIP_REGULAR_EXPRESSION "MESSAGE: skipped:" FAIL_REGULAR_EXPRESSION "test cases: +0 [|]")\n' \
        "${program#bin/}" "$name" "$seconds_each"
    done < <(list_tests)
    for entry in "${not_packed[@]}"; do
      printf 'add_test([==[%s]==] /bin/sh -c "exit 77")\n' "$entry"
      printf 'set_tests_properties([==[%s]==] PROPERTIES SKIP_RETURN_CODE 77)\n' "$entry"
    done
  } >"$work/CTestTestfile.cmake"
  cd "$work"
  ctest --parallel "$jobs" --output-on-failure ${only:+-R "$only"} ${but:+-E "$but"}
}

# Runs one test, prints its line and keeps its output.
run_one() {
  local program=${1%%$'\t'*} name=${1#*$'\t'} number=$2 status=0 result=Passed start=$EPOCHREALTIME
  local log=$3/$number
  timeout "$seconds_each" "$program" "--test-case=$(filter_of "$name")" >"$log" 2>&1 </dev/null || status=$?
  if [ "$status" -eq 124 ]; then
    result='***Timeout'
  elif [ "$status" -ne 0 ]; then
    result="***Failed ($status)"
  elif grep -q 'test cases: *0 |' "$log"; then
    result='***Failed (no test of this name)'
  elif grep -q 'MESSAGE: skipped: ' "$log"; then
    result='***Skipped'
  fi
  local line
  line=$(awk -v n="$number" -v name="${program#bin/}:$name" -v result="$result" -v start="$start" -v end="$EPOCHREALTIME" \
    'BEGIN { printf "Test #%d: %s %s %.2f sec", n, name, result, end - start }')
  printf '%s\n' "$line" >"$log.result"
  [ "$result" = Passed ] && printf '%s\n' "$line" || printf '%s\n%s\n' "$line" "$(cat "$log")"
}

without_ctest() {
  local logs number=0 line start=$SECONDS
  logs=$(mktemp -d)
  export -f run_one filter_of
  export seconds_each
  while IFS= read -r line; do
    [[ -z $only || ${line#bin/} =~ $only ]] || continue
    [[ -n $but && ${line#bin/} =~ $but ]] && continue
    number=$((number + 1))
    printf '%s\0%s\0' "$line" "$number"
  done < <(list_tests) | xargs -0 -n 2 -P "$jobs" bash -c 'run_one "$1" "$2" "$0"' "$logs"
  local total failed
  total=$(cat "$logs"/*.result 2>/dev/null | wc -l)
  failed=$(cat "$logs"/*.result 2>/dev/null | grep -c -e '\*\*\*Failed' -e '\*\*\*Timeout' || true)
  printf '\n%d tests passed or skipped, %d tests failed out of %d\n' $((total - failed)) "$failed" "$total"
  printf 'Total Test time (real) = %d sec\n' $((SECONDS - start))
  if grep -qs '\*\*\*Skipped' "$logs"/*.result; then
    printf '\nThe following tests did not run:\n'
    grep -h '\*\*\*Skipped' "$logs"/*.result
  fi
  printf 'Not in the pack: %s\n' "${not_packed[@]}"
  if [ "$failed" -gt 0 ]; then
    printf '\nThe following tests FAILED:\n'
    grep -h -e '\*\*\*Failed' -e '\*\*\*Timeout' "$logs"/*.result
  fi
  rm -rf "$logs"
  [ "$failed" -eq 0 ] && [ "$total" -gt 0 ]
}

if command -v ctest >/dev/null 2>&1; then
  with_ctest
else
  printf 'ctest is not installed: the tests run without it\n'
  without_ctest
fi
