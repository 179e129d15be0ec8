#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests ./demo and ./test on a bare Debian 12: a fresh system that has only git and a clone of the last commit. The two
# commands must install everything else.
#
# usage: scripts/check_bare_debian.sh FOLDER [COMMAND...]     (root; default: ./demo, then ./test)
#
# FOLDER receives the base system (kept: the next run starts from it), the system of this run, and the log of every
# step. Mirror and proxy are those of this machine's apt, certificates those of its Node.js. Commands run as root, then
# once more as an ordinary user, who must not need any rights then. Before the first command, an ordinary user must be
# told what to install. No command may compile again what an earlier one has compiled.
set -euo pipefail

if ((EUID != 0)) || ! command -v debootstrap >/dev/null || (($# == 0)); then
  sed -n '/^# usage:/,/^set/s/^# \{0,1\}//p' "$0" >&2
  echo "error: needs a FOLDER, root, and the package debootstrap" >&2
  exit 2
fi

source "$(dirname "$0")/bare_system.sh"
own_namespace "$@"
take_folder "$1"
shift
commands=("$@")
if ((${#commands[@]} == 0)); then commands=(./demo ./test); fi
base=$folder/base
root=$folder/root
checkout=/home/user/lfrendertools

base_system "$base" "$folder/base.log"
copy_system "$base" "$root"
certificates=
if [[ -r ${NODE_EXTRA_CA_CERTS:-} ]]; then
  certificates=/etc/ssl/extra.pem
  install -D -m 644 "$NODE_EXTRA_CA_CERTS" "$root$certificates"
fi
git clone --quiet --no-local "$repository" "$root$checkout"
chroot "$root" chown -R user:user /home/user
chroot "$root" git config --system --add safe.directory "$checkout"
say "cloned $(git -C "$repository" log -1 --format='%h %s')"

# inside USER COMMAND...: runs the command as this user in the clone of the new system.
inside() {
  local user=$1
  shift
  run_inside "$root" "$user" "$checkout" CI="${CI:-}" NODE_EXTRA_CA_CERTS="$certificates" "$@"
}

# step NAME USER COMMAND...: runs the command, and prints how long it took and the last lines that it wrote.
step() { run_step "$folder" "$@"; }

# Prints the object files, each with the time of its last change.
objects() {
  find "$root$checkout/build/release" -path '*/lf_precompiled*' -prune -o -name '*.o' -printf '%P %T@\n' | sort
}

if step unprivileged user scripts/install_packages.sh render; then
  echo "error: an ordinary user without packages must be told what to install" >&2
  exit 1
fi
grep -q 'sudo apt-get install' "$folder/unprivileged.log"

for command in "${commands[@]}"; do
  name=$(basename "$command")
  mkdir -p "$root$checkout/build/release"
  objects >"$folder/objects"
  step "$name-root" root $command
  recompiled=$(objects | comm -13 - "$folder/objects" | wc -l)
  if ((recompiled > 0)); then
    echo "error: $command compiled $recompiled sources again" >&2
    exit 1
  fi
  chroot "$root" chown -R user:user "$checkout"
  step "$name-user" user $command
done
say "done"
