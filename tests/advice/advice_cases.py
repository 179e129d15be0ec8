# SPDX-License-Identifier: Apache-2.0
"""Reads the situations in which programs recommend an option: tests/advice/*.txt.

    [FILE: WORDS]      a source without its suffix, and words of a message in it
    before: COMMANDS   run first; must succeed
    call 2: COMMAND    ends with this exit code, and with a message that contains WORDS
    then: EDIT         follows the advice: the call is edited, and must end with 0
    then 6: EDIT       the same, with another exit code

Edits, which are separated by " ; " if there are several:

    + WORDS         adds words to the call
    - WORDS         leaves words out
    WORDS => WORDS  puts others in their place
    ! COMMAND       is run before the call

Each situation has a copy of the folder that printed_commands.make_world() makes for itself.
"""
import dataclasses
import pathlib
import re

FOLDER = pathlib.Path(__file__).parent
LINE = re.compile(r"(?:(before)|(call|then)(?: (\d))?): (.*)")


@dataclasses.dataclass
class Case:
    key: str  # FILE: WORDS
    before: str = ""
    call: str = ""
    code: int = 0
    remedies: list = dataclasses.field(default_factory=list)  # (edit, exit code)

    @property
    def words(self):
        return self.key.split(": ", 1)[1]


def read_cases() -> list:
    cases = []
    for file in sorted(FOLDER.glob("*.txt")):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if not line or line.startswith("#"):
                continue
            if line.startswith("["):
                cases.append(Case(line[1:-1]))
                continue
            match = LINE.fullmatch(line)
            if not match:
                raise AssertionError(f"{file}:{number}: neither a key nor a step: {line}")
            case, code, text = cases[-1], int(match[3] or 0), match[4]
            if match[1]:
                case.before = text
            elif match[2] == "call":
                case.call, case.code = text, code
            else:
                case.remedies.append((text, code))
    return cases


def edited(call, edit):
    """Returns the line that follows an advice."""
    commands = []
    for step in edit.split(" ; "):
        sign, _, words = step.partition(" ")
        if sign == "!":
            commands.append(words)
        elif sign == "+":
            call += " " + words
        else:
            old, new = (" " + words, "") if sign == "-" else step.split(" => ")
            if old not in call:
                raise AssertionError(f"{old}: is not in {call}")
            call = call.replace(old, new, 1)
    return " && ".join([*commands, call])
