# SPDX-License-Identifier: Apache-2.0
"""Makes the page of the C++ library from its headers, for site.py. The page reads from top to bottom: the headers that
the library promises (lf/public_headers.txt), in order, declaration by declaration, each after its comment. Headers
below lf/detail/ are shown where one of their names is first used, folded."""
import os
import re

import header_rules
from comment_rules import LICENCE_TAG
from site_pages import Site, fenced, place_of

PLACE = "cpp/index.md"
INTRODUCTION = """# The C++ library

A C++ program opens light fields and films, and renders frames in memory and films into folders, with the bits of
`lfrenderer`. It includes one header, `<lf/lfrendertools.h>`. This page has everything that the header declares, in the
order in which it is read; it is made from the headers. [The library, folder by folder](rooms.md) shows what is inside.

"""
BUILD = """## Compile it

`cmake --install` and the package `liblfrendertools-dev` install the library, for C++20. With CMake:

{cmake}
With `pkg-config`:

{pkg_config}
Either program takes a light field and a [camera path](../formats/path.md), such as those of the
[tutorial](../tutorial.md):

{run}
A program that writes the frame into a file, and takes some settings ([two others]({others}) render a film into a
folder, and look at unfinished frames):

{example}
"""
CMAKE = """cmake_minimum_required(VERSION 3.25)
project(light LANGUAGES CXX)
find_package(lfrendertools REQUIRED)
add_executable(light light.cc)
target_link_libraries(light PRIVATE lfrendertools::lfrendertools)"""
PKG_CONFIG = "c++ light.cc -o light $(pkg-config --cflags --libs lfrendertools)"
RUN = """lfsynth still-life -o still-life            # a light field
lfexample still-life -o path.yaml           # a camera path through it
./light still-life path.yaml"""

SPECIAL = re.compile(r"([\\*_\[\]<>#|~$])")
# Words that are code in the text of a comment: enumerators, functions, members of types, names of headers.
CODE = re.compile(r"(?<![\w/.])(?:k[A-Z]\w*|(?:\w+::)+\w+(?:\(\))?|\w+\(\)|[\w/]+\.(?:h|json|exr|png|yaml)"
                  r"|\w+_(?:w|px|s))(?!\w)")
PAGE = re.compile(r"\bdoc/[\w/]+\.md\b")
NAMED_ENTRY = re.compile(r"  (\S+(?:, \S+)*)  +(\S.*)")
FORWARD = re.compile(r"(?:enum )?(?:struct|class) \w+;.*")
# Functions stand before the text that describes them, longer declarations after it.
IS_READ_AFTER_TEXT = re.compile(r"(?:template <.*\n)?(?:enum|struct|class|using|inline|#define|static_assert)\b")
PRIVATE = re.compile(r"\n+ private:\n.*?(?=\n\};)", re.S)
NAME = re.compile(r"^(?:template <[^\n]*>\n)?(?:(?:enum )?(?:struct|class) (?:\[\[nodiscard\]\] )?(?P<type>\w+)"
                  r"|using (?P<alias>\w+)|#define (?P<macro>\w+)|[^\n(]*?\b(?P<function>\w+)\()", re.M)


def parts_of(text: str):
    """Returns the comment that a header begins with, and its declarations."""
    lines = [line for line in text.splitlines() if LICENCE_TAG not in line]
    count = next((i for i, line in enumerate(lines) if not line.startswith("//")), len(lines))
    comment = "\n".join(line.removeprefix("//").removeprefix(" ") for line in lines[:count])
    rest = [line for line in lines[count:] if not re.match(r"#include|#pragma once|namespace lf \{|\}  // namespace lf",
                                                           line)]
    return comment, "\n".join(rest).strip()


def blocks_of(declarations: str):
    """Yields the comment and the code of each group of declarations that a blank line ends."""
    depth, comment, code = 0, [], []
    for line in [*declarations.splitlines(), ""]:
        if not line and depth == 0:
            if comment or code:
                yield "\n".join(comment), PRIVATE.sub("", "\n".join(code))
            comment, code = [], []
        elif line.startswith("//") and not code:
            comment.append(line.removeprefix("//").removeprefix(" "))
        else:
            code.append(line)
            bare = line.partition("//")[0]
            depth += bare.count("{") - bare.count("}")


