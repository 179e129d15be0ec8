# SPDX-License-Identifier: Apache-2.0
"""Finds the functions and constants of C++ and TypeScript sources by their names. It is no parser: it knows brackets,
comments and literals, which suffices for sources that clang-format and Prettier have laid out."""
import re

# Comments and literals, whose brackets do not count. Shaders stand in backticks, which are no literals here.
SKIPPED = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)\'', re.S)
CLOSING = {"(": ")", "[": "]", "{": "}"}
# Matches what may stand between the parameters of a function and its body: const, noexcept, types, members.
TAIL = re.compile(r"(?:[\w\s:<>&*,]|->)*")


def masked(text):
    """Returns the text with spaces in place of comments and literals."""
    return SKIPPED.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def end_of_bracket(code, begin):
    """Returns where the bracket that opens at `begin` is closed, or None."""
    open_brackets = []
    for at in range(begin, len(code)):
        if code[at] in CLOSING:
            open_brackets.append(CLOSING[code[at]])
        elif code[at] in CLOSING.values():
            if open_brackets.pop() != code[at]:
                return None
            if not open_brackets:
                return at + 1
    return None


def end_of_function(code, parameters):
    """Returns where the body of the function ends whose parameters begin with the bracket there. None: no body."""
    at = end_of_bracket(code, parameters)
    while at is not None:
        at = TAIL.match(code, at).end()
        if at == len(code) or code[at] not in "({":
            return None
        is_member = re.match(r"[\w>]", code[at - 1])  # of a constructor's list, such as size_{0}, or noexcept(...)
        if code[at] == "{" and not is_member:
            return end_of_bracket(code, at)
        at = end_of_bracket(code, at)
    return None


def end_of_statement(code, begin):
    """Returns the end of a statement: after its semicolon, or before the bracket that is closed around it."""
    at = begin
    while at is not None and at < len(code) and code[at] not in ";)]}":
        at = end_of_bracket(code, at) if code[at] in CLOSING else at + 1
    return at if at is None or code[at:at + 1] != ";" else at + 1


def spans(text, name):
    """Returns [(begin, end), ...] of the definitions of a name: functions of that name with their bodies, or else what
    is assigned to it."""
    code = masked(text)
    word = rf"(?<![\w.]){re.escape(name)}(?!\w)"
    ends = [(found.start(), end_of_function(code, found.end() - 1)) for found in re.finditer(rf"{word}\s*\(", code)]
    if not any(end for _, end in ends):
        ends = [(found.start(), end_of_statement(code, found.end()))
                for found in re.finditer(rf"{word}(?:\[\w*\])?(?:: [\w\[\]<>]+)? = ", code)]
    return [(begin, end) for begin, end in ends if end]
