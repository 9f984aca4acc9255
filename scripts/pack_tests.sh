#!/usr/bin/env bash
# Packs the tests of build/release into one archive, to run them on another machine, such as one with a GPU but without
# a compiler and the packages. Build first (scripts/build.sh). The other machine needs bash, tar with xz, glibc and
# libstdc++ as new as this one's, and a Vulkan driver with its loader.
#
#   scripts/pack_tests.sh [FILE]    default: build/tests.tar.xz
#
# There:   tar xf tests.tar.xz && voile_tests/run.sh
set -euo pipefail
case "${1:-}" in
  -h | --help)
    awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
    exit 0
    ;;
  -*)
    printf 'pack_tests: there is no option %s; see --help\n' "$1" >&2
    exit 1
    ;;
esac
cd "$(dirname "$0")/.."

archive=$(realpath -m "${1:-build/tests.tar.xz}")
most_bytes=$((40 * 1024 * 1024))
programs=build/release/bin
layer_name=VkLayer_khronos_validation

fail() {
  printf 'pack_tests: %s\n' "$*" >&2
  exit 1
}

ls "$programs"/test_* >/dev/null 2>&1 || fail "there are no tests in $programs; run scripts/build.sh"
[ -d build/release/scenes ] || fail 'there are no scenes in build/release/scenes; run scripts/build.sh'

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
pack=$work/voile_tests
mkdir -p "$pack"/{bin,lib,layers,sources/tests,sources/samples,sources/docs}

# The tests that ctest lists: a build folder keeps programs of deleted tests.
mapfile -t tests < <(sed -n 's/^set(subjects \(.*\))$/\1/p' build/release/tests/cases.cmake | tr ';' '\n' | sort -u)
for program in "${tests[@]}" viewer hello_cloth own_component skinned batch async_compute foreign_engine; do
  [ -x "$programs/$program" ] || fail "$programs/$program is not built; run scripts/build.sh"
  strip --strip-all -o "$pack/bin/$program" "$programs/$program"
done

# Libraries without the C and C++ runtimes, which every machine has.
for program in "$pack"/bin/*; do
  ldd "$program"
done | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' | sort -u |
  grep -vE '/(ld-linux.*|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+)\.so\.[0-9]+)$' | xargs -r -I{} cp -L {} "$pack/lib/"

# The validation layer, with a manifest that finds it beside itself.
manifest=''
for folder in /usr/local/share /etc /usr/share; do
  [ ! -f "$folder/vulkan/explicit_layer.d/$layer_name.json" ] || manifest=$folder/vulkan/explicit_layer.d/$layer_name.json
done
[ -n "$manifest" ] || fail 'the validation layer is not installed; run scripts/setup.sh'
library=$(find /usr/lib /usr/local/lib -name "lib$layer_name.so" -print -quit)
[ -n "$library" ] || fail "lib$layer_name.so was not found"
cp -L "$library" "$pack/layers/"
sed 's|"library_path": *"[^"]*"|"library_path": "./lib'"$layer_name"'.so"|' "$manifest" >"$pack/layers/$layer_name.json"

cp -r build/release/scenes "$pack/scenes"
cp -r tests/golden "$pack/sources/tests/golden"
cp -r shaders "$pack/sources/shaders"
cp docs/buffers.md docs/frames.svg "$pack/sources/docs/"
mkdir -p "$pack/sources/bench"
cp -r bench/results "$pack/sources/bench/results"
cp -r samples/scenes "$pack/sources/samples/scenes"
cp scripts/run_packed_tests.sh "$pack/run.sh"
git log -1 --format='%h %s' >"$pack/version" 2>/dev/null || true

mkdir -p "$(dirname "$archive")"
tar -C "$work" -cf - voile_tests | xz -T0 -6 >"$archive"
bytes=$(stat -c %s "$archive")
printf 'pack_tests: %s, %d programs, %.1f MiB\n' "$archive" "${#tests[@]}" "$(awk "BEGIN { print $bytes / 1048576 }")"
[ "$bytes" -le "$most_bytes" ] || fail "the archive is larger than $((most_bytes / 1048576)) MiB"
