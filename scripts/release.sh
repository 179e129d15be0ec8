#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a release of the last commit of the branch main: dates its section of the changelog, runs ./test, tags the commit,
# and makes the files of the release. Never pushes.
#
# usage: scripts/release.sh [--dry-run] VERSION      VERSION is that of the file VERSION, such as 0.1.0
#
#   --dry-run  changes nothing, and prints what would be done
#
# The files are in build/release-VERSION/: the tarball, the list of all files with their licences (SPDX, by Debian's
# reuse), and the checksums of both (SHA256SUMS). The call may be repeated after a failure: it continues where it ended.
# To begin the next version, run scripts/set_version.py and add a section to CHANGELOG.md.
set -euo pipefail
cd "$(dirname "$0")/.."
python=/usr/bin/python3
[[ -x $python ]] || python=python3

dry=false
if [[ ${1:-} == --dry-run ]]; then
  dry=true
  shift
fi
if (($# != 1)) || [[ $1 == -* ]]; then
  sed -n '/^# usage:/s/^# //p' scripts/release.sh >&2
  exit 2
fi
version=$1 tag=v$1 name=lfrendertools-$1 folder=build/release-$1

# Prints a line for each reason why there can be no release now.
faults() {
  local branch changed
  if [[ ! $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]]; then
    echo "'$version' is no version, expected three numbers such as 0.2.0"
    return
  fi
  if [[ $(cat VERSION) != "$version" ]]; then
    echo "the file VERSION says $(cat VERSION), not $version: run scripts/set_version.py $version and commit that first"
  fi
  branch=$(git symbolic-ref --quiet --short HEAD || echo none)
  if [[ $branch != main ]]; then
    echo "the branch is $branch, and releases are made from main: git switch main"
  fi
  changed=$(git status --porcelain)
  if [[ -n $changed ]]; then
    echo "there are changes that are not committed; commit or remove them: $(head -n 5 <<<"$changed" | tr -s '\n ' ' ')"
  fi
  if git rev-parse --quiet --verify "refs/tags/$tag" >/dev/null &&
    [[ $(git rev-parse "$tag^{commit}") != $(git rev-parse HEAD) ]]; then
    echo "the tag $tag exists and is another commit: choose another version, a release is never changed"
  fi
  $python scripts/check_house.py . version | sed '/, no fault$/d'
  if [[ -z $(section) ]]; then
    echo "CHANGELOG.md has no lines for $version: say what a user can see"
  fi
  if ! git var GIT_COMMITTER_IDENT >/dev/null 2>&1; then
    echo "git does not know who you are: git config user.name, git config user.email"
  fi
  for program in reuse xz sha256sum; do
    if ! command -v "$program" >/dev/null; then
      echo "$program is missing: install the Debian package $(sed 's/xz/xz-utils/;s/sha256sum/coreutils/' <<<"$program")"
    fi
  done
}

# Prints the lines of the first section of the changelog.
section() {
  $python -c 'import pathlib, sys
sys.path.insert(0, "scripts/house")
import version_rules
print((version_rules.section_of(pathlib.Path(".")) or ("", "", ""))[2])'
}

# step WORDS COMMAND...: prints what is done, and does it unless this is a dry run.
step() {
  echo "$1"
  shift
  if ! $dry; then "$@"; fi
}

commit_date() {
  $python scripts/set_version.py "$version" --released "$date" >/dev/null
  git commit --quiet --all -m "VERSION: Release $version" -m "Dates the section of the changelog."
}

check() {
  local commit
  commit=$(git rev-parse HEAD)
  if ! ./test; then
    echo "error: ./test failed, nothing is tagged. Mend it, commit, and call this again" >&2
    exit 1
  fi
  if [[ -n $(git status --porcelain) || $(git rev-parse HEAD) != "$commit" ]]; then
    echo "error: files or commits changed while ./test ran, nothing is tagged. Commit them, and call this again" >&2
    exit 1
  fi
}

make_tag() {
  { echo "lfrendertools $version"; echo; section; } | git tag --annotate --cleanup=verbatim --file=- "$tag"
}

# Removes an unfinished folder of an earlier call, and makes all files anew.
make_files() {
  rm -rf "$folder"
  mkdir -p "$folder"
  if [[ -n $tarball ]]; then
    "$tarball" "$folder" >/dev/null
  else
    git archive --format=tar --prefix="$name/" "$tag" | xz -6 >"$folder/$name.tar.xz"
  fi
  if [[ ! -s $folder/$name.tar.xz ]]; then
    echo "error: there is no $folder/$name.tar.xz, which $tarball should have made" >&2
    exit 1
  fi
  reuse spdx --output "$folder/$name.spdx"
  (cd "$folder" && sha256sum "$name.tar.xz" "$name.spdx" >SHA256SUMS && sha256sum --check --quiet SHA256SUMS)
}

reasons=$(faults)
if [[ -n $reasons ]]; then
  echo "error: there can be no release $version:" >&2
  sed 's/^/  - /' <<<"$reasons" >&2
  exit 1
fi
date=$(date --utc +%F)
tarball=
how="of the files of the commit (git archive; without the bundled page of lfvisualizer)"
if [[ -x scripts/release_tarball.sh ]]; then
  tarball=scripts/release_tarball.sh
  how="by $tarball"
fi
if $dry; then echo "A dry run: nothing of this is done."; fi

if [[ -n $($python scripts/set_version.py "$version" --released "$date" --dry-run) ]]; then
  if grep -q "^## $version — not released yet\$" CHANGELOG.md; then
    step "Writing $date into CHANGELOG.md and CITATION.cff, and committing that: \"VERSION: Release $version\"" commit_date
  else
    echo "The changelog is dated already, by an earlier call"
  fi
fi
if git rev-parse --quiet --verify "refs/tags/$tag" >/dev/null; then
  echo "The commit is tagged already ($tag), by an earlier call"
else
  step "Running ./test" check
  step "Tagging the commit: $tag, with the $(section | wc -l) lines of its section of CHANGELOG.md" make_tag
fi
step "Making the tarball $folder/$name.tar.xz $how, the list of files and licences $name.spdx, and SHA256SUMS" make_files
if ! $dry; then
  echo "Done, and nothing is pushed. To publish: git push origin main $tag; then upload the files of $folder"
fi
