#!/usr/bin/env bash
# Makes the documentation site in a folder. Installs missing Debian packages first (root or sudo).
#
# usage: scripts/site.sh [OUT]      OUT is build/site by default; open OUT/index.html in a browser
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/../build/site}")
cd "$(dirname "$0")/.."
scripts/install_packages.sh site
exec /usr/bin/python3 scripts/site.py "$out"
