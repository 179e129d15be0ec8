#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the documentation site: it is made without a warning, its links lead to pages and headings that exist, and
reading it fetches nothing from elsewhere. Skipped where Sphinx is missing.

usage: site_test.py SOURCE PROGRAM_PAGES
"""
import html.parser
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

SOURCE, PROGRAM_PAGES = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
del sys.argv[1:]
MAKER = SOURCE / "scripts/site/site.py"
SKIPPED = 77
# Attributes whose file a browser fetches without being asked.
FETCHED = {"link": "href", "script": "src", "img": "src", "source": "src", "video": "src", "iframe": "src"}
URL = re.compile(r"url\(\s*['\"]?([^'\")]+)|@import\s+['\"]([^'\"]+)")


class Page(html.parser.HTMLParser):
    """The links, the fetched files and the anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.fetched, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(values[key] for key in ("id", "name") if values.get(key))
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        if tag in FETCHED and values.get(FETCHED[tag]):
            self.fetched.append(values[FETCHED[tag]])


def is_elsewhere(address):
    return address.startswith("/") or re.match(r"(?!data:)[a-z][a-z+.-]*:", address) is not None


def faults_of(site):
    """Returns what is wrong with the pages and styles of a site."""
    pages = {path: Page(path.read_text()) for path in site.rglob("*.html")}
    faults = []
    for path, page in pages.items():
        name = path.relative_to(site)
        faults += [f"{name}: fetches {address}" for address in page.fetched if is_elsewhere(address)]
        for address in page.links + [each for each in page.fetched if not is_elsewhere(each)]:
            if is_elsewhere(address) or address.startswith("data:"):
                continue
            target, _, anchor = address.partition("#")
            target = pathlib.Path(os.path.normpath(path.parent / urllib.parse.unquote(target.partition("?")[0]))) \
                if target else path
            if not target.exists():
                faults.append(f"{name}: {address} does not exist")
            elif anchor and target in pages and urllib.parse.unquote(anchor) not in pages[target].anchors:
                faults.append(f"{name}: {address} is no heading")
    for path in site.rglob("*.css"):
        addresses = [a or b for a, b in URL.findall(path.read_text())]
        faults += [f"{path.name}: fetches {address}" for address in addresses if is_elsewhere(address)]
    return faults


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.site = pathlib.Path(cls.folder.name) / "site"
        done = subprocess.run([sys.executable, MAKER, cls.site, PROGRAM_PAGES / "programs.md"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode == SKIPPED:
            raise unittest.SkipTest(done.stdout.strip())
        if done.returncode:
            raise AssertionError(done.stdout)

    def test_every_link_leads_somewhere_and_nothing_is_fetched_from_elsewhere(self):
        self.assertEqual(faults_of(self.site), [])

    def test_the_search_knows_words_of_all_kinds_of_pages(self):
        index = (self.site / "searchindex.js").read_text()
        for word in ("pentagon", "imagedist", "focus_stack", "colmap"):
            self.assertIn(word, index)
        for name in ("index", "tutorial", "gallery", "python/api", "cpp/index", "formats/path"):
            self.assertTrue((self.site / f"{name}.html").is_file(), name)

    def test_one_page_has_what_the_library_promises_in_the_order_of_reading(self):
        promised = [line.split(maxsplit=1) for line in (SOURCE / "lf/public_headers.txt").read_text().splitlines()
                    if line.startswith("lf/")]
        page = (self.site / "cpp/index.html").read_text()
        places = [page.find(f"<h2>{title}<") for _, title in promised]
        self.assertNotIn(-1, places)
        self.assertEqual(places, sorted(places))
        self.assertLess(page.find("lf::RenderFrame"), places[1])  # in the first example
        anchors = Page(page).anchors
        self.assertLessEqual({"openfilm", "renderframe", "framerenderer", "filmsettings", "rendercamera"}, anchors)
        for name in "LensWeights", "PixelFilter", "ImageOrder", "StopRule", "Aperture":  # of headers below lf/detail/
            self.assertIn(f"<code>{name}</code>", page)
        self.assertNotIn(">private<", page)
        self.assertEqual(sorted(path.name for path in (self.site / "cpp").iterdir()), ["index.html", "rooms.html"])

    def test_schemas_are_files_that_editors_read(self):
        for path in (SOURCE / "schemas").iterdir():
            self.assertEqual((self.site / "schemas" / path.name).read_text(), path.read_text())
        self.assertTrue((self.site / "files/schemas/path.schema.json.html").is_file())

    def test_every_program_has_its_options(self):
        page = Page((self.site / "programs.html").read_text())
        self.assertLessEqual({"lfrenderer", "lffocus-stack", "lfsynth"}, page.anchors)
        self.assertIn("--lens-weights", (self.site / "programs.html").read_text())

    def test_the_python_package_is_described_without_being_built(self):
        page = Page((self.site / "python/api.html").read_text())
        self.assertLessEqual({f"lfrendertools.{name}" for name in ("open", "render", "Camera", "focus_stack")},
                             page.anchors)

    def test_scripts_of_pages_are_no_modules(self):
        for script in (self.site / "_static").rglob("*.js"):
            self.assertNotRegex(script.read_text(), r"(?m)^import ", script.name)

    def test_a_folder_that_is_no_site_is_left_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            mine = pathlib.Path(folder) / "mine.txt"
            mine.write_text("mine")
            done = subprocess.run([sys.executable, MAKER, folder], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn("is not a site", done.stderr)
            self.assertEqual(mine.read_text(), "mine")


class Faults(unittest.TestCase):
    def test_planted_faults_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            site = pathlib.Path(folder)
            (site / "a.html").write_text('<img src="https://x.org/badge.svg"><a href="b.html">b</a><a href="#c">c</a>'
                                         '<h1 id="d"></h1><a href="a.html#d">d</a><a href="https://x.org">x</a>')
            (site / "a.css").write_text("@import url(/javascript/n.css); b { background: url(data:image/png,x) }")
            self.assertEqual(faults_of(site), ["a.html: fetches https://x.org/badge.svg",
                                               "a.html: b.html does not exist", "a.html: #c is no heading",
                                               "a.css: fetches /javascript/n.css"])


if __name__ == "__main__":
    result = unittest.main(exit=False, verbosity=2).result
    for _, reason in result.skipped:
        print(reason)
    sys.exit(1 if not result.wasSuccessful() else SKIPPED if result.skipped else 0)
