#!/usr/bin/env bash
# Makes the pictures of README.md and docs/ anew: those of the scenes, into docs/. Without a GPU it takes long. Look at each picture
# before you commit it. Those of a material's parameters need ffmpeg.
#
#   scripts/pictures.sh              all
#   scripts/pictures.sh NAME ...     some of: reference drape curtains moving fabrics dressed debug, and of a material's parameters
#                                    stretch_stiffness shear_stiffness bending_stiffness areal_density air_drag friction thickness
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh viewer scene_meshes
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

# picture FILE FRAME SIZE SCENE [options of the viewer]: docs/FILE, a PNG, or a JPEG of half the size
picture() {
  local file=docs/$1 frame=$2 size=$3
  shift 3
  build/release/bin/viewer "$@" --headless --frames $((frame + 1)) --every "$frame" --size "$size" --out "$frames"
  local made
  made=$frames/frame_$(printf '%04d' "$frame").png
  case "$file" in
    *.jpg) ffmpeg -loglevel error -y -i "$made" -vf scale=iw/2:-1:flags=area -q:v 3 "$file" </dev/null ;;
    *) mv "$made" "$file" ;;
  esac
  echo "wrote $file"
}
# Three cloths that differ in one parameter.
parameter() { picture "materials/$1.jpg" "$2" 1440x640 "$1"; }

parameters='stretch_stiffness shear_stiffness bending_stiffness areal_density air_drag friction thickness'
for name in ${@:-reference drape curtains moving fabrics dressed debug $parameters}; do
  case "$name" in
    reference) picture reference.png 100 960x540 reference ;;
    drape) picture drape.png 90 960x540 drape --cloth-resolution 64 ;;
    curtains) picture curtains.png 100 960x540 curtains ;;
    moving) picture moving.png 75 960x540 moving ;;
    fabrics) picture fabrics.png 65 1280x720 fabrics --cloth-resolution 40 ;;
    dressed) picture dressed.png 100 560x680 dressed ;;
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
