#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the descriptions of the programs, and what is made from them: man pages, completion, the reference page.

usage: program_pages_test.py FOLDER_OF_THE_PROGRAMS FOLDER_OF_THE_PAGES
"""
import json
import os
import pathlib
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import time
import unittest

from common_options import OFFERED
from program_test_case import ProgramTestCase

BIN = PAGES = None
# An option or positional argument in --help-all: two spaces, its names, and its summary.
NAMED = re.compile(r"^  (?:(-\w), )?(--[\w-]+)|^  ([A-Z]\w*(?:\.\w+)?)(?:\.\.\.)?  +\S", re.M)
KINDS = {"light_field", "path", "package", "store", "plate", "image", "folder", "file"}
TYPES = {"flag", "choice", "whole number", "number", "text"}


def names_in_help(text):
    """Returns the names of all options and positional arguments in the groups of a help."""
    groups = text.split("Examples:\n")[1].split("\n\n", 1)[1]
    groups = re.sub(r"^Commands:\n(.+\n)*", "", groups, flags=re.M)
    options = groups.split("  --version")[0] + "  --version\n"
    return {name for match in NAMED.finditer(options) for name in match.groups() if name}


class ProgramPagesTest(ProgramTestCase):
    @classmethod
    def setUpClass(cls):
        cls.descriptions = {}
        for call in OFFERED:
            program, *command = call.split()
            result = subprocess.run([BIN / program, *command, "--describe"], capture_output=True, text=True)
            if result.returncode != 0 or result.stderr:
                raise AssertionError(f"{call} --describe: {result.stderr}")
            cls.descriptions[call] = json.loads(result.stdout)

    @staticmethod
    def options_of(description):
        return [option for group in description["groups"] for option in group["options"]]

    def names(self, call, positional=False):
        """Returns the names of the options of a program, or of its positional arguments."""
        return [name for option in self.options_of(self.descriptions[call]) for name in option["names"]
                if option["positional"] == positional]

    def test_every_option_of_the_help_is_described_and_no_other(self):
        for call, description in self.descriptions.items():
            with self.subTest(call=call):
                program, *command = call.split()
                everything = self.succeeds(BIN / program, *command, "--help-all")
                described = [*self.names(call), *self.names(call, positional=True)]
                self.assertEqual(len(described), len(set(described)))
                self.assertEqual(set(described), names_in_help(everything))
                self.assertNotIn("--describe", everything)
                self.assertEqual(description["name"], call)
                for text in (description["summary"], *description["usage"], *description["examples"]):
                    self.assertIn(text, everything.replace("\n", " ") + everything)

    def test_descriptions_say_what_the_help_says(self):
        for call, description in self.descriptions.items():
            program, *command = call.split()
            shown = self.succeeds(BIN / program, *command, "--help")
            joined = " ".join(self.succeeds(BIN / program, *command, "--help-all").split())
            for group in description["groups"]:
                self.assertEqual(group["shown"], f"\n{group['name']}:\n" in shown, group["name"])
                for option in group["options"]:
                    with self.subTest(call=call, option=option["names"][-1]):
                        self.assertIn(option["type"], TYPES)
                        self.assertEqual(option["type"] == "flag", option["value_count"] == 0)
                        self.assertEqual(bool(option["placeholder"]),
                                         option["type"] != "flag" and not option["positional"])
                        self.assertEqual(option["type"] == "choice", bool(option["choices"]))
                        for text in (option["summary"], option["placeholder"], option["values"], *option["details"],
                                     *(choice["meaning"] for choice in option["choices"])):
                            self.assertIn(text, joined)
                        files = option["files"]
                        for kind in files["kinds"] if files else []:
                            self.assertTrue(kind in KINDS or kind[0] == ".", kind)
                        if re.search(r"\b(LIGHTFIELD|PATH|PACKAGES?|STORE|DIR|FOLDER|FILE|OUT)\b",
                                     option["placeholder"] + " ".join(option["names"])):
                            self.assertTrue(files)

    def test_facts_of_some_options(self):
        options = {name: option for option in self.options_of(self.descriptions["lfrenderer"])
                   for name in option["names"]}
        self.assertEqual([choice["value"] for choice in options["--estimator"]["choices"]],
                         ["auto", "nearest", "bilinear"])
        self.assertTrue(all(choice["meaning"] for choice in options["--estimator"]["choices"]))
        self.assertEqual((options["--max-angle"]["type"], options["--max-angle"]["default"],
                          options["--max-angle"]["default_means"], options["--max-angle"]["values"]),
                         ("number", "0", "no limit", "0 to 180"))
        self.assertEqual(options["--slab-position"]["value_count"], 3)
        self.assertEqual(options["--overwrite"]["excludes"], ["--resume"])
        self.assertEqual(options["--display"]["needs"], ["--view"])
        self.assertEqual(options["INPUT"]["files"]["kinds"], ["light_field", "path", "package"])
        self.assertTrue(options["INPUT"]["repeats"] and options["--output"]["required"])
        self.assertEqual({command["call"] for command in self.descriptions["lffocus"]["commands"]},
                         {call for call in OFFERED if call.startswith("lffocus ")})
        self.assertEqual({command["call"] for command in self.descriptions["lfr"]["commands"]},
                         {call for call in OFFERED if " " not in call} - {"lfr"})

    def test_every_option_occurs_in_all_pages(self):
        markdown = (PAGES / "programs.md").read_text()
        bash = (PAGES / "share/bash-completion/completions/lfrendertools").read_text()
        zsh = (PAGES / "share/zsh/site-functions/_lfrendertools").read_text()
        for call, description in self.descriptions.items():
            man = (PAGES / f"share/man/man1/{call.replace(' ', '-')}.1").read_text().replace("\\-", "-")
            fish = (PAGES / f"share/fish/vendor_completions.d/{call.split()[0]}.fish").read_text()
            if " " in call:
                seen = f"__fish_seen_subcommand_from {call.split()[1]}'"
                fish = "\n".join(line for line in fish.splitlines() if seen in line)
            section = re.search(rf"^## {call}$(.*?)(?=^## |\Z)", markdown, re.M | re.S)[1]
            words = re.search(rf"^    '{call} options'\) list='(.*)' ;;$", bash, re.M)[1].split()
            function = re.search(rf"^_{call.replace(' ', '_')}\(\) \{{$(.*?)^\}}$", zsh, re.M | re.S)[1]
            self.assertEqual(sorted(words), sorted(self.names(call)))
            for name in self.names(call):
                with self.subTest(call=call, option=name):
                    in_fish = f" -s {name[1:]} " if len(name) == 2 else f" -l {name[2:]} "
                    self.assertTrue(re.search(rf"^- \*\*`(-\w, )?{name}[ `,]", section, re.M), "the reference page")
                    self.assertTrue(re.search(rf"^\.TP\n.*\\fB{name}\\fR", man, re.M), "the man page")
                    self.assertTrue(re.search(rf"^ +.*[ {{,*']{name}=?[,}}'\[]", function, re.M), "zsh")
                    self.assertTrue(in_fish in fish, "fish")
            for option in self.options_of(description):
                for choice in option["choices"]:
                    for page, text in (("reference", section), ("man", man), ("zsh", function), ("fish", fish)):
                        self.assertTrue(choice["value"] in text, (call, option["names"], choice["value"], page))

    def check_files(self, command, folder, pattern, answers=(0,)):
        """Runs a command on each of the files. It must print nothing."""
        files = sorted((PAGES / "share" / folder).glob(pattern))
        self.assertTrue(files)
        for file in files:
            result = subprocess.run([*command, file], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            self.assertEqual((result.returncode in answers, result.stderr), (True, ""), file)

    def test_man_pages_have_no_warnings(self):
        self.check_files(["man", "--warnings", "-l"], "man/man1", "*.1")
        self.assertEqual(len(list((PAGES / "share/man/man1").iterdir())), len(OFFERED))

    @unittest.skipUnless(shutil.which("mandoc"), "mandoc is not installed")
    def test_mandoc_finds_nothing_wrong(self):
        for page in sorted((PAGES / "share/man/man1").iterdir()):
            result = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", page], capture_output=True, text=True)
            self.assertEqual((result.returncode, result.stdout), (0, ""), page)

    def test_zsh_reads_its_completion(self):
        self.check_files(["zsh", "-n"], "zsh/site-functions", "_*")

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish_reads_its_completion(self):
        self.check_files(["fish", "-n"], "fish/vendor_completions.d", "*.fish")

    def completed(self, line):
        """Returns what bash offers for the last word of a command line. `=` is a word of its own, as in bash."""
        words = re.sub("=(?=.)", "= ", line.replace("=", " =")).split(" ")
        script = (f"source {PAGES}/share/bash-completion/completions/{words[0]}\n"
                  f"COMP_WORDS=({' '.join(repr(word) for word in words)})\nCOMP_CWORD={len(words) - 1}\n"
                  f"_{words[0]}\nprintf '%s\\n' \"${{COMPREPLY[@]}}\"")
        result = subprocess.run(["bash", "-u", "-c", script], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return set(filter(None, result.stdout.split("\n")))

    def test_bash_completes_names_and_words(self):
        self.assertEqual(self.completed("lfrenderer a b --estimator "), {"auto", "nearest", "bilinear"})
        self.assertEqual(self.completed("lfrenderer a b --estimator=b"), {"bilinear"})
        self.assertEqual(self.completed("lfrenderer a b --estimator="), {"auto", "nearest", "bilinear"})
        self.assertEqual(self.completed("lfrenderer --estimator auto --lens-w"), {"--lens-weights"})
        self.assertEqual(self.completed("lfrenderer --resume --overw"), {"--overwrite"})
        self.assertEqual(self.completed("lfrenderer -"), set(self.names("lfrenderer")))
        self.assertEqual(self.completed("lfrenderer --max-images "), set())
        self.assertEqual(self.completed("lfsynth "), {"still-life", "lights", "chart", "foliage"})
        self.assertEqual(self.completed("lfsynth lights "), set())
        self.assertEqual(self.completed("lffocus s"), {"stack", "sharp"})
        self.assertEqual(self.completed("lffocus --he"), {"--help", "--help-all"})
        self.assertEqual(self.completed("lffocus epi field --lines "), {"auto", "recorded", "nearest", "linear"})
        self.assertEqual(self.completed("lffocus epi field --"), {name for name in self.names("lffocus epi")
                                                                  if name.startswith("--")})
        self.assertEqual(self.completed("lffocus nonsense --"), set())

    def test_bash_completes_files_by_kind(self):
        for name in ("a.lfp", "B.LFP", "c d.lfp", "e.lfs", "f.yaml", "g.json", "h.png", "i.mp4", "v.npy", "w.h5",
                     "x.webp"):
            (self.folder / name).write_text("")
        (self.folder / "deep").mkdir()
        (self.folder / "deep" / "k.lfs").write_text("")
        packages = {"a.lfp", "B.LFP", "c d.lfp"}
        light_fields = {"e.lfs", "g.json", "h.png", "v.npy", "w.h5", "x.webp", "deep"}  # pictures and arrays of views
        self.assertEqual(self.completed("lfsubmit "), packages | {"deep"})
        self.assertEqual(self.completed("lfrenderer "), packages | light_fields | {"f.yaml"})
        self.assertEqual(self.completed("lfrenderer --lightfield "), light_fields)
        self.assertEqual(self.completed("lfrenderer --lightfield deep/"), {"deep/k.lfs"})
        self.assertEqual(self.completed("lfrenderer --lightfield=deep/"), {"deep/k.lfs"})
        self.assertEqual(self.completed("lfrenderer f.yaml -o "), {"deep"})
        self.assertEqual(self.completed("lfcompressor x -o "), {"e.lfs", "deep"})
        self.assertEqual(self.completed("lfrenderer --video "), {"i.mp4", "deep"})
        self.assertEqual(self.completed("lfpath "), {"f.yaml", "g.json", "deep"})
        self.assertEqual(self.completed("lfsubmit --lfrenderer h"), {"h.png"})
        # The first argument is a light field, the second a path, the others are packages.
        self.assertEqual(self.completed("lfvisualizer "), light_fields)
        self.assertEqual(self.completed("lfvisualizer deep "), {"f.yaml", "g.json", "deep"})
        self.assertEqual(self.completed("lfvisualizer --seed 3 deep f.yaml "), packages | {"deep"})
        self.assertEqual(self.completed("lfvisualizer deep f.yaml a.lfp c"), {"c d.lfp"})

    def test_bash_completes_lfr(self):
        (self.folder / "e.lfs").write_text("")
        commands = {command["name"] for command in self.descriptions["lfr"]["commands"]}
        self.assertEqual(self.completed("lfr "), commands)
        self.assertEqual(self.completed("lfr help re"), {"render"})
        self.assertEqual(self.completed("lfr render --estimator "), {"auto", "nearest", "bilinear"})
        self.assertEqual(self.completed("lfr render --lightfield "), {"e.lfs"})
        self.assertEqual(self.completed("lfr focus s"), {"stack", "sharp"})
        self.assertEqual(self.completed("lfr focus epi e.lfs --lines n"), {"nearest"})

    def rest_of_lfsubmit(self):
        """Returns the options of lfrenderer that lfsubmit passes on."""
        rest = self.descriptions["lfsubmit"]["rest"]
        self.assertEqual(rest["program"], "lfrenderer")
        self.assertLess(set(rest["without"]), set(self.names("lfrenderer")) | {"--describe"})
        return set(self.names("lfrenderer")) - set(rest["without"])

    def test_options_that_are_not_offered_after_dashes_are_those_that_lfsubmit_refuses(self):
        package = self.folder / "p.lfp"
        package.write_text("")
        without = self.descriptions["lfsubmit"]["rest"]["without"]
        for name in [*without, *self.rest_of_lfsubmit()]:
            result = subprocess.run([BIN / "lfsubmit", package, "-o", self.folder / "film", "--", name],
                                    capture_output=True, text=True)
            self.assertNotEqual(result.returncode, 0)
            self.assertEqual("cannot be given after --" in result.stderr, name in without, result.stderr)

    def test_bash_completes_the_options_of_another_program_after_dashes(self):
        (self.folder / "a.lfp").write_text("")
        (self.folder / "e.lfs").write_text("")
        self.assertEqual(self.completed("lfsubmit a.lfp -o film -- -"), self.rest_of_lfsubmit())
        self.assertEqual(self.completed("lfsubmit a.lfp -- --estimator "), {"auto", "nearest", "bilinear"})
        self.assertEqual(self.completed("lfsubmit a.lfp -- --lightfield "), {"e.lfs"})
        self.assertEqual(self.completed("lfsubmit a.lfp -- --over"), set())
        self.assertEqual(self.completed("lfsubmit a.lfp -- --format png "), set())
        self.assertEqual(self.completed("lfr submit a.lfp -- --format png --lens-w"), {"--lens-weights"})
        self.assertEqual(self.completed("lfsubmit a.lfp --eng"), {"--engine"})
        # Other programs have no options after it, but files.
        self.assertEqual(self.completed("lfrenderer -- --est"), set())
        self.assertEqual(self.completed("lfrenderer -- e"), {"e.lfs"})

    # zsh writes all that its completion functions offer into the file OFFERS, and after each TAB a line "=done".
    ZSH = r"""
