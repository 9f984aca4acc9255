#!/usr/bin/env bash
# Makes the pictures of README.md and docs/ anew: those of the scenes, into docs/. Without a GPU it takes long. Look at each picture
# before you commit it. The flag and those of a material's parameters need ffmpeg, the window Xvfb. docs/capture.png, of RenderDoc,
# is made by hand.
#
#   scripts/pictures.sh              all
#   scripts/pictures.sh NAME ...     some of: reference drape curtains moving fabrics dressed flag debug window, and of a
#                                    material's parameters stretch_stiffness shear_stiffness bending_stiffness areal_density
#                                    air_drag friction thickness
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh viewer scene_meshes
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

# frame FRAME SIZE SCENE [options of the viewer]: a PNG, whose path is in $made
frame() {
  local number=$1 size=$2
  shift 2
  build/release/bin/viewer "$@" --headless --frames $((number + 1)) --every "$number" --size "$size" --out "$frames"
  made=$frames/frame_$(printf '%04d' "$number").png
}
# picture FILE FRAME SIZE SCENE [options of the viewer]: docs/FILE, a PNG, or a JPEG of half the size
picture() {
  local file=docs/$1
  shift
  frame "$@"
  case "$file" in
    *.jpg) ffmpeg -loglevel error -y -i "$made" -vf scale=iw/2:-1:flags=area -q:v 3 "$file" </dev/null ;;
    *) mv "$made" "$file" ;;
  esac
  echo "wrote $file"
}
# The flag, and in the corner a part of the same picture with a heat map of strain.
flag() {
  frame 160 1000x700 flag
  mv "$made" "$frames/flag.png"
  frame 160 1000x700 flag --debug strain
  ffmpeg -loglevel error -y -i "$frames/flag.png" -i "$made" -filter_complex \
    '[1]crop=660:440:160:85,scale=256:-1:flags=area,pad=iw+4:ih+4:2:2:white[inset];[0][inset]overlay=12:H-h-12,format=rgb24' \
    docs/flag.png </dev/null
  echo 'wrote docs/flag.png'
}
# The viewer's window on a virtual display, as the tests of the window use it.
window() {
  scripts/build.sh test_window
  VOILE_WINDOW_PICTURES=$frames build/release/bin/test_window --no-skip -tc='the picture of the window'
  mv "$frames/window.png" docs/window.png
  echo 'wrote docs/window.png'
}
# Three cloths that differ in one parameter.
parameter() { picture "materials/$1.jpg" "$2" 1440x640 "$1"; }

parameters='stretch_stiffness shear_stiffness bending_stiffness areal_density air_drag friction thickness'
for name in ${@:-reference drape curtains moving fabrics dressed flag debug window $parameters}; do
  case "$name" in
    reference) picture reference.png 100 960x540 reference ;;
    drape) picture drape.png 90 960x540 drape --cloth-resolution 64 ;;
    curtains) picture curtains.png 100 960x540 curtains ;;
    moving) picture moving.png 75 960x540 moving ;;
    fabrics) picture fabrics.png 65 1280x720 fabrics --cloth-resolution 40 ;;
    dressed) picture dressed.png 100 560x680 dressed ;;
    flag) flag ;;
    window) window ;;
    debug) picture debug.png 75 960x540 moving --debug boxes:3 --debug contacts ;;
    stretch_stiffness | shear_stiffness) parameter "$name" 120 ;;
    bending_stiffness | thickness) parameter "$name" 60 ;;
    areal_density) parameter "$name" 90 ;;
    air_drag) parameter "$name" 27 ;;
    friction) parameter "$name" 35 ;;
    *)
      echo "pictures: there is no picture $name" >&2
      exit 1
      ;;
  esac
done
