#!/usr/bin/env bash
# scripts/demo.sh with a viewer that only writes pictures: it deletes those of an earlier run when there are new ones,
# and nothing else. check_demo.sh SOURCE
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/scripts" "$work/build/release/bin" "$work/out/demo" "$work/tools"
cp "$1/scripts/demo.sh" "$work/scripts"
printf '#!/bin/sh\n' | tee "$work/scripts/setup.sh" >"$work/scripts/build.sh"
printf '#!/bin/sh\n' >"$work/tools/ffmpeg"
cat >"$work/build/release/bin/viewer" <<'VIEWER'
#!/bin/sh
while [ $# -gt 0 ]; do
  [ "$1" = --out ] && out=$2
  [ "$1" = --fail ] && exit 1
  shift
done
mkdir -p "$out" && touch "$out/frame_0000.png" "$out/frame_0010.png"
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
