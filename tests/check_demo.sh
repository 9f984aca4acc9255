#!/usr/bin/env bash
# scripts/demo.sh with a viewer that only writes pictures and films: it deletes pictures of an earlier run when there are
# new ones, and nothing else, and makes a film of 20 seconds. check_demo.sh SOURCE
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/scripts" "$work/build/release/bin" "$work/out/demo" "$work/tools"
cp "$1/scripts/demo.sh" "$work/scripts"
printf '#!/bin/sh\n' | tee "$work/scripts/setup.sh" >"$work/scripts/build.sh"
cat >"$work/tools/ffmpeg" <<'FFMPEG'
#!/bin/sh
for film; do :; done
[ -z "${BROKEN_FFMPEG:-}" ] && printf 'film' >"$film"
FFMPEG
cat >"$work/build/release/bin/viewer" <<'VIEWER'
#!/bin/sh
out= video= frames=0 scene=$1
while [ $# -gt 0 ]; do
  [ "$1" = --out ] && out=$2
  [ "$1" = --video ] && video=$2
  [ "$1" = --frames ] && frames=$2
  [ "$1" = --fail ] && exit 1
  shift
done
[ -z "$video" ] || echo "$scene $frames" >>"${0%/*}/films"
[ -z "$out" ] || { mkdir -p "$out" && touch "$out/frame_0000.png" "$out/frame_0010.png"; }
VIEWER
chmod +x "$work"/scripts/*.sh "$work"/tools/* "$work/build/release/bin/viewer"
export PATH="$work/tools:$PATH"
unset DISPLAY WAYLAND_DISPLAY
old="$work/out/demo/frame_0290.png"
touch -d '1 hour ago' "$old" "$work/out/demo/frame_0010.png"

fail() { echo "failed: $1" >&2; exit 1; }
"$work/scripts/demo.sh" --fail && fail 'the exit code of the viewer'
[ -f "$old" ] || fail 'a run that fails deletes pictures'
"$work/scripts/demo.sh" --out "$work/elsewhere"
[ -f "$work/elsewhere/frame_0000.png" ] || fail 'pictures in --out'
[ -f "$old" ] || fail 'a run with --out deletes pictures of out/demo'
"$work/scripts/demo.sh"
[ -f "$work/out/demo/frame_0010.png" ] || fail 'new pictures'
[ ! -f "$old" ] || fail 'pictures of an earlier run stay'

"$work/scripts/demo.sh" --help | grep -q -- '--film ' || fail 'the help'
films="$work/build/release/bin/films" # scene and frames, at 60 per second
rm -f "$films"
"$work/scripts/demo.sh" --frames 0
[ ! -f "$films" ] || fail 'a film without frames'
"$work/scripts/demo.sh" --film
[ -s "$work/out/demo/voile.mp4" ] || fail 'no film'
[ "$(awk '{ seconds += $2 / 60 } END { print seconds }' "$films")" = 20 ] || fail 'the film has not 20 seconds'
while read -r scene _; do
  [ -f "$1/samples/scenes/$scene.json" ] || fail "there is no scene $scene"
done <"$films"
printf 'old' >"$work/out/demo/voile.mp4"
"$work/scripts/demo.sh" --film --fail && fail 'the exit code of a part of the film'
BROKEN_FFMPEG=1 "$work/scripts/demo.sh" --film && fail 'the exit code of ffmpeg'
[ "$(cat "$work/out/demo/voile.mp4")" = old ] || fail 'a film that fails replaces an earlier one'
