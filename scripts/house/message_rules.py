# SPDX-License-Identifier: Apache-2.0
"""The rule that no message of the library names an option as a command line spells it (lf/core/spelling.h), for
check_house.py, and the literals of C++ sources.
"""
import pathlib
import re

TOKEN = re.compile(r'//[^\n]*|R"\((?P<raw>.*?)\)"|(?P<words>"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*)|'
                   r"'(?:[^'\\\n]|\\.)+'", re.S)
WORD = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
# References to options, in format strings and in other literals: a program, a key and a value.
IN_FORMAT = re.compile(r"\{\{(lf[a-z]+ )?([a-z][a-z0-9_]*)( (?:[^{}]|\{[^{}]*\})+)?\}\}")
PLAIN = re.compile(r"\{(lf[a-z]+ )?([a-z][a-z0-9_]*)( [^{}]+)?\}")
OPTION = re.compile(r"(?<![\w-])--[a-z]")
ONE_WORD = re.compile(r"--[a-z-]+(?:=\S*)?")

# Sources with words of command lines, each of which is a literal of its own, and why.
COMMANDS = {
    "lf/densify/folded_poses.cc": "prints calls of lfimport",
    "lf/distribute/cluster/job.cc": "prints calls of lfsubmit",
    "lf/distribute/cluster/resume_job.cc": "prints calls of lfsubmit",
    "lf/distribute/cluster/run_package.cc": "calls lfrenderer and lfmerge",
    "lf/import/check/capture_warnings.cc": "prints calls of lfimport",
    "lf/import/check/unused_masks.cc": "prints calls of lfimport",
    "lf/import/formats/read_stanford.cc": "prints calls of lfimport",
}
# Sources whose literals may have options anywhere, and why.
OTHER_LANGUAGES = {
    "lf/core/spelling.cc": "spells options for command lines",
    "lf/distribute/cluster/farm_files.cc": "writes scripts and templates for farms",
    "lf/distribute/cluster/slurm.cc": "writes scripts for Slurm and calls its programs",
    "lf/light_field/colmap/colmap_binary.cc": "prints a call of COLMAP",
}


def literals(text):
    """Yields (offset, literal) of C++ text, with neighbouring literals joined."""
    for match in TOKEN.finditer(text):
        if match["raw"] is not None:
            yield match.start(), match["raw"]
        elif match["words"] is not None:
            joined = "".join(WORD.findall(match["words"]))
            yield match.start(), joined.replace('\\"', '"').replace("\\n", "\n").replace("\\\\", "\\")


def references(literal):
    """Returns (program, key) of each reference to an option; the program is "" if none is named."""
    found = IN_FORMAT.findall(literal) + PLAIN.findall(IN_FORMAT.sub("", literal))
    return [(program.strip(), key) for program, key, _ in found]


def option_of(key):
    """Returns the option that a key stands for, as CommandLineOption() does."""
    names = {"guard": "--no-guard", "max_angle_deg": "--max-angle", "output": "-o"}
    return names.get(key, "--" + key.replace("_", "-"))


def spelled(literal):
    """Returns a literal as programs print it: with options instead of references to them."""
    def words_of(match):
        program, key, value = match.groups()
        return (program or "") + option_of(key) + ("" if key == "guard" else value or "")
    return PLAIN.sub(words_of, IN_FORMAT.sub(words_of, literal))


def is_shipped(path):
    return not path.stem.endswith(("_test", "_fuzz", "_bench")) and not path.stem.startswith("test_")


def check_options(root, files):
    """Yields the literals of lf/ with an option, and the entries of the lists above that nothing needs."""
    used = set()
    for path in files:
        name = path.relative_to(root).as_posix()
        if not name.startswith("lf/") or path.suffix not in {".cc", ".h"} or not is_shipped(pathlib.Path(name)):
            continue
        text = path.read_text()
        for offset, literal in literals(text):
            option = OPTION.search(literal)
            if not option:
                continue
            if name in OTHER_LANGUAGES or (name in COMMANDS and ONE_WORD.fullmatch(literal)):
                used.add(name)
                continue
            number = text.count("\n", 0, offset) + 1
            yield (f"{name}:{number}: '{literal[option.start():][:40]}': a message names an option by its key, such as "
                   "{max_images} (lf/core/spelling.h)")
    for name in [*COMMANDS, *OTHER_LANGUAGES]:
        if name not in used and (root / name).exists():
            yield f"{name}: has no option: remove it from the lists of message_rules.py"
