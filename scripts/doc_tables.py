#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the tables of pages whose content is in the sources: folders, programs, options, exit codes, formats.

usage: scripts/doc_tables.py REPOSITORY            prints what is wrong with these tables; exits with 1 if something is
       scripts/doc_tables.py REPOSITORY --write    makes them again in the pages, between their markers

A table stands between <!-- table: scripts/doc_tables.py NAME --> and <!-- end of table -->. The check `tables` of
scripts/check_house.py fails if the text there differs. The names are the keys of TABLES.
"""
import ast
import functools
import pathlib
import re
import runpy
import sys
import textwrap

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "house"))
import folder_list
import format_versions
import program_list
from table_rules import END, GENERATED, tables_of

SCRIPT = "scripts/doc_tables.py"
STRING = program_list.STRING
# Matches the value of a field of HelpTexts: strings side by side, or a raw string.
FIELD = rf'\.{{}}\s*=\s*(?:R"\((?P<raw>.*?)\)"|(?P<strings>{STRING}(?:\s*{STRING})*))'


def table(head, rows):
    """Returns the lines of a table of Markdown. A bar in a cell is escaped."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(cell.replace("|", r"\|") for cell in line) + " |\n" for line in lines)


def code(words):
    return f"`{words}`"


def joined(strings):
    """Returns the value of C++ string literals that stand side by side."""
    return "".join(ast.literal_eval(literal) for literal in re.findall(STRING, strings))


def the_file(root, pattern, mark):
    """Returns the text of the one file that matches the pattern and has the mark."""
    found = [text for text in (path.read_text() for path in sorted(root.glob(pattern))) if mark in text]
    if len(found) != 1:
        raise ValueError(f"expected one file {pattern} with '{mark}', found {len(found)}")
    return found[0]


def allowed_includes(root):
    """Returns {folder: the folders that it may include}, by their paths below lf/."""
    depends = {folder: set(words.get("DEPENDS", ())) for folder, words in folder_list.read_folders(root).items()}
    unknown = sorted(set().union(*depends.values()) - set(depends))
    if unknown:
        raise ValueError(f"a folder of lf/ depends on {', '.join(unknown)}, which is not one")
    return depends


def table_of_includes(kind, depends):
    """Returns the table of what each folder or room may include."""
    @functools.cache
    def height(folder):
        return max((height(name) + 1 for name in depends[folder]), default=0)

    order = sorted(depends, key=lambda folder: (height(folder), folder))
    basic = [name for name in order if all(name in depends[folder] or folder == name for folder in order)]
    rows = {}
    for folder in order:
        if folder not in basic:
            allowed = [name for name in order if name in depends[folder] and name not in basic]
            rows.setdefault(", ".join(allowed) or "no other", []).append(folder)
    return table([kind, "may include"],
                 [[", ".join(basic), f"nothing, but every {kind} may include it; it is left out below"],
                  *([", ".join(row), allowed] for allowed, row in rows.items())])


def folders(root):
    return table_of_includes("folder", allowed_includes(root))


def rooms(root):
    """Returns the table of the folders directly in lf/, each with the folders inside it."""
    depends = {}
    for folder, names in allowed_includes(root).items():
        room = folder_list.room_of(folder)
        depends.setdefault(room, set()).update(folder_list.room_of(name) for name in names)
    return table_of_includes("room", {room: names - {room} for room, names in depends.items()})


def field_of(help_texts, name):
    match = re.search(FIELD.format(name), help_texts, re.S)
    if not match:
        raise ValueError(f"a program has no .{name} in its HelpTexts")
    return match["raw"] or joined(match["strings"])


def programs(root):
    rows, listed = [], program_list.summaries(root)
    for name in re.findall(r"^lf_tool\((\w+)", (root / "tools/CMakeLists.txt").read_text(), re.M):
        text = (root / f"tools/{name}.cc").read_text()
        calls = [line.strip().replace(" [OPTIONS]", "") for line in field_of(text, "usage").splitlines()]
        summary = listed.get(name) or field_of(text, "summary")
        rows.append([code(name), summary.rstrip("."), ", ".join(map(code, calls))])
    return table(["program", "what it does", "call"], rows)


def offered_by(option, offered):
    """Returns the programs that offer an option, or all but those that do not, whichever is shorter. A program that
    offers none only lists its commands, and is left out."""
    names = [code(name) for name, options in offered.items() if option in options]
    others = [code(name) for name, options in offered.items() if options and option not in options]
    if len(others) >= len(names):
        return ", ".join(names)
    return "all but " + " and ".join(filter(None, (", ".join(others[:-1]), others[-1]))) if others else "all"


