#!/usr/bin/env bash
# Installs the packages that Voile needs to build and run, on Debian 12 and 13 and Ubuntu 24.04 (apt); the last two have
# none of RenderDoc. Without apt it prints what to install. Does nothing if everything is installed.
#
#   scripts/setup.sh            installs what is missing
#   scripts/setup.sh --check    only prints missing packages; exit code 1 if there are any
set -euo pipefail

case "${1:-}" in
  '' | --check) ;;
  -h | --help)
    awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
    exit 0
    ;;
  *)
    printf 'setup: there is no option %s; see --help\n' "$1" >&2
    exit 1
    ;;
esac

packages=(
  build-essential cmake ninja-build git ca-certificates
  libvulkan-dev libvulkan-volk-dev glslang-tools spirv-tools
  libglm-dev libglfw3-dev libtinyobjloader-dev libstb-dev nlohmann-json3-dev libcli11-dev doctest-dev
  libimgui-dev libxtst-dev
  mesa-vulkan-drivers vulkan-validationlayers
  renderdoc librenderdoc-dev python3-renderdoc
  ffmpeg xvfb xauth
)

say() { printf 'setup: %s\n' "$*"; }

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null 2>&1; then
    sudo "$@"
  else
    say "installing packages needs root or sudo; as root, run: $*" >&2
    exit 1
  fi
}

installed() { dpkg-query -W -f '${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed; }

# A release may lack a package such as RenderDoc. That is no reason to fail.
optional() { case "$1" in renderdoc | librenderdoc-dev | python3-renderdoc | libimgui-dev | libxtst-dev | xvfb | xauth) true ;; *) false ;; esac; }

available() { [ -n "$(apt-cache madison "$1" 2>/dev/null)" ]; }

has_vma() {
  [ -f /usr/include/vk_mem_alloc.h ] || [ -f /usr/local/include/vk_mem_alloc.h ] ||
    ls /usr/include/*/vk_mem_alloc.h >/dev/null 2>&1
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    installed "$package" || optional "$package" || printf '%s\n' "$package"
  done
  has_vma || printf 'libvulkan-memory-allocator-dev\n'
}

# The missing packages that this release has, according to its package lists.
missing_optional_packages() {
  local package
  for package in "${packages[@]}"; do
    if optional "$package" && ! installed "$package" && available "$package"; then
      printf '%s\n' "$package"
    fi
  done
}

# Debian 12 has no VulkanMemoryAllocator. Debian 13's package is header-only, for all architectures and
# without dependencies, so it is taken from the mirror that the machine already uses, through a private
# source list: the machine's own sources stay as they are.
install_vma_from_trixie() {
  local work mirror
  mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' |
    awk '$2 == "bookworm" { print $1; exit }')
  if [ -z "$mirror" ]; then
    say "no Debian mirror found to take libvulkan-memory-allocator-dev from; install VulkanMemoryAllocator 3 by hand" >&2
    return 1
  fi
  work=$(mktemp -d)
  chmod 755 "$work"
  mkdir -p "$work/lists/partial"
  printf 'deb %s trixie main\n' "$mirror" >"$work/trixie.list"
  local options=(-o "Dir::Etc::sourcelist=$work/trixie.list" -o Dir::Etc::sourceparts=/dev/null
    -o "Dir::State::Lists=$work/lists")
  as_root apt-get "${options[@]}" -qq update
  (cd "$work" && as_root apt-get "${options[@]}" -qq -o APT::Sandbox::User=root download libvulkan-memory-allocator-dev)
  as_root dpkg -i "$work"/libvulkan-memory-allocator-dev_*.deb >/dev/null
  as_root rm -rf "$work"
}

if ! command -v apt-get >/dev/null 2>&1; then
  command -v cmake >/dev/null && command -v glslangValidator >/dev/null && has_vma && exit 0
  cat >&2 <<'TEXT'
setup: this system has no apt. Install with its package manager, then run the command again:
  a C++20 compiler, CMake 3.25, Ninja, git, ffmpeg (for films)
  Vulkan headers and loader, volk, VulkanMemoryAllocator 3, glslangValidator, spirv-val
  GLM, GLFW 3, tinyobjloader, stb, nlohmann-json 3, CLI11, doctest, Dear ImGui (optional: the viewer's panel), libXtst
  (optional: a test)
  a Vulkan driver (Mesa's lavapipe runs without a GPU), the Khronos validation layer, RenderDoc (optional)
TEXT
  exit 1
fi

mapfile -t missing < <(missing_packages)
mapfile -t extra < <(missing_optional_packages)
if [ "${1:-}" = "--check" ]; then
  [ "${#missing[@]}" -eq 0 ] && exit 0
  say "missing: ${missing[*]}"
  exit 1
fi
[ "${#missing[@]}" -eq 0 ] && [ "${#extra[@]}" -eq 0 ] && exit 0

export DEBIAN_FRONTEND=noninteractive
as_root apt-get -qq update
mapfile -t extra < <(missing_optional_packages) # the lists may have been empty before
wanted=(${extra[@]+"${extra[@]}"})
for package in ${missing[@]+"${missing[@]}"}; do
  if available "$package"; then
    wanted+=("$package")
  elif [ "$package" != libvulkan-memory-allocator-dev ]; then # Debian 12: below
    say "package $package is not in this release of the distribution; install it by hand" >&2
    exit 1
  fi
done
if [ "${#wanted[@]}" -gt 0 ]; then
  say "installing ${#wanted[@]} packages: ${wanted[*]}"
  as_root apt-get -qq install -y --no-install-recommends "${wanted[@]}" >/dev/null
fi
has_vma || install_vma_from_trixie
for package in "${packages[@]}"; do
  if optional "$package" && ! installed "$package"; then
    say "$package is not in this release; features that need it stay off"
  fi
done
say "done"
