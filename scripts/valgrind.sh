#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every program once under valgrind (Debian package valgrind), on a light field of 25 small images: no byte may be
# read before it is written or outside its memory, and no memory may be lost.
#
# usage: scripts/valgrind.sh [BUILD_DIR]      default: build/release; about five minutes
set -euo pipefail
cd "$(dirname "$0")/.."
bin=$PWD/${1:-build/release}/bin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failed=0
check() {
  local begin=$SECONDS
  # Also checks the programs that lfsubmit starts.
  if valgrind --quiet --error-exitcode=99 --leak-check=full --show-leak-kinds=definite \
    --errors-for-leak-kinds=definite --trace-children=yes --trace-children-skip='*ffmpeg,*/sh' \
    "$bin/$1" "${@:2}" >log 2>&1; then
    echo "ok      $((SECONDS - begin)) s  $*"
  else
    echo "FAILED  $((SECONDS - begin)) s  $*"
    cat log
    failed=$((failed + 1))
  fi
}
check lfsynth chart -o field --count 25 --size 96x64 --samples 1
check lfexample field -o path.yaml --move orbit --focus 1
sed -i "s/^frames: .*/frames: 2/" path.yaml
check lfimport field -o native --match-exposure --vignetting
check lfcompressor field -o film.lfs
check lfcompressor field -o lossless.lfs --profile lossless
check lfsynth still-life -o sparse --count 9 --size 96x64 --samples 1
check lfdensify sparse -o densified.lfs --force --spacing 0.5 --most 8
for mode in collect rebin hybrid; do
  check lfrenderer field path.yaml -o "$mode" --mode "$mode"
done
check lfrenderer film.lfs path.yaml -o bilinear --estimator bilinear --format png16
check lfrenderer field path.yaml -o bicubic --filter bicubic
check lfpreprocessor field path.yaml -o packages --packages 2
check lfsubmit packages/*.lfp -o submitted --jobs 1
for shard in 1 2; do
  check lfrenderer field path.yaml -o "shard $shard" --shard "$shard/2"
done
check lfmerge "shard 1" "shard 2" -o merged
check lffocus stack field path.yaml -o stack.exr --planes 2 --near 1 --far 2
check lffocus epi field --row 30 -o epi.exr
check lffocus views field --grid 3x4 -o views.npy --focus-distance 1
check lfvisualizer field path.yaml --text
check lfvisualizer field path.yaml --export page
check lfcammvminfo path.yaml --csv
check lfpath path.yaml -o path.json
check lfpath path.json -o path-again.yaml --fps 12
check lfpath path.yaml -o views.yaml --quilt 3x2
check lfquilt merged -o quilt.exr --views 1x1
check lfcompare merged merged -o differences
check lfr path path.yaml
((failed == 0)) || { echo "$failed failed"; exit 1; }
