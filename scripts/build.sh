#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds in build/PRESET: installs missing packages, configures, builds.
#
# usage: scripts/build.sh demo                 the programs that ./demo runs
#        scripts/build.sh programs             every program
#        scripts/build.sh [tests [TARGET...]]  every program and test, or some targets of CMake
#
# Each of these calls reuses what another one has compiled, because all compile with the same options. The environment
# variable LF_PRESET=clang or LF_PRESET=scalar selects another preset than release, and CI=true makes compiler warnings
# errors.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/patiently.sh

preset=${LF_PRESET:-release}
build=build/$preset
what=${1:-tests}
case $what in
  demo)
    groups=(render)
    targets=(lfsynth lfrenderer)
    options=()
    # A later call that needs these options turns them on, and no call turns them off again.
    [[ -e $build/CMakeCache.txt ]] || options=(-DLF_TESTS=OFF -DLF_VISUALIZER=OFF)
    ;;
  programs)
    groups=(render visualizer)
    targets=(programs)
    options=(-DLF_VISUALIZER=ON)
    [[ -e $build/CMakeCache.txt ]] || options+=(-DLF_TESTS=OFF)
    ;;
  tests)
    groups=(render visualizer test python)
    targets=("${@:2}")
    options=(-DLF_VISUALIZER=ON -DLF_TESTS=ON -DLF_PYTHON=ON)
    ;;
  *)
    sed -n '/^# usage:/,/^#$/s/^# //p' scripts/build.sh >&2
    exit 2
    ;;
esac
if [[ $preset == clang ]]; then groups+=(hunt); fi

if [[ -e build && ! -w build ]]; then
  echo "error: build/ belongs to $(stat -c %U build); remove it first: sudo rm -rf $PWD/build" >&2
  exit 1
fi
scripts/install_packages.sh "${groups[@]}"
mkdir -p build
# Some build machines have no writable home folder.
[[ -w ${HOME:-/nowhere} ]] || export CCACHE_DIR=$PWD/build/ccache

werror=OFF
if [[ ${CI:-} == true ]]; then werror=ON; fi
patiently configuring build/configure.log cmake --preset "$preset" -DLF_WERROR="$werror" "${options[@]}"

# One compiler per processor, if each has 1.5 GB of memory.
memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
jobs=$(nproc)
by_memory=$((memory_kb / 1500000))
if ((by_memory < jobs)); then jobs=$((by_memory > 0 ? by_memory : 1)); fi
echo "Building in $build ($jobs at a time)"
cmake --build "$build" -j "$jobs" ${targets[@]:+--target "${targets[@]}"}
