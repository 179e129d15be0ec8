#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs one test of whole programs, and tells Python where its helpers are.

usage: tests/run_test.py NAME [ARGUMENT...]

NAME      a test, such as lfexample or chain: runs tests/*/NAME_test.py; or the path of a script
ARGUMENT  as tests/CMakeLists.txt gives them: most tests need programs, or the folder of all programs, and take words of
          unittest behind them, such as -v or the name of a class

./test --only tests.NAME builds what the test needs, and runs it. Tests may import the modules of their own folder and
of ROOMS; scripts outside tests/ call add_rooms() before they import these.
"""
import pathlib
import runpy
import sys

TESTS = pathlib.Path(__file__).resolve().parent
ROOMS = [TESTS / "helpers", TESTS / "programs", TESTS / "matrix", TESTS, TESTS.parent / "bench",
         TESTS.parent / "scripts/house"]


def add_rooms():
    sys.path += [str(room) for room in ROOMS if str(room) not in sys.path]


def script_of(name: str) -> pathlib.Path:
    """Returns the script of a test. Raises FileNotFoundError if there is none."""
    for path in (pathlib.Path(name), *sorted(TESTS.glob(f"*/{name}_test.py"))):
        if path.is_file():
            return path.resolve()
    names = sorted(path.name.removesuffix("_test.py") for path in TESTS.glob("*/*_test.py"))
    raise FileNotFoundError(f"there is no test {name}; the tests are {', '.join(names)}")


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    try:
        script = script_of(sys.argv[1])
    except FileNotFoundError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    sys.path[0] = str(script.parent)
    add_rooms()
    sys.argv = [str(script), *sys.argv[2:]]
    runpy.run_path(str(script), run_name="__main__")
    return 0


if __name__ == "__main__":
    sys.exit(main())
