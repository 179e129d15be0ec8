#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests scripts/release.sh on a small repository: a dry run changes nothing, a release is whole, and a state that
cannot be released is refused with its reason.

usage: release_test.py REPOSITORY
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

REPOSITORY = pathlib.Path(sys.argv.pop()).resolve()
SKIPPED = 77
FILES = ["VERSION", "CITATION.cff", "LICENSE", "LICENSES", ".reuse", "scripts",
         "blender/lfrendertools_blender/__init__.py", "blender/lfrendertools_blender/blender_manifest.toml"]
# Stands for ./test: counts its calls, and fails if the file "broken" exists.
TEST = "#!/bin/sh\ncd \"$(dirname \"$0\")\" && mkdir -p build && echo called >>build/calls && test ! -e build/broken\n"
TARBALL = ("#!/bin/sh\ngit archive --prefix=lfrendertools-0.1.0/ HEAD | xz >\"$1/lfrendertools-0.1.0.tar.xz\"\n"
           "echo made >\"$1/by_script\"\n")
OLD = "## 0.0.9 — 2020-01-31\n\n- Old.\n"
CHANGELOG = f"# Changelog\n\n## 0.1.0 — not released yet\n\n- A first line.\n- A second line.\n\n{OLD}"
# Commits need not survive a loss of power.
ENVIRONMENT = {**os.environ, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull,
               "GIT_CONFIG_COUNT": "1", "GIT_CONFIG_KEY_0": "core.fsync", "GIT_CONFIG_VALUE_0": "none",
               "GIT_AUTHOR_NAME": "A", "GIT_AUTHOR_EMAIL": "a@example.org",
               "GIT_COMMITTER_NAME": "A", "GIT_COMMITTER_EMAIL": "a@example.org"}


