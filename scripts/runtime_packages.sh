#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints the Debian packages that programs need to run: those of the shared libraries that they load at their start, or
# when the first file needs them (lf/core/loaded_library.h), and ffmpeg, which they start. The libraries must be installed here.
#
# usage: scripts/runtime_packages.sh FOLDER      FOLDER holds the programs, such as build/release/bin
set -euo pipefail
if (($# != 1)); then
  sed -n '/^# usage:/s/^# //p' "$0" >&2
  exit 2
fi
# Scripts load no libraries.
mapfile -t programs < <(LC_ALL=C grep --files-with-matches --binary-files=text --directories=skip $'^\x7fELF' "$1"/*)
if ((${#programs[@]} == 0)); then
  echo "error: there are no programs in $1; build them first: scripts/build.sh programs" >&2
  exit 1
fi
loaded=$(ldd "${programs[@]}")
if grep -q 'not found' <<<"$loaded"; then
  echo "error: the programs load libraries that are not installed here: $(grep 'not found' <<<"$loaded" | sort -u)" >&2
  exit 1
fi
# Programs name the libraries that they load later.
mapfile -t later < <(grep --text --only-matching --no-filename -E 'lib(heif|jxl|hdf5_serial|openjp2|curl)\.so\.[0-9.]+' "${programs[@]}" | sort -u)
for name in "${later[@]}"; do
  path=$(/sbin/ldconfig -p | awk -v name="$name" '$1 == name && !count++ { print $NF }')
  if [[ -z $path ]]; then
    echo "error: the programs load $name, which is not installed here" >&2
    exit 1
  fi
  loaded+=$'\n'"$name => $path"
done
mapfile -t libraries < <(awk '$2 == "=>" { print $3 }' <<<"$loaded" | sort -u)
for library in "${libraries[@]}"; do
  # A package lists a library in /lib or in /usr/lib, which are one folder.
  name=${library#/usr}
  if ! { dpkg-query --search "$name" || dpkg-query --search "/usr$name"; } 2>/dev/null; then
    echo "error: $library, which the programs load, belongs to no Debian package" >&2
    exit 1
  fi
done | cut -d : -f 1 | { cat && echo ffmpeg; } | sort -u
