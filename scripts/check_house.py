#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks house rules that no compiler checks. Prints one line for each fault: file, place, what is wrong.

usage: check_house.py REPOSITORY CHECK

  includes folders of lf/ include only what lf_folder(... DEPENDS ...) allows, third-party headers only in the folders
           that own them; rooms do not depend on each other in a cycle (include_rules.py)
  lengths  no source file is longer than 800 lines; those of more than 500 are noted, which is no fault (doc/style.md)
  paths    no file holds an absolute path of somebody's build machine, and no name begins with a dash
           (an option that was taken for a folder)
  links    in every Markdown page: links lead to files and headings that exist, `paths` in
           backticks exist, and `folder.Suite.Test` and `tests.name` are tests that exist
  pages    the pages of doc/ that comments in sources refer to exist
  tables   every table of figures in doc/ has a record in bench/results/ that fits it, made with the
           defaults that bench/defaults.txt lists today (table_rules.py); every table that
           doc_tables.py makes is what the sources say
  mutants  every mistake of scripts/mutants.toml can be planted: its old text is in its function exactly once, and
           its regular expression matches names of tests
  headers  the headers that the library promises exist and include few others; a header that says "Internal to" is
           included only there (header_rules.py)
  licences every source states its licence in its first line (licence_headers.py)
  programs places that have words for each program name all of them (program_list.py)
  comments comments begin and end as doc/style.md requires (comment_rules.py)
  version  VERSION, CHANGELOG.md, CITATION.cff and the add-on of Blender state one version (version_rules.py)
  options  no message of the library names an option as a command line spells it (message_rules.py)
  messages subjects and bodies of commits are as doc/style.md requires (commit_rules.py); exits with 77 (skipped) if
           there is no history
