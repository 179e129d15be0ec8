#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks by Debian 12's reuse that the licence of every file is stated, and that its text is in LICENSES/.
#
# usage: scripts/check_licences.sh    exit 1 if something is missing; exit 77 (skipped) without reuse or history
set -euo pipefail
cd "$(dirname "$0")/.."
if ! command -v reuse >/dev/null; then
  echo "skipped: there is no reuse here (Debian package reuse)"
  exit 77
fi
if ! git rev-parse --git-dir >/dev/null 2>&1; then
  echo "skipped: without git, reuse would check files that are not the project's"
  exit 77
fi
cmp LICENSE LICENSES/Apache-2.0.txt
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! reuse lint >"$log"; then
  cat "$log"
  echo "error: state the licence of these files in .reuse/dep5"
  exit 1
fi
sed -n '/^\* Used licenses/,/^\* Files with license/p' "$log"
