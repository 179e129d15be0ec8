#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the documentation site in a folder. Installs missing Debian packages first (root or sudo).
#
# usage: scripts/site.sh [OUT]      OUT is build/site by default; open OUT/index.html in a browser
#
# If the programs are built, the site has a page of all of their options.
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/../build/site}")
cd "$(dirname "$0")/.."
scripts/install_packages.sh site
programs=build/${LF_PRESET:-release}/program_pages/programs.md
if [[ ! -e $programs ]]; then programs=; fi
exec /usr/bin/python3 scripts/site/site.py "$out" ${programs:+"$programs"}
