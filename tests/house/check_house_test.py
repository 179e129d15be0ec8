#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the checks of scripts/: each planted fault must be found, and nothing else.

usage: check_house_test.py REPOSITORY
"""
import datetime
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(sys.argv.pop()).resolve()
sys.path.insert(0, str(REPOSITORY / "scripts/house"))

import commit_rules
import function_text

FIRST = datetime.datetime.fromisoformat("2026-01-02T00:00:00+00:00")


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

    def test_a_source_of_801_lines_is_too_long_and_one_of_501_is_noted(self):
        self.plant("lf/core/fine.cc", "int x;\n" * 500)
        self.plant("lf/core/long.cc", "int x;\n" * 800)
        code, lines = run("check_house.py", self.root, "lengths")
        self.assertEqual((code, lines), (0, ["note: lf/core/long.cc: 800 lines; has it parts that can be read alone?",
                                             "2 files, no fault"]))
        self.plant("lf/core/long.cc", "int x;\n" * 801)
        self.expect("check_house.py", "lengths", faults=["lf/core/long.cc: 801"])

    def test_paths_of_a_machine_are_found_wherever_they_are(self):
        self.plant("lf/core/a.h", "// see /" + "work/shared/notes\n")
        self.plant("doc/a.md", "fine\n\nin /" + "root/build\n")
        self.plant("doc/b.md", "build/work/x, ../root/y, $HOME/work/z\n")
        self.plant("tests/--threads/frame.txt", "left by a program that was called wrongly\n")
        self.expect("check_house.py", "paths", faults=["lf/core/a.h:1", "doc/a.md:3", "tests/--threads/frame.txt"])

    def test_comments_begin_with_their_subject_and_end_without_too(self):
        self.plant("lf/core/a.h", "// Returns the size.\nint Size();  // Of it.\n\n"
                                  "// What is left\n// of it.\nint Left();\nint Both();  // is it one, too\n"
                                  "// Offers the same.\n")
        self.plant("scripts/a.py", '"""Where it is."""\nx = "# Of a string"  ' "# What it is\n")
        self.expect("check_house.py", "comments",
                    faults=["lf/core/a.h:2", "lf/core/a.h:4", "lf/core/a.h:7", "scripts/a.py:1", "scripts/a.py:2"])

    def test_messages_of_the_library_name_options_by_their_keys(self):
        self.plant("lf/core/a.cc", 'Error E() {\n  // --mode is an option.\n  return UsageError(\n'
                                   '      "a.png: leave "\n      "out --mode");\n}\n'
                                   'const char* const dashes = "a--b, ---";\n'
                                   'const char* const key = "{mode rebin}";\n')
        self.plant("lf/core/a_test.cc", 'EXPECT_EQ(Spelled("{mode}"), "--mode");\n')
        self.plant("tools/a.cc", 'return UsageError("--mode");\n')
        self.plant("lf/distribute/cluster/job.cc", 'Call({"--resume", "--engine=array"});\nSay("add --resume");\n')
        self.plant("lf/distribute/cluster/slurm.cc", 'Write("#SBATCH --requeue");\n')
        self.plant("lf/distribute/cluster/run_package.cc", 'Call({});\n')
        self.expect("check_house.py", "options",
                    faults=["lf/core/a.cc:4", "lf/distribute/cluster/job.cc:2",
                            "lf/distribute/cluster/run_package.cc: has no option"])

    def test_the_licence_is_stated_once_in_the_first_lines(self):
        line = "SPDX-License-" "Identifier: Apache-2.0"
        first = "// Internal to the tests. Returns 1.\n"
        before = {"lf/core/a.cc": first + "int x;\n", "lf/core/b.h": f"// {line}\n{first}", "lf/core/empty.h": "",
                  "lf/core/late.h": f"{first}// {line}\n",
                  "scripts/a.py": '#!/usr/bin/python3\n"""Does a."""\n',
                  "scripts/b.sh": "# Does b.\n", "run": "#!/usr/bin/env bash\n# Runs.\n", "web/a.css": "a {}\n",
                  "web/a.html": "<!doctype html>\n<p>x\n", "README.md": "# A\n", "fuzz/corpus/a/x.h": "int\n"}
        after = {**before, "lf/core/a.cc": f"// {line}\n{before['lf/core/a.cc']}",
                 "lf/core/late.h": f"// {line}\n{first}",
                 "scripts/a.py": f'#!/usr/bin/python3\n# {line}\n"""Does a."""\n',
                 "scripts/b.sh": f"# {line}\n# Does b.\n", "run": f"#!/usr/bin/env bash\n# {line}\n# Runs.\n",
                 "web/a.css": f"/* {line} */\na {{}}\n",
                 "web/a.html": f"<!doctype html>\n<!-- {line} -->\n<p>x\n"}
        for name, text in before.items():
            self.plant(name, text)

        self.expect("check_house.py", "licences", faults=[name for name in before if before[name] != after[name]])
        for _ in range(2):  # the second call changes nothing
            subprocess.run([sys.executable, REPOSITORY / "scripts/house/licence_headers.py", "--write", self.root],
                           check=True, capture_output=True)
            self.assertEqual({name: (self.root / name).read_text() for name in before}, after)
        self.expect("check_house.py", "comments", faults=[])
        self.plant("lf/core/a.cc", f"// {line}\n// What x is.\nint x;\n")
        self.expect("check_house.py", "comments", faults=["lf/core/a.cc:2"])
        self.plant("lf/core/a.xyz", "int x;\n")
        self.plant("run", f"#!/usr/bin/env bash\n# {line}\nsed -n '4" "s/^# //p' run\n")
        self.expect("check_house.py", "licences", faults=["lf/core/a.xyz:1: ", "run:3: "])

    def test_links_must_lead_somewhere(self):
        self.plant("doc/there.md", "# A heading, here\n[up](#a-heading-here)\n")
        self.plant("README.md", "[a](doc/there.md#a-heading-here) [b](https://example.org/x)\n"
                                "[c](doc/gone.md)\n[d](doc/there.md#nowhere)\n[e](../outside.md)\n"
                                "`lf/core/gone.h`\n`core.Suite.Gone`\n`core.Suite.There` `tests.there`\n"
                                "`tests.gone`\n`core.inner.Suite.There` `tools.Suite.There`\n"
                                "`inner.Suite.There`\n`core.inner.Suite.Gone`\n")
        self.plant("tests/CMakeLists.txt", "lf_program_test(tests.there lfrenderer)\n")
        for folder in ("lf/core", "lf/core/inner", "tools/common"):
            self.plant(f"{folder}/x_test.cc", "TEST(Suite, There) {}\n")
        self.expect("check_house.py", "links",
                    faults=[f"README.md:{line}" for line in (2, 3, 4, 5, 6, 8, 10, 11)])

    def test_pages_that_comments_name_must_exist(self):
        self.plant("lf/core/a.h", "// see doc/there.md and doc/" + "gone.md\n")
        self.plant("doc/there.md", "")
        self.expect("check_house.py", "pages", faults=["lf/core/a.h:1: the page doc/" + "gone.md"])

    def test_includes_against_the_flow_are_found(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/core/a.cc", '#include "lf/camera/b.h"\n#include <yaml-cpp/yaml.h>\n')
        self.plant("lf/camera/CMakeLists.txt", "lf_folder(camera DEPENDS core)\n")
        self.plant("lf/camera/b.h", '#include "lf/core/c.h"\n#include "tools/common/d.h"\n')
        self.expect("check_house.py", "includes",
                    faults=["lf/core/a.cc:1", "lf/core/a.cc:2", "lf/camera/b.h:2"])

    def test_command_lines_are_found_outside_of_the_programs(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/core/a.cc", "")
        self.plant("tools/lfa.cc", '#include <CLI/CLI.hpp>\n#include "tools/common/d.h"\n')
        self.plant("tools/CMakeLists.txt", "target_link_libraries(lfa PRIVATE CLI11::CLI11)\n")
        self.plant("python/src/b.cc", '#include "python/src/b.h"\n#include "lf/core/a.h"\n')
        self.plant("python/CMakeLists.txt", "# Nothing of tools/.\nadd_library(b src/b.cc)\n")
        self.plant("tests/c.cc", '#include "tools/common/d.h"\n')
        self.expect("check_house.py", "includes", faults=[])
        self.plant("lf/core/a.cc", "#include <CLI/CLI.hpp>\n")
        self.plant("python/src/b.cc", '#include "lf/core/a.h"\n#include "tools/common/d.h"\n#include "tests/e.h"\n'
                                      "#include <CLI/App.hpp>\n")
        self.plant("python/CMakeLists.txt", 'set(others "${PROJECT_SOURCE_DIR}/tools/d.cc")\n'
                                            "target_link_libraries(b CLI11::CLI11)\n")
        self.plant("tests/c.cc", "#include <CLI/CLI.hpp>\n")
        self.expect("check_house.py", "includes", faults=[
            "lf/core/a.cc:1: <CLI/CLI.hpp> belongs to tools", "python/src/b.cc:2: python stands on lf alone",
            "python/src/b.cc:3: python stands on lf alone", "python/src/b.cc:4: <CLI/App.hpp>",
            "python/CMakeLists.txt:1: only tools may have tools/", "python/CMakeLists.txt:2: only tools may have CLI11",
            "tests/c.cc:1: <CLI/CLI.hpp>"])

    def test_folders_inside_others_are_named_by_their_paths(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/core/a.cc", "#include <vector>\n")
        self.plant("lf/camera/path/CMakeLists.txt", "lf_folder(camera/path DEPENDS core)\n")
        self.plant("lf/camera/path/b.h", '#include "lf/camera/path/c.h"\n#include "lf/core/a.h"\n')
        self.expect("check_house.py", "includes", faults=[])
        self.plant("lf/camera/path/b.h", '#include "lf/camera/c.h"\n#include "lf/core/path/a.h"\n')
        self.plant("lf/camera/spline/CMakeLists.txt", "lf_folder(spline DEPENDS path core)\n")
        self.plant("lf/film/d.h", "")
        self.expect("check_house.py", "includes", faults=[
            "lf/camera/path/b.h:1: camera/path may not include", "lf/camera/path/b.h:2",
            "lf/camera/spline/CMakeLists.txt: lf_folder names spline",
            "lf/camera/spline/CMakeLists.txt: DEPENDS names path", "lf/film/d.h: no lf_folder"])

    def test_cycles_of_rooms_are_found(self):
        folders = {"core": "", "film/plate": "core", "film/develop": "film/plate render/state",
                   "render/state": "core film/plate", "render/pipeline": "render/state", "view": "render/pipeline"}
        for folder, others in folders.items():
            self.plant(f"lf/{folder}/CMakeLists.txt", f"lf_folder({folder} SOURCES a.cc DEPENDS {others})\n")
            self.plant(f"lf/{folder}/a.cc", "")
        self.expect("check_house.py", "includes", faults=[
            "lf/film/develop/CMakeLists.txt: DEPENDS render/state is part",
            "lf/render/state/CMakeLists.txt: DEPENDS film/plate is part"])
        self.plant("lf/film/develop/CMakeLists.txt", "lf_folder(film/develop DEPENDS film/plate)\n")
        self.expect("check_house.py", "includes", faults=[])

    def test_internal_headers_stay_in_their_folders(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core DEPENDS)\n")
        self.plant("lf/core/fine.h", "// It sorts. Internal\n// to this folder.\n#pragma once\n")
        self.plant("lf/core/shared.h", "// It sorts. Internal to core and film/plate.\n#pragma once\n")
        self.plant("lf/core/open.h", "// It sorts.\n#pragma once\n// Internal to core.\n")
        self.plant("lf/core/a.cc", '#include "lf/core/fine.h"\n')
        self.plant("lf/film/plate/CMakeLists.txt", "lf_folder(film/plate DEPENDS core)\n")
        self.plant("lf/film/plate/a.cc", '#include "lf/core/shared.h"\n#include "lf/core/open.h"\n')
        self.plant("lf/film/plate/b.h", '#pragma once\n#include "lf/core/fine.h"\n')
        self.plant("tools/a.cc", '#include "lf/core/shared.h"\n')
        self.expect("check_house.py", "headers", faults=["lf/film/plate/b.h:2: lf/core/fine.h is internal to core",
                                                         "tools/a.cc:1: lf/core/shared.h is internal to core, film"])

    def test_promised_headers_include_only_what_other_programs_may_get(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core DEPENDS)\n")
        self.plant("lf/public_headers.txt", "# A list.\nlf/lfrendertools.h  Begin\nlf/core/a.h  A\nlf/core/b.h  B\n")
        self.plant("lf/lfrendertools.h", '#include "lf/core/a.h"\n')
        self.plant("lf/core/a.h", '#include "lf/core/c.h"\n')
        self.plant("lf/core/c.h", "// Internal to core.\n")
        self.expect("check_house.py", "headers", faults=[
            "lf/public_headers.txt: lf/core/b.h does not exist", "lf/lfrendertools.h: does not include lf/core/b.h",
            "lf/core/c.h: promised headers (lf/public_headers.txt) include it, but it is internal"])
        many = [f"lf/core/many{i}.h" for i in range(40)]
        for name in many:
            self.plant(name, "// A.\n")
        self.plant("lf/core/a.h", "".join(f'#include "{name}"\n' for name in ["lf/core/b.h", *many]))
        self.plant("lf/core/b.h", "// B.\n")
        self.expect("check_house.py", "headers", faults=["lf/public_headers.txt: promised headers include 40 other"])

    RENDERS = ["lfrenderer f p.yaml -o out --mode collect --estimator nearest --lens-weights none",
               "lfrenderer f p.yaml -o out"]
    DEFAULTS = ["lfrenderer --mode collect", "lfrenderer --estimator auto", "lfrenderer --lens-weights auto"]

    def plant_table(self, name, text="| a |\n| --- |\n| 1.25 s |\n", **changed):
        """Plants a page with one table, and its record."""
        record = {"table": f"bench/{name}.py", "commit": "abc", "date": "2026-01-01", "machine": "m", "load": 0,
                  "commands": self.RENDERS, "defaults": self.DEFAULTS} | changed
        record.setdefault("defaults_hash",
                          hashlib.sha256("\n".join(record["defaults"]).encode()).hexdigest()[:16])
        self.plant(f"doc/{name}.md", f"# Page\n<!-- table: bench/{name}.py -->\n{text}<!-- end of table -->\n")
        self.plant(f"bench/results/{name}.json", json.dumps(record))
        self.plant(f"bench/results/{name}.md", text)
        self.plant("bench/defaults.txt", "# Listed.\n" + "\n".join(self.DEFAULTS) + "\n")

    def test_tables_fit_their_records_and_the_defaults_of_today(self):
        self.plant_table("fine")
        self.plant_table("more", defaults=self.DEFAULTS[:1])  # the record was made before some options existed
        self.expect("check_house.py", "tables", faults=[])
        self.plant_table("old", defaults=["lfrenderer --mode rebin", *self.DEFAULTS[1:]])
        self.plant_table("edited")
        self.plant("bench/results/edited.md", "| a |\n| --- |\n| 1.24 s |\n")
        self.plant_table("hash", defaults_hash="0" * 16)
        self.plant_table("unnamed", commands=self.RENDERS[1:])
        self.plant_table("no-default", commands=self.RENDERS[:1])
        self.plant_table("named-default", commands=[*self.RENDERS[:1],
                                                    "lfrenderer f p.yaml -o o --mode collect --lens-weights auto"])
        self.plant_table("bare")
        (self.root / "bench/results/bare.json").unlink()
        self.plant("bench/results/lonely.json", json.dumps({"table": "bench/lonely.py"}))
        self.plant("bench/results/broken.json", "{}")
        self.expect("check_house.py", "tables", faults=[
            "doc/old.md:2: made when a default was 'lfrenderer --mode rebin'", "doc/edited.md:2: the table is not that",
            "doc/hash.md:2: bench/results/hash.json: defaults_hash",
            "doc/unnamed.md:2: bench/results/unnamed.json: none of its renders names --mode",
            "doc/no-default.md:2: bench/results/no-default.json: none of its renders is that of the defaults",
            "doc/bare.md:2: no record", "bench/results/lonely.json: no page shows",
            "bench/results/broken.json: not the record"])

    def test_stale_tables_are_listed_and_no_others(self):
        self.plant_table("bare")
        (self.root / "bench/results/bare.json").unlink()
        self.plant("bench/results/broken.json", "{}")
        listed = "# Listed.\nbench/bare.py\nbench/results/broken.json\n"
        self.plant("bench/stale_tables.txt", listed)
        self.expect("check_house.py", "tables", faults=[])
        self.plant_table("fine")
        self.plant("bench/stale_tables.txt", listed + "bench/fine.py\nbench/gone.py\n")
        self.expect("check_house.py", "tables", faults=[
            "doc/fine.md:2: bench/stale_tables.txt lists it", "bench/stale_tables.txt: bench/gone.py: there is no"])

    def test_tables_of_figures_need_markers(self):
        figures = "| a | b |\n| --- | --- |\n| 1.5 s | 3 ms |\n| 7 MiB | 2.25 |\n"
        self.plant("doc/bare.md", figures)
        self.plant("doc/said.md", "<!-- table by hand: a history -->\n\n" + figures)
        self.plant("doc/few.md", "| a | b |\n| --- | --- |\n| 1.5 s | 3 ms |\n| Eq. 2.25 | Fig. 2.25, 2.26 |\n")
        self.plant("doc/open.md", "<!-- table: bench/x.py -->\n")
        self.plant("doc/closed.md", "<!-- end of table -->\n")
        self.expect("check_house.py", "tables", faults=[
            "doc/bare.md:1: a table of figures without markers", "doc/open.md:1: the table has no line",
            "doc/closed.md:1: a table ends that has no beginning"])

    def plant_generated(self, page, name, text):
        self.plant(page, f"# Page\n<!-- table: scripts/doc_tables.py {name} -->\n{text}<!-- end of table -->\n")

    def test_generated_tables_say_what_the_sources_say(self):
        self.plant("lf/CMakeLists.txt", "add_subdirectory(core)\n")
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/optics/camera/CMakeLists.txt", "lf_folder(optics/camera\n  DEPENDS core\n  LIBS x)\n")
        self.plant("lf/path/CMakeLists.txt", "lf_folder(path DEPENDS core optics/camera)\n")
        text = ("| folder | may include |\n| --- | --- |\n"
                "| core | nothing, but every folder may include it; it is left out below |\n"
                "| optics/camera | no other |\n| path | optics/camera |\n")
        self.plant_generated("doc/layout.md", "folders", text)
        self.expect("check_house.py", "tables", faults=[])
        self.plant_generated("doc/layout.md", "folders", text.replace("path | optics/camera", "path | no other"))
        self.plant_generated("README.md", "recipes", "| a |\n")
        self.expect("check_house.py", "tables", faults=[
            "doc/layout.md:2: the sources say something else", "README.md:2: scripts/doc_tables.py makes no table"])
        self.plant("README.md", "")
        self.expect("doc_tables.py", "--write", faults=[])
        self.expect("doc_tables.py", faults=[])
        self.plant("lf/path/CMakeLists.txt", "lf_folder(path DEPENDS core lens)\n")
        self.expect("check_house.py", "tables", faults=["doc/layout.md:2: a folder of lf/ depends on lens"])

    def test_every_generated_table_is_shown_and_every_folder_has_a_task(self):
        self.plant("scripts/doc_tables.py", "")
        self.plant("lf/README.md", "| `core` | value | a task |\n")
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/optics/camera/CMakeLists.txt", "lf_folder(optics/camera DEPENDS core)\n")
        names = ("rooms", "folders", "programs", "common-options", "exit-codes", "exit-codes-in-help",
                 "format-versions")
        self.expect("check_house.py", "tables", faults=[
            "lf/README.md: no row of the table is that of lf/optics/camera",
            *(f"scripts/doc_tables.py: no page shows the table {name}" for name in names)])

    KINDS = """// Two more:
