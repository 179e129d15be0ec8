# SPDX-License-Identifier: Apache-2.0
"""Settings as keyword arguments: each sets what the option of lfrenderer sets."""
import json
import os
import pathlib
import subprocess

import pytest

from lfrendertools import _core
from lfrendertools.film_options import film_words

ROWS = {row[0]: row for row in _core.settings()}
# Arguments that are not the defaults, and their words on a command line.
VALUES = {"fill": (7, "7"), "max_rays": ("5M", "5000000"), "stop_when": ("noise<=0.25", "noise<=0.25"),
          "slab_position": ((1, 2, -3), "1 2 -3"), "slab_forward": ([0, 0.5, 1], "0 0.5 1")}


def value_for(key):
    kind = ROWS[key][1]
    usual = _core.texts_of_settings({})[key]
    if key in VALUES:
        return VALUES[key]
    if kind == "switch":
        return usual == "off", "off" if usual == "on" else "on"
    if kind == "choice":
        other = {"mode": "hybrid", "estimator": "nearest", "filter": "bicubic", "lens_weights": "hat",
                 "lf_pixels": "points", "order": "area", "interpolation": "cells", "kept": "edges", "preview": "on",
                 "back_end": "reference"}[key]
        return other, other
    number = 5 if ROWS[key][3] > 1 or usual == "1" else 1
    return (number if kind == "whole" else float(number)), str(number)


@pytest.mark.parametrize("key", ROWS)
def test_an_argument_sets_its_setting_alone(key):
    value, text = value_for(key)
    usual, told = _core.texts_of_settings({}), _core.texts_of_settings(film_words({key: value}, {}))
    assert told == {**usual, key: text}
    assert told != usual


def test_every_setting_is_an_option_of_lfrenderer():
    program = pathlib.Path(os.environ["LF_BIN"]) / "lfrenderer"
    described = json.loads(subprocess.run([program, "--describe"], capture_output=True, check=True).stdout)
    options = {name: option for group in described["groups"] for option in group["options"]
               for name in option["names"]}
    names = {"max_angle_deg": "--max-angle", "guard": "--no-guard"}
    usual = _core.texts_of_settings({})
    for key, kind, *_ in ROWS.values():
        option = options[names.get(key, "--" + key.replace("_", "-"))]
        if kind not in ("point", "switch") and key != "stop_when":
            assert option["default"] == usual[key], key
