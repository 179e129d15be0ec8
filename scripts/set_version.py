#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a version into every place that states it: VERSION, CHANGELOG.md, CITATION.cff and the add-on of Blender.

usage: scripts/set_version.py VERSION [--released DATE] [--dry-run]

VERSION          three numbers, such as 0.2.0
--released DATE  writes the date (2026-01-31) of a release into CHANGELOG.md and CITATION.cff
--dry-run        changes nothing, and prints the files that would change

Only the first section of CHANGELOG.md gets the version. Begin the section of the next version by hand:
"## 0.2.0 — not released yet". The entry of debian/changelog is written by hand as well, by dch.
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "house"))
import version_rules


def main() -> int:
    root = pathlib.Path(__file__).resolve().parents[1]
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("version")
    parser.add_argument("--released", default="")
    parser.add_argument("--dry-run", action="store_true")
    options = parser.parse_args()
    if not version_rules.FORM.fullmatch(options.version):
        print(f"error: '{options.version}' is no version, expected three numbers such as 0.2.0", file=sys.stderr)
        return 2
    if options.released and not version_rules.DATE.fullmatch(options.released):
        print(f"error: --released '{options.released}': expected a date such as 2026-01-31", file=sys.stderr)
        return 2
    for name, text in version_rules.changed_texts(root, options.version, options.released).items():
        if not options.dry_run:
            (root / name).write_text(text)
        print(name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
