#!/usr/bin/env bash
# Makes the pictures of README.md and docs/ anew: those of the scenes, into docs/. Without a GPU it takes long. Look at each picture
# before you commit it.
#
#   scripts/pictures.sh              all
#   scripts/pictures.sh NAME ...     some of: reference drape curtains moving fabrics debug
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh viewer scene_meshes
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

# picture NAME FRAME SIZE SCENE [options of the viewer]
picture() {
  local name=$1 frame=$2 size=$3
  shift 3
  build/release/bin/viewer "$@" --headless --frames $((frame + 1)) --every "$frame" --size "$size" --out "$frames"
  mv "$frames/frame_$(printf '%04d' "$frame").png" "docs/$name.png"
  echo "wrote docs/$name.png"
}

for name in ${@:-reference drape curtains moving fabrics debug}; do
  case "$name" in
    reference) picture reference 100 960x540 reference ;;
    drape) picture drape 90 960x540 drape --cloth-resolution 64 ;;
    curtains) picture curtains 100 960x540 curtains ;;
    moving) picture moving 75 960x540 moving ;;
    fabrics) picture fabrics 65 1280x720 fabrics --cloth-resolution 40 ;;
    debug) picture debug 75 960x540 moving --debug boxes:3 --debug contacts ;;
    *)
      echo "pictures: there is no picture $name" >&2
      exit 1
      ;;
  esac
done
