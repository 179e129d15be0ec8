#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Says which share of the lines and branches of lf/ and tools/ the tests run. Builds everything in build/coverage with
# counters, runs the tests and prints a summary; build/coverage/lines/index.html shows every line.
#
# usage: scripts/coverage.sh [CTEST OPTIONS]      scripts/coverage.sh -L unit  counts unit tests alone
#
# Takes hours on two cores, because nothing is optimised; with -LE 'slow|cluster' about an hour.
#
# Installs missing Debian packages first (root or sudo). A failed test does not end this script: its exit code is then
# 1.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/patiently.sh

# Programs write their counts into files when they end. Left out are therefore tests that make writing fail, that count
# files, or that kill programs. The other tests that are left out run no program of ours, or render whole films for
# hours.
left_out='^house\.|^web\.|^tests\.(faults|power_failure|environment|safe_outputs|writers|install|listed_defaults|matrix|slurm)'

scripts/install_packages.sh render visualizer test hunt
mkdir -p build
patiently configuring build/configure.log cmake --preset coverage
cmake --build build/coverage -j "$(nproc)"
find build/coverage -name '*.gcda' -delete
code=0
ctest --test-dir build/coverage -j "$(nproc)" --progress --output-on-failure -E "$left_out" "$@" || code=1
mkdir -p build/coverage/lines
# Children that are forked while other threads count leave a few counters below 0, which gcovr would end at.
gcovr --root . --object-directory build/coverage --gcov-ignore-parse-errors -j "$(nproc)" \
  --filter 'lf/' --filter 'tools/' --exclude '.*_(test|fuzz|bench)\.cc' --exclude '.*/test[a-z_]*\.(cc|h)' \
  --exclude-throw-branches --exclude-unreachable-branches \
  --html-details build/coverage/lines/index.html --json-summary build/coverage/summary.json --print-summary
exit "$code"
