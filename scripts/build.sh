#!/usr/bin/env bash
# Builds build/release: installs missing packages, configures, builds.
#
# usage: scripts/build.sh
#
# With CI=true in the environment, compiler warnings are errors.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/patiently.sh

if [[ -e build && ! -w build ]]; then
  echo "error: build/ belongs to $(stat -c %U build); remove it first: sudo rm -rf $PWD/build" >&2
  exit 1
fi
scripts/install_packages.sh
mkdir -p build
# Some build machines have no writable home folder.
[[ -w ${HOME:-/nowhere} ]] || export CCACHE_DIR=$PWD/build/ccache

werror=OFF
if [[ ${CI:-} == true ]]; then werror=ON; fi
patiently configuring build/configure.log cmake --preset release -DLF_WERROR="$werror"

# One compiler per processor, if each has 1.5 GB of memory.
memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
jobs=$(nproc)
by_memory=$((memory_kb / 1500000))
if ((by_memory < jobs)); then jobs=$((by_memory > 0 ? by_memory : 1)); fi
echo "Building in build/release ($jobs at a time)"
cmake --build build/release -j "$jobs"
