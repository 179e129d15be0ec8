#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the documentation site: the pages of the project, of the C++ library and of the Python package, as HTML.

usage: scripts/site/site.py OUT [PROGRAMS.md]

OUT          receives index.html and everything that it needs. Nothing in it is fetched from elsewhere, the search
             included: it can be read from a folder, from an archive, or from any server. Pages of an earlier call are
             replaced.
PROGRAMS.md  the page of all options that a build makes (build/release/program_pages/programs.md). Without it, the site
             has the list of the programs instead.

Needs the packages of scripts/packages/site.txt (scripts/site.sh installs them). Every warning of Sphinx is an error.
Exit codes: 0 success, 1 a page has a fault, 2 wrong usage, 77 Sphinx or one of its extensions is missing.
"""
import importlib.util
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "house"))
import site_library
import site_pages
import site_theme

ROOT = pathlib.Path(__file__).resolve().parents[2]
NEEDED = {"sphinx": "python3-sphinx", "myst_parser": "python3-myst-parser", "furo": "furo",
          "sphinx_copybutton": "python3-sphinx-copybutton"}
MISSING = 77
PYTHON_PAGE = """# Python: every class and function

This page is made from the docstrings of the package. [How to use it](index.md) tells how to install it, and shows
examples.

```{eval-rst}
.. automodule:: lfrendertools
   :members:
   :imported-members:
```
"""
PROGRAM_LIST = re.compile(r"<!-- table: scripts/doc_tables.py programs -->\n(.*?)<!-- end of table -->", re.S)
TREE = re.compile(r"```\{toctree\}\n(?P<options>(?::.*\n)*)\n(?P<pages>(?:.+\n)*)```")


def add_unlisted_pages(site: site_pages.Site):
    """Adds pages that no contents of the front page list to its last contents, so that a new page of doc/ is found."""
    index = site.folder / "index.md"
    text = index.read_text()
    trees = list(TREE.finditer(text))
    listed = {line.strip().rpartition("<")[2].rstrip(">") for tree in trees for line in tree["pages"].splitlines()}
    pages = {place.removesuffix(".md") for place in map(site_pages.place_of, site.copied) if
             place.endswith(".md") and (site.folder / place).is_file()}
    is_new = pages - listed - {"index", "cpp/rooms"}
    end = trees[-1].end("pages")
    index.write_text(text[:end] + "".join(f"{page}\n" for page in sorted(is_new)) + text[end:])


def page_of_programs(programs) -> str:
    """Returns the page of all options, or, if no build made it, a page with the list of the programs."""
    if programs:
        return programs.read_text()
    table = PROGRAM_LIST.search((ROOT / "README.md").read_text())[1]
    return f"# The programs\n\n`--help-all` of each program shows all of its options.\n\n{table}"


def make_site(out: pathlib.Path, programs) -> int:
    with tempfile.TemporaryDirectory(prefix="lf-site-") as scratch:
        site = site_pages.Site(ROOT, pathlib.Path(scratch) / "pages")
        site_library.write_library(site)
        site.write("python/api.md", PYTHON_PAGE)
        site.write("programs.md", page_of_programs(programs))
        site.copy_pages()
        add_unlisted_pages(site)
        made = pathlib.Path(scratch) / "html"
        done = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-j", "auto", "-b", "html",
                               "-d", pathlib.Path(scratch) / "trees", "-c", ROOT / "doc/site", site.folder, made])
        if done.returncode:
            print("error: Sphinx found faults in the pages; they are listed above", file=sys.stderr)
            return 1
        (made / ".buildinfo").unlink(missing_ok=True)
        site_theme.mend(made)
        shutil.copytree(ROOT / "schemas", made / "schemas")  # editors read them by their addresses
        if out.exists():
            shutil.rmtree(out)
        shutil.copytree(made, out)
    print(f"Made {sum(1 for _ in out.rglob('*.html'))} pages: {out / 'index.html'}")
    return 0


def main() -> int:
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    missing = [package for module, package in NEEDED.items() if importlib.util.find_spec(module) is None]
    if missing:
        print(f"skipped: these packages make the site and are missing: {' '.join(missing)} "
              "(scripts/install_packages.sh site)", file=sys.stderr)
        return MISSING
    out = pathlib.Path(sys.argv[1])
    if out.exists() and not (out / "searchindex.js").exists() and (not out.is_dir() or any(out.iterdir())):
        print(f"error: {out} exists and is not a site that this script made; name another folder", file=sys.stderr)
        return 2
    programs = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else None
    if programs and not programs.is_file():
        print(f"error: there is no {programs}: build the target program_pages, or leave the argument out",
              file=sys.stderr)
        return 2
    return make_site(out, programs)


if __name__ == "__main__":
    sys.exit(main())