class Release(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for name in FILES:
            place = self.root / name
            place.parent.mkdir(parents=True, exist_ok=True)
            source = REPOSITORY / name
            if source.is_dir():
                shutil.copytree(source, place, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, place)
        (self.root / "scripts/release_tarball.sh").unlink(missing_ok=True)
        (self.root / "CHANGELOG.md").write_text(CHANGELOG)
        (self.root / ".gitignore").write_text("/build/\n__pycache__/\n")
        (self.root / "test").write_text(TEST)
        (self.root / "test").chmod(0o755)
        subprocess.run([sys.executable, self.root / "scripts/set_version.py", "0.1.0"], check=True, capture_output=True)
        self.git("init", "--quiet", "--initial-branch=main")
        self.commit("scripts: Begin")

    def git(self, *words):
        done = subprocess.run(["git", *words], cwd=self.root, env=ENVIRONMENT, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, (words, done.stderr))
        return done.stdout.strip()

    def commit(self, subject):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", subject)

    def release(self, *words):
        command = [self.root / "scripts/release.sh", *words]
        done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def state(self):
        """Returns everything that a dry run must not change."""
        files = {path.relative_to(self.root): path.read_bytes() for path in self.root.rglob("*")
                 if path.is_file() and not {".git", "__pycache__"} & set(path.parts)}
        return self.git("rev-parse", "HEAD"), self.git("tag"), self.git("status", "--porcelain"), files

    def expect_refusal(self, *reasons, version="0.1.0"):
        before = self.state()
        for words in ((version,), ("--dry-run", version)):
            code, out, err = self.release(*words)
            self.assertEqual((code, out), (1, ""), err)
            self.assertEqual(err.count("\n  - "), len(reasons), err)
            for reason in reasons:
                self.assertIn(reason, err)
        self.assertEqual(self.state(), before)

    def test_a_dry_run_says_what_it_would_do_and_changes_nothing(self):
        before = self.state()
        code, out, err = self.release("--dry-run", "0.1.0")
        self.assertEqual((code, err), (0, ""))
        for words in ("CHANGELOG.md and CITATION.cff", "Running ./test", "v0.1.0, with the 2 lines", "git archive",
                      "lfrendertools-0.1.0.tar.xz", "SHA256SUMS"):
            self.assertIn(words, out)
        self.assertEqual(self.state(), before)

    def test_a_release_is_dated_tested_tagged_and_packed(self):
        code, out, err = self.release("0.1.0")
        self.assertEqual(code, 0, err)
        self.assertEqual(self.git("log", "-1", "--format=%s"), "VERSION: Release 0.1.0")
        self.assertEqual(self.git("cat-file", "-t", "v0.1.0"), "tag")
        self.assertEqual(self.git("rev-parse", "v0.1.0^{commit}"), self.git("rev-parse", "HEAD"))
        self.assertEqual(self.git("for-each-ref", "--format=%(contents)", "refs/tags/v0.1.0"),
                         "lfrendertools 0.1.0\n\n- A first line.\n- A second line.")
        self.assertRegex((self.root / "CHANGELOG.md").read_text(), r"## 0\.1\.0 — \d{4}-\d\d-\d\d\n")
        self.assertRegex((self.root / "CITATION.cff").read_text(),
                         r"\nversion: 0\.1\.0\ndate-released: \d{4}-\d\d-\d\d\n")
        folder = self.root / "build/release-0.1.0"
        self.assertEqual({path.name for path in folder.iterdir()},
                         {"SHA256SUMS", "lfrendertools-0.1.0.tar.xz", "lfrendertools-0.1.0.spdx"})
        subprocess.run(["sha256sum", "--check", "--strict", "--quiet", "SHA256SUMS"], cwd=folder, check=True)
        with tarfile.open(folder / "lfrendertools-0.1.0.tar.xz") as archive:
            self.assertEqual(sorted(member.name for member in archive if member.isfile()),
                             sorted(f"lfrendertools-0.1.0/{name}" for name in self.git("ls-files").splitlines()))
            changelog = archive.extractfile("lfrendertools-0.1.0/CHANGELOG.md").read().decode()
        self.assertNotIn("not released yet", changelog)
        listed = (folder / "lfrendertools-0.1.0.spdx").read_text()
        for name in ("VERSION", "scripts/release.sh"):
            self.assertIn(f"FileName: ./{name}\n", listed)
        self.assertIn("LicenseInfoInFile: Apache-2.0\n", listed)
        # A second call makes no second commit or tag and tests nothing; it makes the files again.
        before = self.git("rev-parse", "HEAD"), self.git("rev-parse", "v0.1.0")
        (folder / "SHA256SUMS").unlink()
        self.assertEqual(self.release("0.1.0")[0], 0)
        self.assertEqual((self.git("rev-parse", "HEAD"), self.git("rev-parse", "v0.1.0")), before)
        self.assertTrue((folder / "SHA256SUMS").exists())
        self.assertEqual((self.root / "build/calls").read_text(), "called\n")

    def test_the_script_of_the_tarball_is_used_if_there_is_one(self):
        script = self.root / "scripts/release_tarball.sh"
        script.write_text(TARBALL)
        script.chmod(0o755)
        self.commit("scripts: Make tarballs")
        self.assertIn("by scripts/release_tarball.sh", self.release("--dry-run", "0.1.0")[1])
        self.assertEqual(self.release("0.1.0")[0], 0)
        self.assertTrue((self.root / "build/release-0.1.0/by_script").exists())

    def test_nothing_is_tagged_after_a_failed_test_and_the_next_call_goes_on(self):
        (self.root / "build").mkdir()
        (self.root / "build/broken").touch()
        code, _, err = self.release("0.1.0")
        self.assertEqual(code, 1)
        self.assertIn("./test failed, nothing is tagged", err)
        self.assertEqual(self.git("tag"), "")
        (self.root / "build/broken").unlink()
        self.assertEqual(self.release("0.1.0")[0], 0)
        self.assertEqual(self.git("tag"), "v0.1.0")
        self.assertEqual(self.git("rev-list", "--count", "HEAD"), "2")

    def test_changes_and_another_branch_are_refused(self):
        (self.root / "new.txt").write_text("new\n")
        self.git("switch", "--quiet", "--create", "work")
        self.expect_refusal("not committed; commit or remove them: ?? new.txt", "the branch is work")

    def test_another_version_is_refused(self):
        self.expect_refusal("the file VERSION says 0.1.0, not 0.2.0", version="0.2.0")
        self.expect_refusal("'v1' is no version", version="v1")

    def test_a_new_version_is_written_into_every_place(self):
        done = subprocess.run([sys.executable, self.root / "scripts/set_version.py", "0.2.13"], capture_output=True,
                              text=True, check=True)
        self.assertEqual(sorted(done.stdout.split()), sorted(self.git("diff", "--name-only").split()))
        self.assertEqual(set(done.stdout.split()), {"VERSION", "CITATION.cff", "CHANGELOG.md", *FILES[-2:]})
        self.assertIn('"version": (0, 2, 13),', (self.root / FILES[-2]).read_text())
        self.assertIn('schema_version = "1.0.0"', (self.root / FILES[-1]).read_text())
        self.assertIn("cff-version: 1.2.0", (self.root / "CITATION.cff").read_text())
        self.assertIn("## 0.2.13 — not released yet", (self.root / "CHANGELOG.md").read_text())
        house = [sys.executable, self.root / "scripts/check_house.py", self.root, "version"]
        self.assertEqual(subprocess.run(house, capture_output=True).returncode, 0)

    def test_places_that_disagree_are_refused(self):
        citation = self.root / "CITATION.cff"
        citation.write_text(citation.read_text().replace("version: 0.1.0", "version: 0.0.9"))
        (self.root / "CHANGELOG.md").write_text(CHANGELOG.replace("## 0.1.0", "## 0.3.0"))
        self.commit("CITATION.cff: Break")
        self.expect_refusal("CITATION.cff: states version 0.0.9", "its first section is '0.3.0'")

    def test_a_tag_of_another_commit_is_refused(self):
        self.git("tag", "v0.1.0")
        (self.root / "new.txt").write_text("new\n")
        self.commit("new.txt: Add it")
        self.expect_refusal("the tag v0.1.0 exists and is another commit")

    def test_a_changelog_without_lines_is_refused(self):
        (self.root / "CHANGELOG.md").write_text(f"# Changelog\n\n## 0.1.0 — not released yet\n\n{OLD}")
        self.commit("CHANGELOG.md: Empty it")
        self.expect_refusal("CHANGELOG.md has no lines for 0.1.0")


if __name__ == "__main__":
    if not shutil.which("reuse"):
        print("skipped: there is no reuse here (Debian package reuse)")
        sys.exit(SKIPPED)
    unittest.main()
