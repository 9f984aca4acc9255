#!/usr/bin/env bash
# Installs missing packages, builds, and shows the reference scene: in a window if there is a display, else as a film,
# pictures and statistics of its first 3 seconds in out/demo.
#
#   scripts/demo.sh                    the window, or the film without a display
#   scripts/demo.sh --headless         the film
#   scripts/demo.sh --film             a film of 20 seconds of four scenes, out/demo/voile.mp4
#   scripts/demo.sh --scene drape ...  another scene; other arguments go to the viewer
#   scripts/demo.sh --help             prints this
set -euo pipefail
cd "$(dirname "$0")/.."

scene=reference
headless=false
film=false
arguments=()
while [ $# -gt 0 ]; do
  case "$1" in
    --scene)
      [ $# -gt 1 ] || { echo 'demo: --scene needs a name' >&2; exit 1; }
      scene=$2
      shift
      ;;
    --help | -h)
      awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' scripts/demo.sh
      exit 0
      ;;
    --headless) headless=true ;;
    --film) film=true ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || headless=true

scripts/setup.sh
scripts/build.sh viewer scene_meshes
viewer=build/release/bin/viewer
if $film; then
  command -v ffmpeg >/dev/null 2>&1 || { echo 'demo: a film needs ffmpeg' >&2; exit 1; }
  out=out/demo
  mkdir -p "$out"
  parts=$(mktemp -d)
  trap 'rm -rf "$parts"' EXIT
  scenes=(fabrics flag curtains dressed) # 5 seconds each
  number=0
  for part in "${scenes[@]}"; do
    number=$((number + 1))
    echo "demo: scene $number of ${#scenes[@]}, $part"
    "$viewer" "$part" --headless --frames 300 --size 640x360 --video "$parts/$part.mp4" ${arguments[@]+"${arguments[@]}"}
    printf "file '%s'\n" "$parts/$part.mp4" >>"$parts/list"
  done
  ffmpeg -hide_banner -loglevel error -f concat -safe 0 -i "$parts/list" -c copy -movflags +faststart "$parts/voile.mp4"
  mv "$parts/voile.mp4" "$out/voile.mp4"
  echo "wrote $out/voile.mp4"
  exit
fi
if ! $headless; then
  exec "$viewer" "$scene" ${arguments[@]+"${arguments[@]}"}
fi

given() { [[ " ${arguments[*]-} " == *" $1 "* || " ${arguments[*]-}" == *" $1="* ]]; }
files=()
out=out/demo
given --out && given --stats && given --video || mkdir -p "$out"
given --out || files+=(--out "$out")
given --frames || files+=(--frames 180)
given --every || files+=(--every 10)
given --stats || files+=(--stats "$out/statistics.json")
if given --video || [[ " ${arguments[*]-} " =~ ' --frames 0 '|' --frames=0 ' ]]; then
  : # a film has frames
elif command -v ffmpeg >/dev/null 2>&1; then
  files+=(--video "$out/film.mp4")
else
  echo 'demo: no ffmpeg, so no film' >&2
fi
started=$(mktemp)
trap 'rm -f "$started"' EXIT
sleep 0.05 # clocks of files advance in ticks of up to 10 ms: each picture of this run is newer
"$viewer" "$scene" --headless ${files[@]+"${files[@]}"} ${arguments[@]+"${arguments[@]}"}
# Pictures of an earlier run are deleted once there are new ones.
pictures() { find "$out" -maxdepth 1 -name 'frame_*.png' "$@"; }
given --out || [ -z "$(pictures -newer "$started" -print -quit)" ] || pictures ! -newer "$started" -delete
