# SPDX-License-Identifier: Apache-2.0
"""Finds the messages in the sources that advise something: a command of ours, or an option that mends a call."""
import pathlib
import re

import program_list
from message_rules import is_shipped, literals, spelled

PROGRAMS = program_list.names(pathlib.Path(__file__).resolve().parents[2])
# The texts of a program's help: options and their groups, the settings of lf/render/settings/, and the summary, usage,
# examples and details of HelpTexts.
HELP = re.compile(r"OptionGroup \w+\(app, \Z|"
                  r"(?:\bAdd|\bAddFlag|\bAddChoice|AddTo)\((?:[^;]|;(?=[^\n]*\"))*\Z|"
                  r"\.(?:summary|usage|examples|details|strict|json|seed|text) =\s*\Z")
OPTION = r"--[a-z][a-z-]*"
# A remedy: a verb that tells what to do, and then an option, or "leave ... out" of a message that names an option.
REMEDY = re.compile(
    r"\b(?:leave|add|use|give|given|try|with|replace|continue|continues|raise|lower|reduce|increase|make|state|choose|"
    r"see|call|run|render|start|accept|keep|allow|correct|merge|by|overrides|out|smaller|larger)\b[^:]*" + OPTION +
    r"|\bleave\b.* out\b|\(" + OPTION + r"[^)]*\)|" + OPTION +
    r" (?:continues|removes|leaves|moves|overrides|accepts|renders|would)")
COMMAND = re.compile(r"\b(?:" + "|".join(PROGRAMS) + r") (?:[-{<]|[A-Z]{2,}|[a-z]+ [-{])")


class Message:
    """A literal of the sources: the file, the line where it begins, and its text as programs print it."""

    def __init__(self, file, line, text):
        self.file, self.line, self.text = file, line, text

    def matches(self, key):
        """Returns true if the key, FILE: WORDS, is about this message."""
        stem, _, words = key.partition(": ")
        return pathlib.Path(self.file).stem == stem and words in self.text

    def __str__(self):
        return f"{self.file}:{self.line}: {self.text}"


def is_help(text, offset):
    """Returns true if the literal is a text of the help."""
    statement = text[max(text.rfind(";\n", 0, offset), text.rfind("}\n\n", 0, offset), 0):offset]
    return bool(HELP.search(statement)) or "HelpTexts" in statement


def sources(repository: pathlib.Path) -> list:
    """Returns the sources of the programs and of the library."""
    files = [file for folder in ("tools", "lf") for suffix in (".cc", ".h")
             for file in sorted((repository / folder).rglob("*" + suffix))]
    return [file for file in files if is_shipped(file)]


def all_literals(repository: pathlib.Path) -> list:
    """Returns the literals of the programs and of the library that are no texts of the help."""
    found = []
    for file in sources(repository):
        text = file.read_text()
        found += [Message(str(file.relative_to(repository)), text.count("\n", 0, offset) + 1, spelled(literal))
                  for offset, literal in literals(text) if not is_help(text, offset)]
    return found


def messages(repository: pathlib.Path) -> list:
    """Returns the messages that advise a command or an option."""
    return [message for message in all_literals(repository)
            if REMEDY.search(message.text) and re.search(OPTION, message.text) or COMMAND.search(message.text)]
