#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the tarball of a release from the last commit: its files, and the bundled page of lfvisualizer with its sources,
# so that a build from the tarball needs neither Node.js nor npm nor a network.
#
# usage: scripts/release_tarball.sh FOLDER        makes FOLDER/lfrendertools-VERSION.tar.xz, and prints its name
#
# In the tarball, web/bundled/ has the page, and web/bundled/packages/ those files of other projects that are bundled
# into it, readable as their authors published them. The same commit and the same versions of tar, xz and Node.js give
# the same bytes: names are sorted, and every file has the time of the commit. npm fetches the packages of
# web/package-lock.json.
set -euo pipefail
repository=$(cd "$(dirname "$0")/.." && pwd)
if (($# != 1)); then
  sed -n '/^# usage:/s/^# //p' "$0" >&2
  exit 2
fi
for program in git node npm tar xz; do
  if ! command -v "$program" >/dev/null; then
    echo "error: $program is missing; scripts/install_packages.sh visualizer installs Node.js and npm" >&2
    exit 1
  fi
done
if [[ -n $(git -C "$repository" status --porcelain --untracked-files=no) ]]; then
  echo "warning: there are changes that are not committed; the tarball does not contain them" >&2
fi

folder=$(mkdir -p "$1" && cd "$1" && pwd)
commit=$(git -C "$repository" rev-parse HEAD)
version=$(git -C "$repository" show "$commit:VERSION" | head -n 1)
name=lfrendertools-$version
scratch=$(mktemp -d "$folder/tarball.XXXXXX")
trap 'rm -rf "$scratch"' EXIT

umask 022
git -C "$repository" archive --prefix="$name/" "$commit" | tar -x -C "$scratch"
web=$scratch/$name/web
(cd "$web" && npm ci --no-fund --no-audit --loglevel=error) >&2
node "$web/build.mjs" "$web/bundled" "$web/bundled/packages" >&2
rm -rf "$web/node_modules"

time=$(git -C "$repository" show --no-patch --format=%ct "$commit")
tar --sort=name --format=gnu --mtime="@$time" --owner=0 --group=0 --numeric-owner --mode=u+rw,go=rX \
  -C "$scratch" -cf "$scratch/$name.tar" "$name"
xz --threads=1 -6 "$scratch/$name.tar"
mv "$scratch/$name.tar.xz" "$folder/"
echo "$folder/$name.tar.xz"