bindkey -e
PROMPT=''
fpath=({functions} $fpath)
autoload -Uz compinit
compinit -u -D
compadd() {
  local -a found
  if [[ " ${(j: :)@[1,(i)(-|--)]}" == *' -'[a-zA-Z]#[AOD]' '* ]]; then
    builtin compadd "$@"
    return
  fi
  builtin compadd -A found "$@"
  if (( $#found )) print -rl -- $found >> {offers}
  builtin compadd "$@"
}
at_end() { print -r -- '=done' >> {offers} }
offer() { comppostfuncs=(at_end); _main_complete }
zle -C offer list-choices offer
bindkey '^I' offer
print -r -- '=done' >> {offers}
"""

    def offers_of_zsh(self, lines):
        """Returns {line: what zsh offers for its last word}, from an interactive zsh in a terminal."""
        offers = self.folder / "OFFERS"
        (self.folder / "setup.zsh").write_text(
            self.ZSH.replace("{functions}", str(PAGES / "share/zsh/site-functions")).replace("{offers}", str(offers)))
        os.mkdir(self.folder / "work")
        for name in ("e.lfs", "f.yaml", "a.lfp"):
            (self.folder / "work" / name).write_text("")
        (self.folder / "work" / "deep").mkdir()
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(self.folder / "work")
            environment = {"HOME": str(self.folder), "PATH": f"{BIN}:/usr/bin:/bin", "TERM": "dumb"}
            os.execvpe("zsh", ["zsh", "-f", "-i"], environment)
        try:
            found, end = {}, time.monotonic() + 60
            for line in (None, *lines):
                offers.write_text("")
                os.write(terminal, b"source ../setup.zsh\n" if line is None else line.encode() + b"\t")
                shown = b""
                while not offers.read_text().endswith("=done\n"):
                    self.assertLess(time.monotonic(), end, (line, shown))
                    if select.select([terminal], [], [], 0.05)[0]:
                        shown += os.read(terminal, 65536)
                found[line] = set(offers.read_text().splitlines()) - {"=done"}
                os.write(terminal, b"\x15")  # removes the line
            return found
        finally:
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            os.close(terminal)

    def test_zsh_completes(self):
        estimators = {"auto", "nearest", "bilinear"}
        expected = {
            "lfrenderer a b --estimator ": estimators,
            "lfrenderer a b --estimator=b": {"bilinear"},
            "lfrenderer --lens-w": {"--lens-weights"},
            "lfrenderer --lightfield ": {"e.lfs", "deep"},
            "lfrenderer ": {"e.lfs", "f.yaml", "a.lfp", "deep"},
            "lfsynth ": {"still-life", "lights", "chart", "foliage"},
            "lffocus s": {"stack", "sharp"},
            "lffocus epi e.lfs --lines ": {"auto", "recorded", "nearest", "linear"},
            "lfr ren": {"render"},
            "lfr render --estimator n": {"nearest"},
            "lfr focus epi --lines n": {"nearest"},
            "lfsubmit ": {"a.lfp", "deep"},
            "lfsubmit a.lfp --eng": {"--engine"},
            "lfsubmit a.lfp -- --estimator ": estimators,
            "lfsubmit a.lfp -- --lightfield e": {"e.lfs"},
            "lfsubmit a.lfp -- --over": set(),
            "lfsubmit a.lfp -- --format png --lens-w": {"--lens-weights"},
            "lfr submit a.lfp -- --lens-w": {"--lens-weights"}}
        found = self.offers_of_zsh(expected)
        for line, words in expected.items():
            with self.subTest(line=line):
                self.assertEqual(found[line], words)

    def test_zsh_offers_every_option(self):
        lines = {call: f"{call} --" for call in OFFERED}
        found = self.offers_of_zsh([*lines.values(), "lfsubmit a.lfp -- --"])
        for call, line in lines.items():
            with self.subTest(call=call):
                self.assertEqual(found[line], {name for name in self.names(call) if name.startswith("--")})
        self.assertEqual(found["lfsubmit a.lfp -- --"],
                         {name for name in self.rest_of_lfsubmit() if name.startswith("--")})

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish_completes(self):
        (self.folder / "e.lfs").write_text("")
        (self.folder / "f.yaml").write_text("")
        (self.folder / "deep").mkdir()
        folder = PAGES / "share/fish/vendor_completions.d"
        for line, expected in (
                ("lfrenderer a b --estimator ", {"auto", "nearest", "bilinear"}),
                ("lfrenderer a b --estimator=b", {"--estimator=bilinear"}),
                ("lfrenderer --lightfield ", {"e.lfs", "deep/"}),
                ("lfrenderer ", {"e.lfs", "f.yaml", "deep/"}),
                ("lffocus s", {"stack", "sharp"}),
                ("lffocus epi e.lfs --lines ", {"auto", "recorded", "nearest", "linear"}),
                ("lfr ren", {"render"}),
                ("lfr render --lightfield ", {"e.lfs", "deep/"}),
                ("lfr render --estimator n", {"nearest"}),
                ("lfr focus epi --lines n", {"nearest"}),
                ("lfsubmit a.lfp --eng", {"--engine"}),
                ("lfsubmit a.lfp -- --estimator ", {"auto", "nearest", "bilinear"}),
                ("lfsubmit a.lfp -- --format png --lens-w", {"--lens-weights"}),
                ("lfsubmit a.lfp -- --over", set()),
                ("lfsubmit a.lfp -- --lightfield e", {"e.lfs"}),
                ("lfr submit a.lfp -- --lens-w", {"--lens-weights"})):
            with self.subTest(line=line):
                script = f"set fish_complete_path {folder}; complete -C '{line}'"
                environment = {"HOME": str(self.folder), "PATH": f"{BIN}:/usr/bin:/bin"}
                result = subprocess.run(["fish", "--no-config", "-c", script], capture_output=True, text=True,
                                        cwd=self.folder, env=environment)
                self.assertEqual(result.stderr, "")
                self.assertEqual({entry.split("\t")[0] for entry in result.stdout.splitlines()}, expected)


if __name__ == "__main__":
    BIN, PAGES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
