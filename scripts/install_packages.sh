#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages of some groups that are missing, and prints their names.
#
# usage: scripts/install_packages.sh GROUP...      the groups are the files scripts/packages/GROUP.txt
#
# A line of a group is PACKAGE WHY. If nothing is missing, prints nothing and needs no rights. Otherwise runs apt-get,
# as root or through a sudo without a password; a user who has neither is told the exact command to run (exit 1). On
# systems without dpkg it lists what is needed and leaves the rest to CMake's own messages.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/patiently.sh

if (($# == 0)); then
  sed -n '/^# usage:/s/^# //p' scripts/install_packages.sh >&2
  exit 2
fi
lists=("${@/#/scripts/packages/}")
mapfile -t wanted < <(awk '!/^#/ && NF && !seen[$1]++ { print $1 }' "${lists[@]/%/.txt}")

if ! command -v dpkg-query >/dev/null; then
  echo "This is no Debian: $(basename "$0") installs nothing. Under Debian's names it takes:"
  echo "  ${wanted[*]}"
  exit 0
fi

# "ii": wanted and installed. Only packages for this machine count, because scripts/build_aarch64.sh installs some of
# another architecture. dpkg-query exits with 1 if it does not know some of the names.
installed=" $(dpkg-query -W -f='${db:Status-Abbrev} ${Package} ${Architecture}\n' "${wanted[@]}" 2>/dev/null |
  awk -v native="$(dpkg --print-architecture)" '$1 == "ii" && ($3 == native || $3 == "all") { print $2 }' |
  tr '\n' ' ') " || [[ -n $installed ]]
# Many machines have Node.js from elsewhere, with an npm that conflicts with Debian's.
is_there() {
  [[ $installed == *" $1 "* ]] || { [[ $1 == npm ]] && command -v npm >/dev/null; } ||
    { [[ $1 == nodejs ]] && command -v node >/dev/null; }
}
missing=()
for package in "${wanted[@]}"; do
  is_there "$package" || missing+=("$package")
done
if ((${#missing[@]} == 0)); then exit 0; fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null; then
    echo "Packages are missing, and installing them takes root. Run this, then start again:" >&2
    echo "  sudo apt-get update && sudo apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
apt_get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y
  -o DPkg::Lock::Timeout=120 -o Acquire::Retries=3)

# Another apt may be running. DPkg::Lock::Timeout waits for it on installing, but not on updating.
log=build/apt-update.log
update_package_lists() {
  local attempt
  for attempt in {1..12}; do
    if "${apt_get[@]}" update; then return 0; fi
    tail -n 5 "$log" | grep -q 'Could not get lock' || return 1
    echo "waiting for another apt to finish ($attempt of 12)"
    sleep 10
  done
  return 1
}

mkdir -p build
echo "Installing with ${as_root[0]:+sudo }apt-get: ${missing[*]}"
patiently "apt-get update" "$log" update_package_lists
if ! patiently "apt-get install" build/apt-install.log \
  "${apt_get[@]}" install --no-install-recommends "${missing[@]}"; then
  # When lists are updated, an unreachable mirror is only a warning.
  sed -n 's/^[WE]: /apt-get update had warned: /p' "$log" >&2
  exit 1
fi
