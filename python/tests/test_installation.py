# SPDX-License-Identifier: Apache-2.0
"""Tests the requirements of the wheel, and what the package says if another Python imports it."""
import pathlib
import shutil
import subprocess
import sys

import pytest

import lfrendertools as lf

PACKAGING = pathlib.Path(__file__).resolve().parents[1] / "packaging"


@pytest.fixture()
def backend(monkeypatch):
    monkeypatch.syspath_prepend(str(PACKAGING))
    return pytest.importorskip("wheel_by_cmake")


@pytest.mark.parametrize("pybind11, numpy", [("2.10.3", "numpy>=1.21,<2"), ("2.11.1", "numpy>=1.21,<2"),
                                             ("2.12.0", "numpy>=1.21"), ("2.13.6", "numpy>=1.21"),
                                             ("3.0.0", "numpy>=1.21")])
def test_numpy_2_needs_a_pybind11_that_knows_it(backend, pybind11, numpy):
    assert backend.numpy_for(pybind11) == numpy


def test_the_wheel_requires_what_it_was_built_with(backend, tmp_path):
    (tmp_path / "CMakeCache.txt").write_text(f"A:STRING=b\npybind11_DIR:PATH={tmp_path}\n")
    with pytest.raises(RuntimeError, match="pybind11 was not found"):
        backend.info_files(tmp_path)
    (tmp_path / "pybind11ConfigVersion.cmake").write_text('# made\nset(PACKAGE_VERSION "2.10.3")\n')
    lines = backend.info_files(tmp_path)["METADATA"].decode().splitlines()
    assert "Requires-Dist: numpy>=1.21,<2" in lines
    assert "Requires-Dist" not in "".join(lines[lines.index(""):])


def said_at_import(folder, name):
    """Returns what Python says when it imports a copy of the package whose extension has another name."""
    package = folder / "lfrendertools"
    if not package.exists():
        shutil.copytree(pathlib.Path(lf.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    for file in package.glob("_core*.so"):
        file.unlink()
    if name:
        (package / name).write_bytes(b"")
    done = subprocess.run([sys.executable, "-c", "import lfrendertools"], env={"PYTHONPATH": str(folder)},
                          cwd=folder, capture_output=True, text=True)
    assert done.returncode == 1
    return done.stderr.strip().splitlines()[-1]


def test_another_python_is_told_which_one_it_is(tmp_path):
    runs = f"{sys.implementation.name} {sys.version_info.major}.{sys.version_info.minor} ({sys.executable})"
    said = said_at_import(tmp_path, "_core.cpython-37m-x86_64-linux-gnu.so")
    assert said.startswith(f"ImportError: {tmp_path}/lfrendertools/_core.cpython-37m-x86_64-linux-gnu.so was built for "
                           f"cpython 3.7, but this is {runs}: run python3.7, or ")
    assert f"{sys.executable} -m pip install" in said
    assert "the package was not built; build and install it" in said_at_import(tmp_path, "")
    # A fault of another kind stays as it is.
    assert "was built for" not in said_at_import(tmp_path, "_core.abi3.so")