class Text:
    """Turns comments into Markdown.

    sections  {name of a header, as comments write it: anchor of its section}
    """

    def __init__(self, sections: dict):
        self.sections = sections

    def word(self, match) -> str:
        anchor = self.sections.get(match[0].removeprefix("lf/"))
        return f"[`{match[0]}`](#{anchor})" if anchor else f"`{match[0]}`"

    def plain(self, text: str) -> str:
        pages = [(m.start(), m.end()) for m in PAGE.finditer(text)]
        pieces, end = [], 0
        for start, stop in [*pages, (len(text), len(text))]:
            begin = 0
            between = text[end:start]
            for match in CODE.finditer(between):
                pieces += [SPECIAL.sub(r"\\\1", between[begin:match.start()]), self.word(match)]
                begin = match.end()
            pieces.append(SPECIAL.sub(r"\\\1", between[begin:]))
            if start < stop:
                place = os.path.relpath(place_of(text[start:stop]), os.path.dirname(PLACE))
                pieces.append(f"[{text[start:stop]}]({place})")
            end = stop
        return "".join(pieces)

    def prose(self, lines: list) -> str:
        parts = " ".join(lines).split("`")
        return "`".join(part if i % 2 else self.plain(part) for i, part in enumerate(parts)) + "\n"

    def laid_out(self, lines: list) -> str:
        """Returns indented lines: a list if each entry has a name and a text, otherwise a block of code."""
        entries = []
        for line in lines:
            match = NAMED_ENTRY.fullmatch(line)
            if match:
                entries.append((match[1], [match[2]]))
            elif entries and line.startswith("    "):
                entries[-1][1].append(line.strip())
            elif line:
                is_code = any(mark in line for line in lines for mark in (";", "#include", "{"))
                return fenced("\n".join(each.removeprefix("  ") for each in lines), "cpp" if is_code else "text")
        return "".join(f"- `{name}`: {self.prose(text)}" for name, text in entries)

    def of(self, comment: str) -> str:
        """Returns a comment as Markdown."""
        runs = []  # (is laid out, lines)
        for line in comment.splitlines():
            is_laid_out = line.startswith("  ") or (not line and bool(runs) and runs[-1][0])
            is_item = line.startswith("- ")
            if not runs or runs[-1][0] != is_laid_out or is_item or (not line and not is_laid_out):
                runs.append((is_laid_out, []))
            runs[-1][1].append(line)
        return "\n".join(self.laid_out(lines) if is_laid_out else self.prose(lines)
                         for is_laid_out, lines in runs if any(lines))


def names_in(code: str) -> list:
    """Returns the names that a group of declarations declares."""
    names = []
    depth = 0
    statement = ""
    for line in code.splitlines():
        bare = line.partition("//")[0]
        if depth == 0:
            statement += bare + "\n"
        depth += bare.count("{") - bare.count("}")
        if depth == 0 and statement.strip() and bare.rstrip().endswith((";", "}", "{")) or bare.startswith("#define"):
            match = NAME.match(statement.strip())
            name = match and next((each for each in match.groups() if each), None)
            if name and name not in [*names, "static_assert"] and not name.endswith("_"):
                names.append(name)
            statement = ""
    return names


def section_of(text: Text, title: str, name: str, content: str) -> str:
    comment, declarations = parts_of(content)
    lines, last = [f"## {title}\n", f"`{name}`\n", text.of(comment)], None
    for comment, code in blocks_of(declarations):
        if FORWARD.fullmatch(code):
            continue
        heading = ", ".join(names_in(code)[:3])
        if heading and heading != last:
            lines.append("### " + SPECIAL.sub(r"\\\1", heading) + "\n")
            last = heading
        both = [text.of(comment)] * bool(comment) + [fenced(code, "cpp")] * bool(code)
        lines += both if IS_READ_AFTER_TEXT.match(code) else reversed(both)
    return "\n".join(lines)


def folded(name: str, content: str) -> str:
    comment, declarations = parts_of(content)
    comment = "\n".join(("// " + line).rstrip() for line in comment.splitlines())
    code = fenced(f"{comment}\n\n{PRIVATE.sub('', declarations)}", "cpp")
    names = dict.fromkeys(each for _, part in blocks_of(declarations) if not FORWARD.fullmatch(part)
                          for each in names_in(part) if re.match("[A-Z]", each) and each != "NameOf")
    return (f"<details><summary>{', '.join(f'<code>{each}</code>' for each in names)}</summary>\n\n"
            f"Declared in `{name}`:\n\n{code}\n</details>\n")


def anchor_of(title: str) -> str:
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def write_library(site: Site):
    """Writes the page, and notes in site.shown where it shows which header."""
    promised = header_rules.promised_headers(site.root)
    read = {name: (site.root / name).read_text() for name in header_rules.included_by(site.root, promised)}
    text = Text({name.removeprefix("lf/"): anchor_of(title) for name, title in promised.items()})
    foreign = (site.root / "tests/foreign/frame.cc").read_text()
    page = [INTRODUCTION]
    shown = set()
    for name, title in promised.items():
        page.append(section_of(text, title, name, read[name]))
        if name == "lf/lfrendertools.h":
            others = os.path.relpath(site.place_of_linked(PLACE, "tests/foreign"), os.path.dirname(PLACE))
            page.append(BUILD.format(cmake=fenced(CMAKE, "cmake"), pkg_config=fenced(PKG_CONFIG, "bash"),
                                     run=fenced(RUN, "bash"), example=fenced(foreign, "cpp"), others=others))
            continue
        later = {each for other in promised if other not in (name, header_rules.FRONT)
                 for each in header_rules.includes_of(read[other].splitlines())}
        own = header_rules.includes_of(read[name].splitlines())
        needed = [each for each in header_rules.included_by(site.root, [name], promised)
                  if each not in {name, *shown, *later.difference(own)}]
        if needed:
            page.append("Names that it uses from other headers:\n")
            page += [folded(each, read[each]) for each in needed]
            shown.update(needed)
    page.append("```{toctree}\n:hidden:\n\nrooms\n```\n")
    site.write(PLACE, "\n".join(page))
    site.shown.update({name: f"{PLACE}#{anchor_of(title)}" for name, title in promised.items()})