//   0  done
//   1  a bug
enum class ErrorKind {
  // Wrong usage: see
  // --help.
  kUsage = 2,
};
"""

    def test_exit_codes_of_pages_and_help_are_those_of_the_enumeration(self):
        self.plant("lf/base/core/result.h", self.KINDS)
        self.plant("tools/common/help.h", 'kExitCodes =\n    "Exit codes: 0 done, 1 a "\n    "bug, 2 usage.";\n')
        self.plant_generated("doc/codes.md", "exit-codes", "| code | means |\n| --- | --- |\n| 0 | done |\n"
                             "| 1 | a bug |\n| 2 | wrong usage: see `--help` |\n")
        self.plant_generated("README.md", "exit-codes-in-help", "Exit codes: 0 done, 1 a bug, 2 usage.\n")
        self.expect("check_house.py", "tables", faults=[])
        self.plant("lf/base/core/result.h", self.KINDS.replace("kUsage = 2", "kUsage = 3"))
        self.expect("check_house.py", "tables", faults=["doc/codes.md:2: the sources say something else",
                                                        "README.md:2: kExitCodes in tools/common/help.h lists"])

    def test_no_program_is_forgotten(self):
        self.plant("tools/common/programs.h", 'ListedProgram{"lfone", "one", "Does one thing."},\n')
        self.plant("tools/CMakeLists.txt", "lf_tool(lfr)\nlf_tool(lfone LIBS x)\n")
        self.plant("tests/helpers/common_options.py", 'OFFERED = {\n    "lfone": {"-q"},\n    "lfr": set(),\n}\n')
        self.plant("scripts/valgrind.sh", "check lfone --list\ncheck lfr one --list\n")
        self.expect("check_house.py", "programs", faults=[])
        self.plant("scripts/valgrind.sh", "check lfr one --list\n")
        self.plant("tools/CMakeLists.txt", "lf_tool(lfr)\nlf_tool(lfone LIBS x)\nlf_tool(lftwo)\n")
        self.expect("check_house.py", "programs", faults=[
            "scripts/valgrind.sh: has no lfone, which tools/common/programs.h lists",
            "tools/CMakeLists.txt: names lftwo, which tools/common/programs.h does"])

    def test_programs_and_their_options_are_those_of_the_sources(self):
        self.plant("tools/CMakeLists.txt", "lf_tool(lfone)\nlf_tool(lftwo LIBS x)\n")
        self.plant("tools/lfone.cc", '.summary =\n    "Does one "\n    "thing.",\n.usage = "  lfone A|B [OPTIONS]",\n')
        self.plant("tools/common/programs.h", 'ListedProgram{"lftwo", "two",\n  "Does "\n  "two."},\n')
        self.plant("tools/lftwo.cc", '.summary = lf::SummaryOf("lftwo"),\n'
                   '.usage = R"(  lftwo A -o B [OPTIONS]\n  lftwo C)",\n')
        self.plant("tests/helpers/common_options.py",
                   'COMMON = {"-q": ("-q A|B", "no words"), "-v": ("-v", "more")}\n'
                   'OFFERED = {"lfone": {"-q", "-v"}, "lftwo": {"-v"}}\n')
        programs = ("| program | what it does | call |\n| --- | --- | --- |\n"
                    "| `lfone` | Does one thing | `lfone A\\|B` |\n"
                    "| `lftwo` | Does two | `lftwo A -o B`, `lftwo C` |\n")
        options = ("| option | offered by | effect |\n| --- | --- | --- |\n"
                   "| `-q A\\|B` | `lfone` | no words |\n| `-v` | all | more |\n")
        self.plant_generated("README.md", "programs", programs)
        self.plant_generated("doc/design.md", "common-options", options)
        self.expect("check_house.py", "tables", faults=[])
        self.plant_generated("README.md", "programs", programs.replace("one thing", "a thing"))
        self.plant_generated("doc/design.md", "common-options", options.replace("all", "`lfone`"))
        self.expect("check_house.py", "tables", faults=["README.md:2: the sources say something else",
                                                        "doc/design.md:2: the sources say something else"])

    MUTANT = """[[mutant]]
