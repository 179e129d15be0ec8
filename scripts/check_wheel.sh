#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the wheel of the Python package as a user does, installs it into a fresh virtual environment without a package
# index, lists its contents, and renders a frame with it without a display, in one process with NumPy, OpenCV and
# scikit-learn, whose threads are those of OpenMP.
#
# usage: scripts/check_wheel.sh
#
# As root it also installs the Debian packages that it needs. $PYTHON is the interpreter (/usr/bin/python3).
# The compiled objects stay in build/wheel, so that a second run is short.
set -euo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-/usr/bin/python3}

if ((EUID == 0)); then
  scripts/install_packages.sh render python
  apt-get install --yes --no-install-recommends python3-venv python3-pip python3-opencv python3-sklearn
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv --system-site-packages "$folder/venv"
export LF_WHEEL_BUILD=$PWD/build/wheel PIP_NO_INDEX=1 PIP_DISABLE_PIP_VERSION_CHECK=1
"$folder/venv/bin/pip" wheel --no-deps --wheel-dir "$folder" .
"$folder/venv/bin/pip" install "$folder"/lfrendertools-*.whl
"$python" -m zipfile --list "$folder"/lfrendertools-*.whl
cd "$folder"
env -u DISPLAY venv/bin/python - <<'END'
import cv2
import numpy as np
from sklearn.cluster import KMeans

import lfrendertools as lf

lf.synth("chart", "chart", count=49, size=(160, 120))
field = lf.open("chart")
frame = lf.render(field, field.camera(focus_distance=1))
colours = KMeans(4, n_init=1, random_state=0).fit(cv2.blur(frame.rgb, (5, 5)).reshape(-1, 3)).cluster_centers_
again = lf.render(field, field.camera(focus_distance=1))
assert np.isfinite(colours).all() and np.array_equal(frame.rgb, again.rgb)
print(f"lfrendertools {lf.__version__} from {lf.__file__}: {frame}, {len(colours)} colours")
END
