#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compiles all programs but lfvisualizer for 64-bit ARM, in build/aarch64. Nothing is run.
#
# usage: scripts/build_aarch64.sh      (root, Debian 12; best in a container)
#
# Adds the architecture arm64 to dpkg. Some libraries for arm64 replace those for this machine; ./test and ./demo then
# install the latter again.
set -euo pipefail
cd "$(dirname "$0")/.."
if ((EUID != 0)); then
  echo "error: adds an architecture to dpkg, which takes root" >&2
  exit 2
fi

dpkg --add-architecture arm64
apt-get -q update
wanted=(g++-aarch64-linux-gnu)
# Packages of programs in render.txt are installed for this machine, and packages of libraries for arm64, except
# libraries that consist of headers alone.
mapfile -t packages < <(awk '!/^#/ && NF { print $1 }' scripts/packages/render.txt)
for package in "${packages[@]}"; do
  case $(apt-cache show --no-all-versions "$package" | sed -n 's/^Architecture: //p') in
    all) wanted+=("$package") ;;
    *) if [[ $package == lib* ]]; then wanted+=("$package:arm64"); else wanted+=("$package"); fi ;;
  esac
done
DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends "${wanted[@]}"
cmake --preset aarch64 -DLF_WERROR=ON
cmake --build build/aarch64 -j "$(nproc)" --target programs
