#!/usr/bin/env bash
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
# The mounts below are made in a mount namespace of this process, and vanish with it.
if [[ ${LF_UNSHARED:-} != yes ]]; then
  LF_UNSHARED=yes exec unshare --mount --propagation private "$0" "$@"
fi

repository=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mkdir -p "$1" && cd "$1" && pwd)
shift
exec 9>"$folder/lock"
if ! flock --nonblock 9; then
  echo "error: another run is using $folder" >&2
  exit 1
fi
commands=("$@")
if ((${#commands[@]} == 0)); then commands=(./demo ./test); fi
base=$folder/base
root=$folder/root
checkout=/home/user/lfrendertools

say() { printf '%5d s  %s\n' "$SECONDS" "$*"; }

# The first mirror of this machine's apt that has bookworm. apt-get prints one "SITE CODENAME" per line.
mirror=$(apt-get indextargets --format '$(SITE) $(CODENAME)' 'Identifier: Packages' |
  awk '$2 == "bookworm" { print $1; exit }')
mirror=${mirror:-http://deb.debian.org/debian}

if [[ ! -e $base/etc/debian_version ]]; then
  say "making the base system"
  debootstrap --variant=minbase --include=git bookworm "$base" "$mirror" >"$folder/base.log"
fi
say "bare Debian $(cat "$base/etc/debian_version"): $(du -sm "$base" | cut -f 1) MB," \
  "$(chroot "$base" dpkg-query -f '.\n' -W | wc -l) packages"

rm -rf --one-file-system "$root"
cp -a "$base" "$root"
apt-config dump Acquire | sed -nE '/::proxy|check-(valid|date)/Ip' >"$root/etc/apt/apt.conf.d/90host"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
certificates=
if [[ -r ${NODE_EXTRA_CA_CERTS:-} ]]; then
  certificates=/etc/ssl/extra.pem
  install -D -m 644 "$NODE_EXTRA_CA_CERTS" "$root$certificates"
fi
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
mount --rbind /sys "$root/sys" # cgroups, without which Slurm's nodes end
chroot "$root" useradd --create-home --shell /bin/bash user
git clone --quiet --no-local "$repository" "$root$checkout"
chroot "$root" chown -R user:user /home/user
chroot "$root" git config --system --add safe.directory "$checkout"
say "cloned $(git -C "$repository" log -1 --format='%h %s')"

# inside USER COMMAND...: runs the command as this user in the new system.
inside() {
  local user=$1 home=/root
  shift
  if [[ $user != root ]]; then home=/home/$user; fi
  chroot --userspec="$user:$user" "$root" env -i HOME="$home" USER="$user" LANG=C.UTF-8 \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin CI="${CI:-}" \
    NODE_EXTRA_CA_CERTS="$certificates" \
    bash -c 'cd "$0" && exec "$@"' "$checkout" "$@"
}

# step NAME USER COMMAND...: runs the command, and prints how long it took and the last lines that it wrote.
step() {
  local name=$1 user=$2 start=$SECONDS code=0
  shift 2
  inside "$user" "$@" >"$folder/$name.log" 2>&1 || code=$?
  say "$* as $user: exit code $code after $((SECONDS - start)) s (log: $folder/$name.log)"
  tail -n 4 "$folder/$name.log" | sed 's/^/         | /'
  return "$code"
}

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