"""
import pathlib
import re
import sys

import doc_tables  # which adds scripts/house to the search path
import comment_rules
import commit_rules
import folder_list
import header_rules
import include_rules
import licence_headers
import message_rules
import mutant_list
import program_list
import table_rules
import version_rules
from repository_files import text_lines, tracked_files

SOURCES = {".cc", ".h", ".c", ".py", ".sh", ".cmake", ".txt", ".ts", ".mjs", ".css", ""}
LONG, TOO_LONG = 500, 800  # lines of a source
MACHINE_PATH = re.compile(r"(?<![\w.$}])/(?:work|root)/[\w.]")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
# Matches `lf/camera/ray.h` and `scripts/`. Patterns and placeholders contain * < { or ... and do not match (except
# x_test.cc).
NAMED_FILE = re.compile(r"`((?:lf|tools|tests|scripts|doc|examples|cmake|fuzz|bench)/[\w./-]*)`")
NAMED_TEST = re.compile(r"`([a-z_]+(?:\.[a-z_]+)?\.[A-Z]\w*\.\w+|(?:tests|house)\.\w+)`")
PAGE_IN_COMMENT = re.compile(r"\bdoc/[\w/]+\.md\b")


def is_source(path: pathlib.Path) -> bool:
    return (path.suffix in SOURCES and path.name != "LICENSE" and
            "corpus" not in path.parts)


def check_lengths(root, files):
    for path in filter(is_source, files):
        count = len(text_lines(path))
        if count > TOO_LONG:
            yield f"{path.relative_to(root)}: {count} lines, the limit is {TOO_LONG}: split it"
        elif count > LONG:
            print(f"note: {path.relative_to(root)}: {count} lines; has it parts that can be read alone?")


def check_paths(root, files):
    for path in files:
        if any(part.startswith("-") for part in path.relative_to(root).parts):
            yield f"{path.relative_to(root)}: a name that begins with a dash is an option to most programs"
        for number, line in enumerate(text_lines(path), 1):
            match = MACHINE_PATH.search(line)
            if match:
                yield (f"{path.relative_to(root)}:{number}: '{line[match.start():][:40]}' is a path"
                       " of one machine; write it relative to the repository")


def heading_anchors(page) -> set:
    """Returns the anchors that GitHub generates for the headings of a page."""
    headings = (re.match(r"#+ +(.*)", line) for line in text_lines(page))
    return {re.sub(r"[^\w\- ]", "", h.group(1).lower()).replace(" ", "-")
            for h in headings if h}


def link_fault(root, page, target):
    """Returns the fault of a link on a page, or None."""
    if re.match(r"[a-z]+:", target):
        return None  # another site, which is not checked
    name, _, anchor = target.partition("#")
    path = (page.parent / name if name else page).resolve()
    if not path.is_relative_to(root.resolve()):
        return f"link '{target}' leaves the repository"
    if not path.exists():
        return f"link '{target}' leads nowhere"
    if anchor and anchor not in heading_anchors(path):
        return f"link '{target}': {path.name} has no such heading"
    return None


def page_faults(root, page, tests):
    for number, line in enumerate(text_lines(page), 1):
        for target in LINK.findall(line):
            fault = link_fault(root, page, target)
            if fault:
                yield number, fault
        for name in NAMED_FILE.findall(line):
            if not (root / name).exists():
                yield number, f"`{name}` does not exist"
        for name in NAMED_TEST.findall(line):
            if name not in tests:
                yield number, f"there is no test `{name}`"


def test_group(folder: pathlib.PurePath) -> str:
    """Returns what the names of tests in a folder of the repository begin with: camera.path for lf/camera/path."""
    top, *inner = folder.parts or ("",)
    return folder_list.test_group("/".join(inner)) if top == "lf" else top


def named_tests(root, files) -> set:
    """Returns folder.Suite.Test of every TEST, and the names of tests in CMake lists."""
    found = set()
    for path in files:
        text = "\n".join(text_lines(path))
        if path.name.endswith("_test.cc"):
            cases = re.findall(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", text)
            group = test_group(path.parent.relative_to(root))
            found.update(f"{group}.{suite}.{test}" for suite, test in cases)
        elif path.name == "CMakeLists.txt":
            found.update(re.findall(r"\blf_(?:\w+_)?test\(([a-z]+\.\w+)", text))
    return found


def check_links(root, files):
    tests = named_tests(root, files)
    for page in files:
        if page.suffix == ".md":
            for number, fault in page_faults(root, page, tests):
                yield f"{page.relative_to(root)}:{number}: {fault}"


def check_pages(root, files):
    for path in (f for f in files if f.suffix in {".cc", ".h", ".cu", ".cmake"}):
        for number, line in enumerate(text_lines(path), 1):
            for name in PAGE_IN_COMMENT.findall(line):
                if not (root / name).exists():
                    yield f"{path.relative_to(root)}:{number}: the page {name} does not exist"


def check_tables(root, files):
    yield from table_rules.check_tables(root, files, text_lines)
    yield from doc_tables.check(root, files, text_lines)


def check_mutants(root, files):
    return mutant_list.check_list(root, named_tests(root, files))


def check_comments(root, files):
    for path in files:
        for number, fault in comment_rules.faults_of(path, list(text_lines(path))):
            yield f"{path.relative_to(root)}:{number}: {fault}"


def check_headers(root, files):
    return header_rules.check_headers(root, files, text_lines)


def check_includes(root, files):
    return include_rules.check_includes(root)


def check_licences(root, files):
    return licence_headers.faults_of(root, files)


def check_programs(root, files):
    return program_list.missing(root)


def check_options(root, files):
    return message_rules.check_options(root, files)


def check_version(root, files):
    return version_rules.faults_of(root)


def check_messages(root, files):
    return commit_rules.check_messages(root)


CHECKS = {"includes": check_includes, "licences": check_licences, "programs": check_programs,
          "lengths": check_lengths, "paths": check_paths, "links": check_links, "pages": check_pages,
          "tables": check_tables, "mutants": check_mutants, "headers": check_headers, "comments": check_comments,
          "options": check_options, "version": check_version, "messages": check_messages}
SKIPPED = 77


def main() -> int:
    if len(sys.argv) != 3 or sys.argv[2] not in CHECKS:
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1])
    files = tracked_files(root)
    if not files:
        print(f"{root}: no files", file=sys.stderr)
        return 1
    unknown = commit_rules.why_no_history(root) if sys.argv[2] == "messages" else ""
    if unknown:
        print(f"skipped: commits cannot be looked up: {unknown}")
        return SKIPPED
    faults = list(CHECKS[sys.argv[2]](root, files))
    print("\n".join(faults) or f"{len(files)} files, no fault")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
