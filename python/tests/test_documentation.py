# SPDX-License-Identifier: Apache-2.0
"""The examples in docstrings and in doc/python/ run."""
import doctest
import importlib
import pathlib
import pkgutil
import re

import numpy as np
import pytest

import lfrendertools as lf

DOC = pathlib.Path(__file__).resolve().parents[2] / "doc"
PAGE = DOC / "python/README.md"
MODULES = ["lfrendertools"] + [f"lfrendertools.{module.name}" for module in pkgutil.iter_modules(lf.__path__)
                               if module.name != "_core"]


@pytest.fixture()
def beside_capture(capture, tmp_path, monkeypatch):
    (tmp_path / "capture").symlink_to(capture)
    monkeypatch.chdir(tmp_path)


def test_docstrings(beside_capture):
    results = [doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS) for name in MODULES]
    assert sum(result.failed for result in results) == 0
    assert sum(result.attempted for result in results) >= 20


def test_page(beside_capture, capsys):
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.S)
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), {})
    assert blocks and "(320, 480, 3)" not in capsys.readouterr().err
    assert lf.read_image("frame.png").dtype == np.uint8


def test_page_of_focus_tools(beside_capture):
    blocks = re.findall(r"```python\n(.*?)```", (DOC / "focus.md").read_text(), re.S)
    for block in blocks:
        exec(compile(block, "focus.md", "exec"), {})
    assert blocks and np.load("views.npy").shape == (3, 3, 120, 160, 3)


def test_every_public_function_is_documented():
    for name in lf.__all__:
        thing = getattr(lf, name)
        assert thing.__doc__, name
        for member, value in vars(thing).items() if isinstance(thing, type) else ():
            if not member.startswith("_") and callable(value):
                assert value.__doc__, f"{name}.{member}"