def common_options(root):
    lists = runpy.run_path(str(root / "tests/helpers/common_options.py"))
    return table(["option", "offered by", "effect"],
                 [[code(shown), offered_by(option, lists["OFFERED"]), effect]
                  for option, (shown, effect) in lists["COMMON"].items()])


def exit_codes_of(root):
    """Returns {exit code: what it means}: the comments of ErrorKind, and of the codes that are not kinds."""
    text = the_file(root, "lf/**/result.h", "enum class ErrorKind")
    above, body = re.search(r"((?://.*\n)+)enum class ErrorKind \{\n(.*?)\};", text, re.S).groups()
    codes = {int(number): words for number, words in re.findall(r"^//   (\d)  (.*)$", above, re.M)}
    for comment, number in re.findall(r"((?: *//.*\n)+) *k\w+ = (\d+),", body):
        words = " ".join(line.strip(" /") for line in comment.splitlines())
        codes[int(number)] = words[0].lower() + words[1:].rstrip(".")
    return codes


def exit_codes(root):
    return table(["code", "means"], [[str(number), re.sub(r"(--[\w-]+)", r"`\1`", words)]
                                     for number, words in sorted(exit_codes_of(root).items())])


def exit_codes_in_help(root):
    text = (root / "tools/common/help.h").read_text()
    sentence = joined(re.search(rf"kExitCodes =\s*((?:{STRING}\s*)+);", text)[1])
    numbers = [int(number) for number in re.findall(r"\b(\d) [a-z]", sentence)]
    if numbers != sorted(exit_codes_of(root)):
        raise ValueError(f"kExitCodes in tools/common/help.h lists {numbers}, ErrorKind {sorted(exit_codes_of(root))}")
    return textwrap.fill(sentence, 118, break_long_words=False) + "\n"


def versions_of_formats(root):
    return table(["format", "version", "a file states it by"], format_versions.rows(root))


TABLES = {"rooms": rooms, "folders": folders, "programs": programs, "common-options": common_options,
          "exit-codes": exit_codes, "exit-codes-in-help": exit_codes_in_help, "format-versions": versions_of_formats}


def pages(root, files, text_lines):
    """Yields (page, its generated tables)."""
    for page in files:
        if page.suffix == ".md":
            tables, _ = tables_of(root, page, text_lines(page))
            yield page, [found for found in tables if found.words.startswith(GENERATED)]


def folders_without_a_row(root):
    """Yields a fault for each folder that has no row in the table of tasks in lf/README.md. That table is written by
    hand."""
    text = (root / "lf/README.md").read_text()
    for folder in allowed_includes(root):
        if not re.search(rf"^\| `([\w/]+/)?{folder.rpartition('/')[2]}`", text, re.M):
            yield f"lf/README.md: no row of the table is that of lf/{folder}"


def check(root, files, text_lines):
    """Yields what is wrong with the generated tables."""
    shown = set()
    for page, tables in pages(root, files, text_lines):
        for found in tables:
            name = found.words.removeprefix(GENERATED)
            shown.add(name)
            try:
                if name not in TABLES:
                    yield f"{found.page}:{found.line}: {SCRIPT} makes no table {name}"
                elif found.text != TABLES[name](root):
                    yield (f"{found.page}:{found.line}: the sources say something else than this table: "
                           f"{SCRIPT} . --write")
            except (OSError, ValueError) as error:
                yield f"{found.page}:{found.line}: {error}"
    if root / SCRIPT in files:
        yield from folders_without_a_row(root)
        yield from (f"{SCRIPT}: no page shows the table {name}" for name in TABLES if name not in shown)


def write(root, files, text_lines):
    """Makes the tables again."""
    for page, tables in pages(root, files, text_lines):
        text = before = page.read_text()
        for found in tables:
            begin = f"<!-- table: {found.words} -->\n"
            made = TABLES[found.words.removeprefix(GENERATED)](root)
            before_it, after = text.split(begin, 1)
            text = f"{before_it}{begin}{made}{END}{after.partition(END)[2]}"
        if text != before:
            page.write_text(text)
            print(f"{page.relative_to(root)} is changed")


def main():
    import check_house
    if len(sys.argv) < 2 or sys.argv[2:] not in ([], ["--write"]):
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1])
    files = check_house.tracked_files(root)
    if sys.argv[2:]:
        write(root, files, check_house.text_lines)
        return 0
    faults = list(check(root, files, check_house.text_lines))
    print("\n".join(faults) or "the generated tables are what the sources say")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
