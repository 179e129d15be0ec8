# SPDX-License-Identifier: Apache-2.0
"""Copies the pages of the project into a folder that Sphinx makes the site of, for site.py.

Pages link to each other, to pictures, and to files and folders of the repository, by relative paths that a forge
understands. On the site, pages have other places, a file of the repository is a page with its text, and a folder is a
page with the names of its files.
"""
import os
import pathlib
import re
import subprocess

PICTURES = {".png", ".jpg", ".webp", ".svg"}
SHOWN = {".yaml": "yaml", ".py": "python", ".sh": "bash", ".h": "cpp", ".cc": "cpp", ".cmake": "cmake", ".json": "json",
         ".toml": "toml", ".mjs": "javascript", ".ts": "typescript", ".yml": "yaml"}
# Pages that have another place on the site than in the repository. Pages below doc/ lie at the root of the site, all
# others below project/.
PLACES = {"doc/site/index.md": "index.md", "doc/README.md": "pages.md", "doc/python/README.md": "python/index.md",
          "README.md": "project/overview.md", "CHANGELOG.md": "project/changes.md",
          "CONTRIBUTING.md": "project/contributing.md", "SECURITY.md": "project/security.md",
          "lf/README.md": "cpp/rooms.md"}
LINK = re.compile(r"(?P<before>\]\()(?P<target>[^)\s]+)(?=\))|(?P<attribute>\b(?:src|href)=\")(?P<quoted>[^\"]+)(?=\")")
FENCE = re.compile(r"^ *(`{3,}|~{3,})")


def files_of(root: pathlib.Path) -> list:
    """Returns the names of the files of the project, also of new ones that git does not know yet; in an unpacked
    archive, of all files except build outputs."""
    git = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                         capture_output=True)
    if git.returncode == 0 and git.stdout:
        names = git.stdout.decode().split("\0")
    else:
        names = [path.relative_to(root).as_posix() for path in root.rglob("*")
                 if path.relative_to(root).parts[0] not in {"build", "demo-output", ".git"}]
    return sorted({name for name in names if name and (root / name).is_file()})


def place_of(name: str) -> str:
    """Returns the place of a page on the site."""
    if name in PLACES:
        return PLACES[name]
    return name.removeprefix("doc/") if name.startswith("doc/") else f"project/{name}"


def fenced(text: str, language: str) -> str:
    """Returns a block of code, in a fence that is longer than those in the text."""
    longest = max((len(run) for run in re.findall(r"`{3,}", text)), default=2)
    fence = "`" * (longest + 1)
    return f"{fence}{language}\n{text.rstrip()}\n{fence}\n"


class Site:
    """The folder that Sphinx reads, and what has been copied into it."""

    def __init__(self, root: pathlib.Path, folder: pathlib.Path):
        self.root, self.folder = root, folder
        self.names = files_of(root)
        self.folders = {str(parent) for name in self.names for parent in pathlib.PurePosixPath(name).parents}
        # Pages of the repository that are pages of the site: all of doc/, and others where a link leads to them.
        self.waiting = [name for name in self.names if name.endswith(".md") and
                        (name.startswith("doc/") or name in PLACES)]
        self.copied = set(self.waiting)
        # {file of the repository: page of the site}, for files that generated pages show.
        self.shown = {}

    def write(self, place: str, text: str):
        path = self.folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def copy_pages(self):
        """Copies all pages, and what they link to."""
        while self.waiting:
            name = self.waiting.pop()
            if name.endswith(".md"):
                self.write(place_of(name), self.rewritten(name, (self.root / name).read_text()))
            elif name in self.folders:
                self.write(f"files/{name}/index.md", self.folder_page(name))
            else:
                self.write(f"files/{name}.md", self.file_page(name))

    def rewritten(self, name: str, text: str) -> str:
        """Returns the text of a page with the links that it needs at its place on the site."""
        lines, fence = [], None
        for line in text.splitlines():
            match = FENCE.match(line)
            if match and fence is None:
                fence = match[1]
            elif match and match[1].startswith(fence):
                fence = None
            elif fence is None:
                line = LINK.sub(lambda m: self.link(name, m), line)
            lines.append(line)
        return "\n".join(lines) + "\n"

    def link(self, name: str, match) -> str:
        before = match["before"] or match["attribute"]
        return before + self.target(name, match["target"] or match["quoted"])

    def target(self, name: str, target: str) -> str:
        """Returns a link of the page `name` of the repository as the site needs it."""
        if re.match(r"[a-z]+:|#", target):
            return target
        path, _, anchor = target.partition("#")
        linked = os.path.normpath(os.path.join(os.path.dirname(name), path))
        here = os.path.dirname(place_of(name))
        place = self.place_of_linked(name, linked)
        return os.path.relpath(place, here or ".") + (f"#{anchor}" if anchor else "")

    def place_of_linked(self, name: str, linked: str) -> str:
        """Returns the place of a file or folder that a page links to, and has it copied if it is new."""
        if linked in self.shown:
            return self.shown[linked]
        if linked not in self.folders and linked not in self.names:
            raise SystemExit(f"{name}: the link to '{linked}' leads nowhere")
        if pathlib.PurePosixPath(linked).suffix in PICTURES:
            place = linked.removeprefix("doc/")
            path = self.folder / place
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes((self.root / linked).read_bytes())
            return place
        readme = f"{linked}/README.md"
        if linked in self.folders and readme in self.names:
            linked = readme
        if linked not in self.copied:
            self.copied.add(linked)
            self.waiting.append(linked)
        if linked.endswith(".md"):
            return place_of(linked)
        return f"files/{linked}/index.md" if linked in self.folders else f"files/{linked}.md"

    def folder_page(self, name: str) -> str:
        inside = [file for file in self.names if file.startswith(name + "/")]
        listing = "\n".join(file.removeprefix(name + "/") for file in inside)
        shown = "".join(f"\n## {file.removeprefix(name + '/')}\n\n{self.code_of(file)}" for file in inside
                        if len(inside) <= 8 and (self.root / file).stat().st_size < 20000)
        return f"---\norphan: true\n---\n# {name}/\n\nThe files of this folder of the source:\n\n" \
               f"{fenced(listing, 'text')}{shown}"

    def file_page(self, name: str) -> str:
        return f"---\norphan: true\n---\n# {name}\n\n{self.code_of(name)}"

    def code_of(self, name: str) -> str:
        path = pathlib.PurePosixPath(name)
        text = (self.root / name).read_text()
        language = SHOWN.get(path.suffix, "cmake" if path.name == "CMakeLists.txt" else "text")
        if text.startswith("#!/usr/bin/env bash"):
            language = "bash"
        return fenced(text, language)
