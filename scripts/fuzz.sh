#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes every parser of foreign bytes for a while (clang 14, libFuzzer, address and undefined behaviour sanitizers),
# with as many targets at a time as there are processors, and prints the results.
#
# usage: scripts/fuzz.sh MINUTES [TARGET...]     MINUTES in all; a TARGET is a name such as path_yaml; default: all
#
# New inputs stay in build/fuzz/corpus/TARGET, so that the next call continues with them. An input that breaks a parser
# is written to build/fuzz/found/: mend the parser, and copy the input to fuzz/corpus/TARGET, which every test run
# replays. Exit code 1: a target was broken.
set -euo pipefail
cd "$(dirname "$0")/.."

if [[ ! ${1:-} =~ ^[0-9]+$ ]]; then
  sed -n '/^# usage:/s/^# //p' "$0" >&2
  exit 2
fi
minutes=$1
shift
[[ -e build/fuzz/build.ninja ]] || cmake --preset fuzz >/dev/null
targets=("$@")
if ((${#targets[@]} == 0)); then
  mapfile -t targets < <(find fuzz/corpus -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
fi
cmake --build build/fuzz --target "${targets[@]/%/_fuzz}" >&2

seconds=$((minutes * 60 * $(nproc) / ${#targets[@]}))
mkdir -p build/fuzz/found build/fuzz/log
export seconds
export LSAN_OPTIONS=suppressions=scripts/lsan.supp:print_suppressions=0
fuzz() {
  local target=$1 program
  program=$(find build/fuzz -name "$1_fuzz" -type f -perm -u+x)
  mkdir -p "build/fuzz/corpus/$target"
  # An allocation of a quarter of a gigabyte is out of proportion to an input of a megabyte.
  "$program" "build/fuzz/corpus/$target" "fuzz/corpus/$target" -max_total_time="$seconds" -timeout=10 \
    -max_len=65536 -rss_limit_mb=2048 -malloc_limit_mb=256 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/found/$target-" >"build/fuzz/log/$target" 2>&1 || touch "build/fuzz/log/$target.broken"
}
export -f fuzz
rm -f build/fuzz/log/*
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I {} bash -c 'fuzz {}'

total=0 broken=0
printf '%-22s %12s %8s  %s\n' target executions a_second result
for target in "${targets[@]}"; do
  log=build/fuzz/log/$target
  count=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  rate=$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")
  result=ok
  if [[ -e $log.broken ]]; then
    result="broken: $(grep -m1 -E '^SUMMARY|ERROR: libFuzzer' "$log" || tail -n 1 "$log")"
    broken=$((broken + 1))
  fi
  printf '%-22s %12s %8s  %s\n' "$target" "${count:-?}" "${rate:-?}" "$result"
  total=$((total + ${count:-0}))
done
echo "$total executions, $broken of ${#targets[@]} targets broken (build/fuzz/found)"
((broken == 0))
