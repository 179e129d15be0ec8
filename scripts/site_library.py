# SPDX-License-Identifier: Apache-2.0
"""Makes the pages of the C++ library from its headers, for site.py: a page for each folder, with every public header
and the comment that it begins with."""
import pathlib

import folder_list
from comment_rules import LICENCE_TAG
from header_rules import OF_TESTS
from site_pages import Site, fenced

INTRODUCTION = """# The C++ library

A program includes one header, `lf/lfrendertools.h`. It opens light fields and films, and renders frames in memory and
films into folders, with the bits of `lfrenderer`. [lf/api](api.md) explains these functions. All that can be said of a
film is in [lf/render/settings](render-settings.md), what a light field holds in
[lf/light_field/model](light_field-model.md).

Each public header is the manual of what it declares: shapes, units, errors, and the place in the thesis. These pages
are made from the headers. [The library, room by room](rooms.md) shows how the folders work together.

`cmake --install` installs the library; another project finds it by `find_package(lfrendertools)` or `pkg-config`:

"""


def parts_of(text: str):
    """Returns the comment that a header begins with, and the rest."""
    lines = [line for line in text.splitlines() if LICENCE_TAG not in line]
    count = next((i for i, line in enumerate(lines) if not line.startswith("//")), len(lines))
    comment = "\n".join(line.removeprefix("//").removeprefix(" ") for line in lines[:count])
    return comment, "\n".join(lines[count:]).strip().removeprefix("#pragma once").strip()


def public_headers(root: pathlib.Path, folder: str, words: dict) -> list:
    internal = set(words.get("INTERNAL", ()))
    return [path for path in sorted((root / "lf" / folder).glob("*.h"))
            if path.name not in internal and not path.name.startswith(OF_TESTS)]


def comment_text(comment: str) -> str:
    """Returns a comment as Markdown. Paragraphs with formulas or columns stay as they are laid out."""
    paragraphs = []
    for paragraph in comment.split("\n\n"):
        is_laid_out = any(line.startswith("  ") or "   " in line.strip() for line in paragraph.splitlines())
        if is_laid_out:
            paragraphs.append(fenced(paragraph, "text"))
        else:
            escaped = "".join("\\" + c if c in "\\*_[]<>#|~$" else c for c in " ".join(paragraph.split("\n")))
            paragraphs.append(escaped + "\n")
    return "\n".join(paragraphs)


def folder_page(root: pathlib.Path, folder: str, headers: list) -> str:
    lines = [f"# lf/{folder}\n"]
    for path in headers:
        name = path.relative_to(root).as_posix()
        comment, rest = parts_of(path.read_text())
        lines.append(f"## {path.name}\n\n{comment_text(comment)}\n"
                     f"<details><summary><code>#include \"{name}\"</code></summary>\n\n{fenced(rest, 'cpp')}\n"
                     "</details>\n")
    return "\n".join(lines)


def write_library(site: Site):
    """Writes the pages below cpp/, and notes in site.shown which header is on which page."""
    pages = []
    folders = folder_list.read_folders(site.root)
    for folder, words in sorted(folders.items(), key=lambda item: item[0] != "api"):  # what is needed first comes first
        headers = public_headers(site.root, folder, words)
        if headers:
            page = f"cpp/{folder.replace('/', '-')}"
            site.write(page + ".md", folder_page(site.root, folder, headers))
            site.shown.update({path.relative_to(site.root).as_posix(): page + ".md" for path in headers})
            pages.append((folder, page.removeprefix("cpp/"), len(headers)))
    foreign = "find_package(lfrendertools REQUIRED)\ntarget_link_libraries(frame PRIVATE lfrendertools::lfrendertools)"
    example = (site.root / "tests/foreign/frame.cc").read_text()
    rows = "\n".join(f"| [lf/{folder}]({page}.md) | {count} |" for folder, page, count in pages)
    tree = "\n".join(page for _, page, _ in pages)
    site.write("cpp/index.md", f"{INTRODUCTION}{fenced(foreign, 'cmake')}\n"
               f"A program that renders a frame into a file:\n\n{fenced(example, 'cpp')}\n"
               f"## Folders\n\n| folder | public headers |\n| --- | --- |\n{rows}\n\n"
               f"```{{toctree}}\n:hidden:\n\nrooms\n{tree}\n```\n")
