# SPDX-License-Identifier: Apache-2.0
# patiently WHAT LOG COMMAND...   (to be sourced by bash)
#
# Runs COMMAND with its output in the file LOG. Prints every half minute that it is still running, with the last line of
# its output. If it fails, shows the end of the log and returns its exit code. An interrupt also ends COMMAND.
patiently() {
  local what=$1 log=$2 start=$SECONDS said=0 code=0 job
  shift 2
  set -m # a process group of its own, which can be ended as a whole
  "$@" >"$log" 2>&1 </dev/null &
  job=$!
  set +m
  trap 'kill -- "-$job" 2>/dev/null; exit 130' INT TERM
  while kill -0 "$job" 2>/dev/null; do
    sleep 0.2
    if (((SECONDS - start) / 30 > said)); then
      said=$(((SECONDS - start) / 30))
      echo "  $what, $((SECONDS - start)) s so far: $(tail -n 1 "$log" | cut -c -100)"
    fi
  done
  wait "$job" || code=$?
  trap - INT TERM
  if ((code != 0)); then
    tail -n 30 "$log" >&2
    echo "error: $what failed (exit code $code); all it said is in $log" >&2
  fi
  return "$code"
}
