# SPDX-License-Identifier: Apache-2.0
"""The places that state the version of the project, for check_house.py and set_version.py. The file VERSION decides;
the other places must agree, and the first section of CHANGELOG.md is that of this version."""
import pathlib
import re

FORM = re.compile(r"\d+\.\d+\.\d+")
# Places that state the version: the file, and the text in which {} stands for the version.
PLACES = {"CITATION.cff": "version: {}\n",
          "blender/lfrendertools_blender/blender_manifest.toml": 'version = "{}"\n',
          "blender/lfrendertools_blender/__init__.py": '"version": ({}),'}
WITH_COMMAS = {"blender/lfrendertools_blender/__init__.py"}
DEBIAN = "debian/changelog"
CHANGELOG, NOT_RELEASED = "CHANGELOG.md", "not released yet"
SECTION = re.compile(r"^## (?P<version>\S+) — (?P<when>.+)$", re.M)
DATE = re.compile(r"\d{4}-\d\d-\d\d")


def read(root: pathlib.Path, name: str):
    """Returns the text of a file, or None if there is no such file."""
    path = root / name
    return path.read_text() if path.is_file() else None


def version_of(root: pathlib.Path) -> str:
    return (read(root, "VERSION") or "").strip()


def pattern_of(name: str):
    """Returns the regular expression of the text that states the version in a file; its group is the version."""
    begin, end = PLACES[name].split("{}")
    number = r"(\d+, \d+, \d+)" if name in WITH_COMMAS else r"(\S+?)"
    return re.compile(r"(?<![\w-])" + re.escape(begin) + number + re.escape(end))


def section_of(root: pathlib.Path):
    """Returns (version, "not released yet" or a date, the lines) of the first section of the changelog, or None."""
    text = read(root, CHANGELOG) or ""
    first = SECTION.search(text)
    if not first:
        return None
    after = text[first.end():]
    return first["version"], first["when"], after[:re.search(r"^## |\Z", after, re.M).start()].strip()


def faults_of(root: pathlib.Path):
    """Yields each place whose version is not that of the file VERSION."""
    version = version_of(root)
    if not FORM.fullmatch(version):
        yield f"VERSION: '{version}', expected three numbers such as 0.1.0"
        return
    for name in PLACES:
        text = read(root, name)
        found = pattern_of(name).search(text) if text is not None else None
        if not found:
            yield f"{name}: states no version, expected '{PLACES[name].strip().format(version)}'"
        elif found[1].replace(", ", ".") != version:
            yield f"{name}: states version {found[1]}, VERSION says {version}: scripts/set_version.py {version}"
    debian = read(root, DEBIAN)
    if debian is not None:
        found = re.match(r"\S+ \(([^)-]+)(?:-[^)]+)?\) ", debian)
        if not found or found[1] != version:
            yield f"{DEBIAN}: its first entry is of {found[1] if found else 'no version'}, VERSION says {version}"
    section = section_of(root)
    if not section or section[0] != version:
        yield (f"{CHANGELOG}: its first section is '{section[0] if section else ''}', expected "
               f"'## {version} — {NOT_RELEASED}' or its date")
    elif section[1] != NOT_RELEASED and not DATE.fullmatch(section[1]):
        yield f"{CHANGELOG}: '{section[1]}' is neither '{NOT_RELEASED}' nor a date such as 2026-01-31"


def changed_texts(root: pathlib.Path, version: str, date: str = "") -> dict:
    """Returns {file: new text} of the files that must change to state a version. With a date, the section of the
    changelog becomes that of a release."""
    texts = {"VERSION": version + "\n"}
    for name in PLACES:
        written = PLACES[name].format(version.replace(".", ", ") if name in WITH_COMMAS else version)
        texts[name] = pattern_of(name).sub(lambda _: written, read(root, name), count=1)
    if date:
        citation = re.sub(r"^date-released: .*\n", "", texts["CITATION.cff"], flags=re.M)
        texts["CITATION.cff"] = re.sub(r"^(version: .*\n)", rf"\1date-released: {date}\n", citation, flags=re.M)
    texts[CHANGELOG] = SECTION.sub(lambda found: f"## {version} — {date or found['when']}", read(root, CHANGELOG),
                                   count=1)
    return {name: text for name, text in texts.items() if text != read(root, name)}
