# SPDX-License-Identifier: Apache-2.0
"""Checks the types of the Python package: mypy's strict rules, also for the examples, and the extension's stubs.

Exit code 77: mypy is not installed.
"""
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile

ALLOWED = pathlib.Path(__file__).resolve().with_name("stubtest_allowed.txt")
PACKAGE = pathlib.Path(__file__).resolve().parents[1] / "lfrendertools"
EXAMPLES = sorted((PACKAGE.parents[1] / "examples/python").glob("*.py"))

if importlib.util.find_spec("mypy") is None:
    print("skipped: mypy is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as cache:
    environment = dict(os.environ, MYPY_CACHE_DIR=cache)
    failed = 0
    for command in (["mypy", "--strict", PACKAGE],
                    *(["mypy", "--strict", "--ignore-missing-imports", example] for example in EXAMPLES),
                    ["mypy.stubtest", "lfrendertools._core", "--ignore-missing-stub", "--allowlist", ALLOWED]):
        # mypy refuses a package that it finds on the search path as well as in the folder that it is given.
        paths = {"PYTHONPATH": ""} if command[0] == "mypy" else {}
        if command[-1] != PACKAGE:
            paths["MYPYPATH"] = os.environ["PYTHONPATH"]
        print("python3 -m", *command, flush=True)
        failed |= subprocess.run([sys.executable, "-m", *map(str, command)], env=environment | paths).returncode
sys.exit(failed != 0)
