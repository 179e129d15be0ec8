#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the long tests that ./test has no time for, one after the other, and prints the outcome of each.
#
# usage: scripts/hunt.sh [--resume] [STEP...]      default: every step, some hours on two cores
#        scripts/hunt.sh --list                    prints the steps
#
# All steps but asan, tsan, tidy and fuzz need what ./test has built in build/release. Installs missing Debian packages
# first (root or sudo; scripts/packages/). What a step printed is in build/hunt/STEP.log, its outcome in build/hunt/STEP.result.
#   --resume  leaves out the steps that passed with the same sources
#   LF_FUZZ_MINUTES  time for fuzzing, default 60
# The exit code is 1 if a step failed.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/patiently.sh

python=/usr/bin/python3
[[ -x $python ]] || python=python3
release=build/release
bin=$release/bin
# Tests that are not run under sanitizers: tests of files that are not compiled, tests with limits of memory (sanitizers
# take terabytes of addresses), tests that run other compilers, and renders of whole films in many ways, which take
# hours.
not_sanitized='^house\.|^web\.|^tests\.(hostile|environment|power|install|matrix|listed_defaults|slurm)'

# Each step is a function; its comment is what --list prints.
busy() { # ./test's tests beside two endless loops: none may depend on a quiet machine
  local loops=() code=0
  for _ in 1 2; do
    (while :; do :; done) &
    loops+=($!)
  done
  ctest --test-dir $release -j "$(nproc)" --output-on-failure || code=$?
  kill "${loops[@]}"
  return "$code"
}
asan() { # all tests but those of the page in a browser, with the address and undefined behaviour sanitizers
  cmake --preset asan && cmake --build build/asan -j "$(nproc)"
  ctest --test-dir build/asan -j "$(nproc)" --output-on-failure -E "$not_sanitized"
}
tsan() { # the tests of asan, with the thread sanitizer
  cmake --preset tsan && cmake --build build/tsan -j "$(nproc)"
  TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp" \
    ctest --test-dir build/tsan -j "$(nproc)" --output-on-failure -E "$not_sanitized"
}
tidy() { # clang-tidy and the clang analyser over every source
  scripts/tidy.sh
}
valgrind() { # every program once under valgrind
  scripts/valgrind.sh $release
}
faults() { # five calls of each kind and file fail, in every program
  $python tests/run_test.py faults $release/tests/libfault_shim.so $bin --points 5
}
environment() { # many limits of memory, files, processes and disks for every program, and many odd names
  $python tests/run_test.py environment $bin --all
}
power() { # the power fails after every step of every writer
  $python tests/run_test.py power_failure $release/tests/libwritten_log.so $bin --points 0
}
databases() { # every value of every column of a package and of a store, and a thousand damages of each
  $python tests/run_test.py hostile_databases $bin/{lfrenderer,lfpreprocessor,lfcompressor,lfimport} --all
}
judgements() { # images and poses of every capture of the corpus, with every mistake
  $python tests/run_test.py agreement_corpus $bin/{lfimport,lfsynth} "${LF_TEST_DATA:-../shared}" --all
}
matrix() { # cells of doc/matrix.md that cover all combinations of any three axes
  $python scripts/matrix.py $bin --strength 3
}
mutants() { # planted mistakes, each of which some test must notice
  $python scripts/mutants.py $release -o build/hunt/mutants.json
}
fuzz() { # every parser of foreign bytes
  scripts/fuzz.sh "${LF_FUZZ_MINUTES:-60}"
}
steps=(busy asan tsan tidy valgrind faults environment power databases judgements matrix mutants fuzz)


list() {
  local step
  for step in "${steps[@]}"; do
    printf '%-10s %s\n' "$step" "$(sed -n "s/^$step() { # //p" scripts/hunt.sh)"
  done
}

resume=false
while (($#)); do
  case $1 in
    --list) list; exit ;;
    --resume) resume=true; shift ;;
    --one) "$2"; exit ;; # in a process of its own, in which the first failed command ends the step
    -*) sed -n '/^# usage:/,/^#$/s/^# //p' scripts/hunt.sh >&2; exit 2 ;;
    *) break ;;
  esac
done
if (($#)); then steps=("$@"); fi
for step in "${steps[@]}"; do
  if [[ $(type -t "$step") != function || -z $(sed -n "s/^$step() { # //p" scripts/hunt.sh) ]]; then
    echo "error: there is no step '$step'; --list prints the steps" >&2
    exit 2
  fi
done
for step in "${steps[@]}"; do
  if [[ ! $step =~ ^(asan|tsan|tidy|fuzz)$ && ! -x $bin/lfrenderer ]]; then
    echo "error: the step '$step' needs $bin/lfrenderer; run ./test first" >&2
    exit 3
  fi
done
scripts/install_packages.sh render visualizer test hunt
mkdir -p build/hunt

sources=$(git describe --always --dirty --abbrev=12 --exclude='*')
failed=0
for step in "${steps[@]}"; do
  log=build/hunt/$step.log result=build/hunt/$step.result
  if $resume && [[ $sources != *-dirty ]] && grep -qs "^passed .* $sources\$" "$result"; then
    printf '%-10s kept: %s\n' "$step" "$(cat "$result")"
    continue
  fi
  begin=$SECONDS outcome=passed
  patiently "$step" "$log" bash scripts/hunt.sh --one "$step" 2>"$result.errors" || { outcome=FAILED; failed=$((failed + 1)); }
  echo "$outcome $((SECONDS - begin)) s $sources" >"$result"
  printf '%-10s %s %d s: %s\n' "$step" "$outcome" $((SECONDS - begin)) "$(tail -n 1 "$log" | cut -c -120)"
done
((failed == 0))