name = "{name}"
area = "core"
file = "{file}"
function = "{function}"
old = '{old}'
new = 'i <= n'
effect = "One too many."
targets = ["lf_core_test"]
tests = '{tests}'
"""

    def plant_mutants(self, *mutants):
        fine = {"name": "fine", "file": "lf/core/a.cc", "function": "Sum", "old": "i < n", "tests": "^core"}
        self.plant("scripts/mutants.toml", "\n".join(self.MUTANT.format(**(fine | m)) for m in mutants))

    def test_mutants_are_in_step_with_the_code(self):
        self.plant("lf/core/a.cc", "int Sum(int n);\nint Other(int n) { return i < n; }\n"
                   "// i < n\nint Sum(int n) const {\n  for (; i <\n       n;) j < m + j < m;\n}\n")
        self.plant("lf/core/a_test.cc", "TEST(Suite, There) {}\n")
        self.expect("check_house.py", "mutants", faults=[])  # there is no list
        self.plant_mutants({})
        self.expect("check_house.py", "mutants", faults=[])
        self.plant_mutants({"name": "gone", "old": "i < m"}, {"name": "twice", "old": "j < m"},
                           {"name": "same", "old": "i <= n"}, {"name": "no-file", "file": "lf/core/b.cc"},
                           {"name": "no-function", "function": "Product"},
                           {"name": "no-test", "tests": "^camera"}, {"name": "wrong", "tests": "("},
                           {"name": "Big"}, {}, {})
        start = "scripts/mutants.toml: "
        self.expect("check_house.py", "mutants", faults=[
            f"{start}gone: Sum of lf/core/a.cc has its old text 0 times",
            f"{start}twice: Sum of lf/core/a.cc has its old text 2 times",
            f"{start}same: its new text is the old one", f"{start}same: Sum of lf/core/a.cc has its old text 0 times",
            f"{start}no-function: lf/core/a.cc has no function or constant Product",
            f"{start}no-file: there is no lf/core/b.cc", f"{start}no-test: no test is named like ^camera",
            f"{start}wrong: its tests are no regular expression", f"{start}Big: a name has small letters",
            f"{start}fine: is there twice"])
        self.plant("scripts/mutants.toml", "[[mutant]]\nname = 'bare'\n")
        self.expect("check_house.py", "mutants", faults=[f"{start}a mutant has no 'area'"])

    def test_functions_and_constants_are_found_by_their_names(self):
        text = """int Sum(int);  // Sum(int) { is declared
