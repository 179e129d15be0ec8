#!/usr/bin/python3
"""The checks of scripts/ must fire: each planted fault is found, and nothing else.

usage: check_house_test.py REPOSITORY
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(sys.argv.pop()).resolve()


def run(script, root, *arguments):
    command = [sys.executable, REPOSITORY / "scripts" / script, ".", *arguments]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True)
    return done.returncode, done.stdout.splitlines()


class PlantedFaults(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)

    def plant(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def expect(self, script, *arguments, faults):
        code, lines = run(script, self.root, *arguments)
        self.assertEqual(code, 1 if faults else 0, lines)
        for fault in faults:
            self.assertTrue(any(line.startswith(fault) for line in lines), (fault, lines))
        if faults:
            self.assertEqual(len(lines), len(faults), lines)

    def test_a_source_of_501_lines_is_too_long(self):
        self.plant("lf/core/long.cc", "int x;\n" * 501)
        self.plant("lf/core/just.cc", "int x;\n" * 500)
        self.expect("check_house.py", "lengths", faults=["lf/core/long.cc: 501"])

    def test_paths_of_a_machine_are_found_wherever_they_are(self):
        self.plant("lf/core/a.h", "// see /" + "work/shared/notes\n")
        self.plant("doc/a.md", "fine\n\nin /" + "root/build\n")
        self.plant("doc/b.md", "build/work/x, ../root/y, $HOME/work/z\n")
        self.expect("check_house.py", "paths", faults=["lf/core/a.h:1", "doc/a.md:3"])

    def test_links_must_lead_somewhere(self):
        self.plant("doc/there.md", "# A heading, here\n[up](#a-heading-here)\n")
        self.plant("README.md", "[a](doc/there.md#a-heading-here) [b](https://example.org/x)\n"
                                "[c](doc/gone.md)\n[d](doc/there.md#nowhere)\n[e](../outside.md)\n"
                                "`lf/core/gone.h`\n`core.Suite.Gone`\n`core.Suite.There` `tests.there`\n"
                                "`tests.gone`\n")
        self.plant("tests/CMakeLists.txt", "add_test(NAME tests.there COMMAND x)\n")
        self.plant("lf/core/x_test.cc", "TEST(Suite, There) {}\n")
        self.expect("check_house.py", "links",
                    faults=[f"README.md:{line}" for line in (2, 3, 4, 5, 6, 8)])

    def test_pages_that_comments_name_must_exist(self):
        self.plant("lf/core/a.h", "// see doc/there.md and doc/" + "gone.md\n")
        self.plant("doc/there.md", "")
        self.expect("check_house.py", "pages", faults=["lf/core/a.h:1: the page doc/" + "gone.md"])

    def test_includes_against_the_flow_are_found(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/core/a.cc", '#include "lf/camera/b.h"\n#include <yaml-cpp/yaml.h>\n')
        self.plant("lf/camera/CMakeLists.txt", "lf_folder(camera DEPENDS core)\n")
        self.plant("lf/camera/b.h", '#include "lf/core/c.h"\n#include "tools/common/d.h"\n')
        self.expect("check_includes.py",
                    faults=["lf/core/a.cc:1", "lf/core/a.cc:2", "lf/camera/b.h:2"])

    def test_a_clean_house_has_no_faults(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/core/a.cc", "#include <vector>\n")
        for check in ("lengths", "paths", "links", "pages"):
            self.expect("check_house.py", check, faults=[])
        self.expect("check_includes.py", faults=[])


if __name__ == "__main__":
    unittest.main()
