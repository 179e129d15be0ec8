# SPDX-License-Identifier: Apache-2.0
"""Builds the Python package for pip (PEP 517): CMake compiles the extension, and a wheel is a zip file.

It needs nothing from a package index. The packages of scripts/packages/render.txt and python.txt must be installed.
"""
import base64
import contextlib
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = "lfrendertools"


def version():
    return (ROOT / "VERSION").read_text().split()[0]


def dist_info():
    return f"{NAME}-{version()}.dist-info"


def metadata(numpy):
    return (f"Metadata-Version: 2.1\nName: {NAME}\nVersion: {version()}\n"
            "Summary: Films densely recorded light fields with a thin-lens camera\nLicense: Apache-2.0\n"
            f"Requires-Python: >=3.9\nRequires-Dist: {numpy}\nDescription-Content-Type: text/markdown\n\n"
            + (ROOT / "doc/python/README.md").read_text())


def numpy_for(pybind11):
    """Returns the versions of NumPy that an extension works with if this version of pybind11 compiled it."""
    major, minor = map(int, re.match(r"(\d+)\.(\d+)", pybind11).groups())
    return "numpy>=1.21" if (major, minor) >= (2, 12) else "numpy>=1.21,<2"


def pybind11_of(folder):
    """Returns the version of pybind11 that a build folder compiles with."""
    cache = (pathlib.Path(folder) / "CMakeCache.txt").read_text()
    found = re.search(r"^pybind11_DIR:\w+=(.*)$", cache, re.MULTILINE)
    stated = pathlib.Path(found[1], "pybind11ConfigVersion.cmake") if found else None
    if not stated or not stated.is_file():
        raise RuntimeError("pybind11 was not found: install the packages of scripts/packages/python.txt")
    return re.search(r'set\(PACKAGE_VERSION "([^"]+)"\)', stated.read_text())[1]


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def info_files(folder):
    """Returns the contents of the files about the package in its .dist-info folder, by name, after configure()."""
    wheel = f"Wheel-Version: 1.0\nGenerator: {NAME}\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    about = metadata(numpy_for(pybind11_of(folder)))
    return {"METADATA": about.encode(), "WHEEL": wheel.encode(), "LICENSE": (ROOT / "LICENSE").read_bytes()}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Writes the files about the package, for which pip would otherwise build the whole wheel once more."""
    folder = pathlib.Path(metadata_directory) / dist_info()
    folder.mkdir()
    with build_folder() as built:
        configure(built)
        for name, content in info_files(built).items():
            (folder / name).write_bytes(content)
    return folder.name


@contextlib.contextmanager
def build_folder():
    """Yields the folder $LF_WHEEL_BUILD, or a temporary one."""
    with tempfile.TemporaryDirectory() as folder:
        yield os.environ.get("LF_WHEEL_BUILD") or folder


def configure(folder):
    options = ["-DLF_PYTHON=ON", "-DLF_TESTS=OFF", "-DLF_VISUALIZER=OFF", f"-DPython3_EXECUTABLE={sys.executable}"]
    subprocess.run(["cmake", "--preset", "release", "-B", folder, *options], cwd=ROOT, check=True, stdout=sys.stderr)


def build(folder):
    """Compiles the extension, and returns the folder of the whole package."""
    configure(folder)
    subprocess.run(["cmake", "--build", folder, "--target", "lf_python"], cwd=ROOT, check=True, stdout=sys.stderr)
    return pathlib.Path(folder) / "python" / NAME


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    with build_folder() as folder:
        package = build(folder)
        files = {f"{NAME}/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
        files |= {f"{dist_info()}/{name}": content for name, content in info_files(folder).items()}
    record = f"{dist_info()}/RECORD"
    files[record] = ("".join(record_line(name, content) for name, content in files.items()) +
                     f"{record},,\n").encode()
    wheel = f"{NAME}-{version()}-{tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    """Packs the files that git knows; PKG-INFO sets no upper limit for NumPy, because only a build knows it."""
    base = f"{NAME}-{version()}"
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    with tempfile.NamedTemporaryFile("w", suffix="PKG-INFO") as info:
        info.write(metadata("numpy>=1.21"))
        info.flush()
        with tarfile.open(pathlib.Path(sdist_directory) / f"{base}.tar.gz", "w:gz") as archive:
            archive.add(info.name, f"{base}/PKG-INFO")
            for name in filter(None, names):
                archive.add(ROOT / name, f"{base}/{name}", recursive=False)
    return f"{base}.tar.gz"
