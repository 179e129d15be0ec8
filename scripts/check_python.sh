#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the Python files by the rules of .flake8 with Debian 12's flake8.
#
# usage: scripts/check_python.sh    exit 1 if a rule is broken; exit 77 (skipped) without flake8
set -euo pipefail
cd "$(dirname "$0")/.."
if ! command -v flake8 >/dev/null; then
  echo "skipped: there is no flake8 here (Debian package flake8)"
  exit 77
fi
flake8 --count