struct Box : Base {
  explicit Box(int n) : Base(n), size_{n}, text_("}") {
    Use(n);
  }
  int At(int i) const noexcept { return Sum(At<1>(i)); }
  template <typename T> auto At() const -> std::vector<T> { if (Sum(2)) { return {}; } return {1}; }
};
constexpr float kWidths[2] = {1, 2}, kEnd = 3;
const twice = (x: number): number => ({ y: 2 * x });
export function twiceAll(all: number[]): { y: number }[] { return all.map(twice); }
"""
        found = lambda name: [text[begin:end] for begin, end in function_text.spans(text, name)]
        self.assertEqual(found("Sum"), [])
        self.assertEqual([part.splitlines()[-1] for part in found("Box")], ["  }"])
        self.assertEqual([part[-10:] for part in found("At")], ["<1>(i)); }", "urn {1}; }"])
        self.assertEqual(found("kWidths"), ["kWidths[2] = {1, 2}, kEnd = 3;"])
        self.assertEqual(found("twice"), ["twice = (x: number): number => ({ y: 2 * x });"])

    def git(self, *words):
        done = subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@example.org", *words], cwd=self.root,
                              check=True, capture_output=True, text=True)
        return done.stdout.strip()

    def test_without_a_repository_there_are_no_messages(self):
        self.plant("lf/core/a.cc", "")
        code, lines = run("check_house.py", self.root, "messages")
        self.assertEqual(code, 77, lines)
        self.assertIn("skipped", lines[0])

    def test_a_shallow_clone_cannot_tell_commits(self):
        self.plant_table("fine")
        self.git("init", "-q")
        for message in ("first", "second"):
            self.git("add", ".")
            self.git("commit", "-q", "--allow-empty", "-m", message)
        clone = self.root / "clone"
        self.git("clone", "-q", "--depth", "1", f"file://{self.root}", str(clone))
        code, lines = run("check_house.py", clone, "messages")
        self.assertEqual(code, 77, lines)
        self.assertIn("shallow", lines[0])

    def test_messages_of_commits_say_what_and_why(self):
        self.git("init", "-q")
        self.git("commit", "-q", "--allow-empty", "-m", "anything", "--date", "2026-01-01T12:00:00+00:00")
        for number, (message, line_count) in enumerate([
                ("core: Read files", 50), ("core, web/src: Speed up reading\n\nIt was slow.", 51),
                ("core: Read" + " more" * 13, 1),
                ("Read files", 1), ("core: read files", 1), ("core: Added a file", 1), ("core: Reading", 1),
                ("core: Read files", 51)]):
            self.plant(f"lf/core/{number}.cc", "\n" * line_count)
            self.git("add", ".")
            self.git("commit", "-q", "-m", message)
        faults = [fault.partition("): ")[2] for fault in commit_rules.check_messages(self.root, FIRST)]
        form = "expected a subject such as 'render: Resume after a full disk'"
        self.assertEqual(faults, ["51 lines change, and no body says why", "'Reading' is no imperative",
                                  "'Added' is no imperative", form, form,
                                  "the subject has 75 characters, at most 72 are allowed"])
        self.git("commit", "-q", "--amend", "-m", "core: Read all files")  # which changes the hash
        self.assertEqual(len(list(commit_rules.check_messages(self.root, FIRST))), len(faults))

    def test_a_clean_house_has_no_faults(self):
        self.plant("lf/core/CMakeLists.txt", "lf_folder(core SOURCES a.cc)\n")
        self.plant("lf/core/a.cc", "#include <vector>\n")
        for check in ("includes", "lengths", "paths", "links", "pages", "tables", "headers", "comments"):
            self.expect("check_house.py", check, faults=[])


if __name__ == "__main__":
    unittest.main()
