#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the Debian packages of the last commit as a release does, and checks them on bare Debian 12 systems.
#
# usage: scripts/check_debian_packages.sh FOLDER       (root; debootstrap, piuparts, Node.js and npm)
#
# It makes the tarball twice, and builds the packages of it twice without a network: in two folders, in other languages
# and time zones, the second time without the compiler's cache. Both times tarball and packages must have the same
# bytes. lintian must find neither errors nor warnings. On a bare system, apt installs the packages, the programs make
# the first film within two minutes and without a compiler, all scripts of debian/tests pass, and removal leaves no
# file behind; piuparts checks installation and removal once more.
#
# DEB_BUILD_OPTIONS=nocheck leaves out the unit tests, which the first build runs otherwise. FOLDER receives the packages
# (FOLDER/first), the log of every step, and the systems. It keeps the base system, the system with what builds the
# packages, and the cache of the compiler, from which the next run starts.
set -euo pipefail

if ((EUID != 0 || $# != 1)) || ! command -v debootstrap >/dev/null || ! command -v piuparts >/dev/null; then
  sed -n '/^# usage:/,/^set/s/^# \{0,1\}//p' "$0" >&2
  echo "error: needs a FOLDER, root, and the packages debootstrap and piuparts" >&2
  exit 2
fi

source "$(dirname "$0")/bare_system.sh"
own_namespace "$@"
take_folder "$1"
version=$(head -n 1 "$repository/VERSION")
tarball=lfrendertools-$version.tar.xz
source=lfrendertools-$version
fail() {
  echo "error: $*" >&2
  exit 1
}

# inside USER COMMAND...: runs the command in $place of the system in $root.
inside() {
  local user=$1
  shift
  run_inside "$root" "$user" "$place" DEBIAN_FRONTEND=noninteractive "$@"
}
step() { run_step "$folder" "$@"; }

# The tarball, twice.
for run in one two; do
  rm -rf "$folder/tarball-$run"
  "$repository/scripts/release_tarball.sh" "$folder/tarball-$run" >"$folder/tarball-$run.log" 2>&1
done
cmp "$folder/tarball-one/$tarball" "$folder/tarball-two/$tarball"
say "two tarballs are equal: $(cd "$folder/tarball-one" && sha256sum "$tarball")"

# The system that builds. $folder has the same path inside as outside.
base_system "$folder/base" "$folder/base.log"
root=$folder/builder
place=/
if [[ ! -e $root/etc/debian_version ]]; then
  cp -a "$folder/base" "$root"
  chroot "$root" useradd --create-home --shell /bin/bash user
fi
configure_apt "$root"
mount_kernel "$root"
for name in first second ccache; do
  [[ $name == ccache ]] || rm -rf "${folder:?}/$name"
  mkdir -p "$folder/$name" "$root$folder/$name"
  mount --bind "$folder/$name" "$root$folder/$name"
done
for name in first second; do
  tar -xf "$folder/tarball-one/$tarball" -C "$folder/$name"
  cp "$folder/tarball-one/$tarball" "$folder/$name/lfrendertools_$version.orig.tar.xz"
done
chroot "$root" chown -R user:user "$folder/first" "$folder/second" "$folder/ccache"
step apt-update root apt-get -q update
step build-depends root apt-get -q -y --no-install-recommends build-dep "$folder/first/$source"
step build-tools root apt-get -q -y --no-install-recommends install lintian ccache

# build NAME [NAME=VALUE...]: builds the packages in $folder/NAME without a network.
build() {
  local name=$1
  place=$folder/$name/$source
  shift
  isolated=(unshare --net)
  step "build-$name" user CCACHE_DIR="$folder/ccache" "$@" dpkg-buildpackage --unsigned-source --unsigned-changes
  isolated=()
}
options="${DEB_BUILD_OPTIONS:-} parallel=$(nproc)"
build first PATH=/usr/lib/ccache:/usr/sbin:/usr/bin:/sbin:/bin DEB_BUILD_OPTIONS="$options"
build second DEB_BUILD_OPTIONS="$options nocheck" CCACHE_DISABLE=1 TZ=Pacific/Kiritimati LC_ALL=C
# hashes NAME: prints the checksums of all packages and of the source in $folder/NAME.
hashes() { (cd "$folder/$1" && sha256sum ./*.deb ./*.debian.tar.xz); }
diff <(hashes first) <(hashes second) || fail "the two builds differ"
hashes first | sed 's/^/         | /'
say "two builds are equal"

# lintian needs no network and no root.
place=$folder/first
step lintian user sh -c 'lintian --fail-on error,warning --tag-display-limit 0 lfrendertools_*.changes'

# The bare system of a user. Lists of files leave out what belongs to apt and dpkg, and to logs.
root=$folder/root
copy_system "$folder/base" "$root"
place=/home/user
step user-update root apt-get -q update
files() {
  chroot "$root" find / -xdev -path /proc -prune -o -path /sys -prune -o -path /dev -prune -o -path /tmp -prune -o \
    -path '/var/lib/apt/*' -prune -o -path '/var/lib/dpkg/*' -prune -o -path '/var/cache/*' -prune -o \
    -path '/var/log/*' -prune -o -path '/home/user/*' -prune -o -print | LC_ALL=C sort
}
files >"$folder/files-before"
mkdir -p "$root/home/user/tests"
cp "$folder"/first/*.deb "$root/home/user/"
cp -r "$repository/debian/tests" "$repository/tests/foreign" "$root/home/user/tests/"
mv "$root/home/user/tests/tests" "$root/home/user/debian-tests"
chroot "$root" chown -R user:user /home/user
chroot "$root" sh -c 'rm -f /home/user/*-dbgsym_*.deb'

# apt_install NAME PACKAGE...: installs packages of $folder/first.
apt_install() {
  local name=$1
  shift
  step "$name" root sh -c "apt-get -q -y install $(printf './%s_*.deb ' "$@")"
}
apt_install install-programs lfrendertools lfrendertools-doc
apt_install install-python python3-lfrendertools
for compiler in cc c++ gcc g++ clang node; do
  ! chroot "$root" sh -c "command -v $compiler" || fail "the packages install $compiler"
done
start=$SECONDS
step first-film user sh debian-tests/demo
((SECONDS - start <= 120)) || fail "the first film took $((SECONDS - start)) s, not two minutes"
step python user sh debian-tests/python
apt_install install-library liblfrendertools-dev
step install-compiler root apt-get -q -y --no-install-recommends install g++ cmake ninja-build pkgconf
step library user sh debian-tests/library

# Removal. A path of our packages may stay only where another package has it.
packages=(lfrendertools lfrendertools-doc python3-lfrendertools liblfrendertools-dev)
chroot "$root" dpkg -L "${packages[@]}" | LC_ALL=C sort -u >"$folder/files-of-packages"
step remove root apt-get -q -y purge "${packages[@]}"
files >"$folder/files-after"
comm -13 "$folder/files-before" "$folder/files-after" >"$folder/files-new"
while read -r path; do
  chroot "$root" dpkg -S "$path" >/dev/null 2>&1 || echo "$path"
done < <(comm -12 "$folder/files-new" "$folder/files-of-packages") >"$folder/files-left"
sed -n /lfrender/Ip "$folder/files-new" >>"$folder/files-left"
if [[ -s $folder/files-left ]]; then
  cat "$folder/files-left" >&2
  fail "removal leaves these files behind"
fi
say "removal left none of $(wc -l <"$folder/files-of-packages") paths"

# piuparts works on a copy of the base system, whose apt reaches the mirror.
rm -rf --one-file-system "$folder/piuparts"
cp -a "$folder/base" "$folder/piuparts"
configure_apt "$folder/piuparts"
mapfile -t debs < <(find "$folder/first" -name '*.deb' ! -name '*-dbgsym_*' | sort)
say "piuparts on ${#debs[@]} packages (log: $folder/piuparts.log)"
TMPDIR=$folder piuparts --existing-chroot "$folder/piuparts" --keep-sources-list --distribution bookworm \
  --warn-on-debsums-errors --log-file "$folder/piuparts.log" "${debs[@]}" >/dev/null 2>&1 ||
  { tail -n 30 "$folder/piuparts.log" >&2; fail "piuparts finds faults"; }
grep -E 'PASS|ERROR' "$folder/piuparts.log" | sed 's/^/         | /'
say "done"
