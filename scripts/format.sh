#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Formats every C++ source by .clang-format with Debian 12's clang-format 14; other versions break lines differently.
#
# usage: scripts/format.sh [--check]    --check: changes nothing, exit 1 if something would change;
#                                       exit 77 (skipped) without clang-format 14
set -euo pipefail
cd "$(dirname "$0")/.."

for clang_format in clang-format-14 clang-format; do
  if command -v "$clang_format" >/dev/null && "$clang_format" --version | grep -q 'version 14\.'; then
    found=$clang_format
    break
  fi
done
if [[ -z ${found:-} ]]; then
  echo "skipped: there is no clang-format 14 here (Debian package clang-format-14)"
  exit 77
fi
arguments=(-i)
if [[ ${1:-} == --check ]]; then arguments=(--dry-run --Werror); fi
find . -path ./build -prune -o \( -name '*.cc' -o -name '*.h' -o -name '*.cu' \) -print0 |
  xargs -0 "$found" "${arguments[@]}"
