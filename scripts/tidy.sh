#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy 14 (Debian package clang-tidy-14) with the checks of .clang-tidy.
#
# usage: scripts/tidy.sh [FILE.cc...]      default: every source of lf/ and tools/
#                                       except tests, fuzz targets and benchmarks
#
# Needs a configured build/dev (cmake --preset dev) for its list of compiler calls.
set -euo pipefail
cd "$(dirname "$0")/.."
[[ -e build/dev/compile_commands.json ]] || cmake --preset dev >/dev/null
files=("$@")
if ((${#files[@]} == 0)); then
  mapfile -t files < <(sed -n "s|^ *\"file\": \"$PWD/\(.*\)\"|\1|p" build/dev/compile_commands.json |
    grep -E '^(lf|tools)/' | grep -vE '_(test|fuzz|bench)\.cc$' | sort -u)
fi
# clang-tidy ignores options that it does not know, because build/dev is configured for GCC.
printf '%s\n' "${files[@]}" |
  xargs -P "$(nproc)" -n 1 clang-tidy-14 -p build/dev --quiet --warnings-as-errors='*' \
    --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-unused-command-line-argument
