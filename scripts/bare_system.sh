# SPDX-License-Identifier: Apache-2.0
# Functions that make bare Debian 12 systems in folders (to be sourced by bash, as root; own_namespace before anything is
# mounted).
# Mirror and proxy are those of this machine's apt, certificates those of its Node.js.

say() { printf '%5d s  %s\n' "$SECONDS" "$*"; }

# own_namespace ARGUMENT...: starts the script again with its arguments, in a mount namespace of its own, unless it is in
# one. What it mounts vanishes with it.
own_namespace() {
  if [[ ${LF_UNSHARED:-} != yes ]]; then
    LF_UNSHARED=yes exec unshare --mount --propagation private "$0" "$@"
  fi
}

# take_folder FOLDER: sets `repository` and `folder`, the absolute paths of this repository and of FOLDER, which it makes.
# Ends the script if another run is using FOLDER.
take_folder() {
  repository=$(cd "$(dirname "$0")/.." && pwd)
  folder=$(mkdir -p "$1" && cd "$1" && pwd)
  exec 9>"$folder/lock"
  if ! flock --nonblock 9; then
    echo "error: another run is using $folder" >&2
    exit 1
  fi
}

# base_system BASE LOG: makes a bare system in the folder BASE, unless it is there.
base_system() {
  local mirror
  # The first mirror of this machine's apt that has bookworm. apt-get prints one "SITE CODENAME" per line.
  mirror=$(apt-get indextargets --format '$(SITE) $(CODENAME)' 'Identifier: Packages' |
    awk '$2 == "bookworm" { print $1; exit }')
  mirror=${mirror:-http://deb.debian.org/debian}
  if [[ ! -e $1/etc/debian_version ]]; then
    say "making the base system"
    debootstrap --variant=minbase --include=git bookworm "$1" "$mirror" >"$2"
  fi
  say "bare Debian $(cat "$1/etc/debian_version"): $(du -sm "$1" | cut -f 1) MB," \
    "$(chroot "$1" dpkg-query -f '.\n' -W | wc -l) packages"
}

# configure_apt ROOT: the apt of the system in ROOT reaches its mirror as this machine does.
configure_apt() {
  apt-config dump Acquire | sed -nE '/::proxy|check-(valid|date)/Ip' >"$1/etc/apt/apt.conf.d/90host"
  cp -L /etc/resolv.conf "$1/etc/resolv.conf"
}

# mount_kernel ROOT: mounts the kernel's file systems.
mount_kernel() {
  mount -t proc proc "$1/proc"
  mount --rbind /dev "$1/dev"
  mount --rbind /sys "$1/sys" # cgroups, without which Slurm's nodes end
}

# copy_system BASE ROOT: makes a fresh system in ROOT, with an ordinary user named user.
copy_system() {
  rm -rf --one-file-system "$2"
  cp -a "$1" "$2"
  configure_apt "$2"
  mount_kernel "$2"
  chroot "$2" useradd --create-home --shell /bin/bash user
}

# run_inside ROOT USER FOLDER [NAME=VALUE...] COMMAND...: runs the command in FOLDER of the system in ROOT as this user.
# The array isolated may name a command that starts chroot, such as (unshare --net), which takes the network away.
isolated=()
run_inside() {
  local root=$1 user=$2 folder=$3 home=/root
  shift 3
  if [[ $user != root ]]; then home=/home/$user; fi
  "${isolated[@]}" chroot --userspec="$user:$user" "$root" env -i HOME="$home" USER="$user" LANG=C.UTF-8 \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    bash -c 'cd "$0" && exec env "$@"' "$folder" "$@"
}

# run_step LOG_FOLDER NAME USER COMMAND...: calls `inside USER COMMAND...`, which the caller defines, with its output in
# LOG_FOLDER/NAME.log. Prints how long it took and the last lines that it wrote.
run_step() {
  local log=$1/$2.log user=$3 start=$SECONDS code=0
  shift 3
  inside "$user" "$@" >"$log" 2>&1 || code=$?
  say "$* as $user: exit code $code after $((SECONDS - start)) s (log: $log)"
  tail -n 4 "$log" | sed 's/^/         | /'
  return "$code"
}
