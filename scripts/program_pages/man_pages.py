# SPDX-License-Identifier: Apache-2.0
"""Makes man pages, in the macros of man(7), from descriptions of programs (tools/common/describe.h)."""
import os
import re
import time

import program_pages

# Matches names of options and of programs in sentences.
OPTION = re.compile(r"(?<![\w-])--?[a-zA-Z][\w-]*")
# Matches the end of a sentence, after which roff wants a new line.
SENTENCE_END = re.compile(r"(?<=[a-z0-9)\]'\"][.?!]) +(?=[A-Z\"'(])")


def date():
    """Returns the date of the pages: that of SOURCE_DATE_EPOCH, or today."""
    return time.strftime("%Y-%m-%d", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))))


def escaped(text):
    """Returns a text whose letters all mean themselves in roff."""
    text = text.replace("\\", "\\e").replace("~", "\\(ti").replace("^", "\\(ha").replace("`", "\\(ga")
    return text.replace("'", "\\(aq")


def code(text):
    """Returns words that a user types: hyphens are minus signs."""
    return escaped(text).replace("-", "\\-")


def protected(line):
    """Returns a line that does not begin with a character that roff takes for a macro."""
    return "\\&" + line if line[:1] in (".", "'") else line


def sentences(text):
    """Returns text as lines of roff, a sentence each, in which the names of options are bold."""
    text = OPTION.sub(lambda match: f"\\fB{match[0]}\\fR".replace("-", "\\-"), escaped(text))
    return "".join(protected(line) + "\n" for line in SENTENCE_END.split(text))


def example_lines(lines):
    """Returns lines that are printed as they are."""
    return ".PP\n.RS 4\n.nf\n" + "".join(protected(code(line)) + "\n" for line in lines) + ".fi\n.RE\n"


def synopsis_line(line):
    """Returns a usage in which words to type are bold and placeholders are italic."""
    def face(match):
        word = code(match[0])
        return f"\\fI{word}\\fR" if match[0].isupper() else f"\\fB{word}\\fR"
    return re.sub(r"[\w.-]*\w[\w.-]*", face, line)


def head_of(option):
    """Returns "-o, --output DIR" with its faces."""
    if option["positional"]:
        return f"\\fI{code(option['names'][0])}\\fR" + ("\\&..." if option["repeats"] else "")
    names = ", ".join(f"\\fB{code(name)}\\fR" for name in option["names"])
    return names + (f" \\fI{code(option['placeholder'])}\\fR" if option["placeholder"] else "")


def ended(text):
    return text if text.endswith((".", "?", "!", ":")) else text + "."


def option_text(option):
    text = f".TP\n{head_of(option)}\n" + sentences(ended(option["summary"]))
    for line in option["details"]:
        text += ".br\n" + sentences(ended(line))
    facts = program_pages.facts_of(option)
    meanings = program_pages.meanings_of(option)
    if meanings:
        text += ".RS\n"
        for meaning, words in meanings.items():
            text += ".TP\n" + ", ".join(f"\\fB{code(word)}\\fR" for word in words) + "\n" + sentences(ended(meaning))
        text += ".RE\n"
    return text + ((".IP\n" if meanings else ".br\n") + sentences(ended(facts)) if facts else "")


def description_text(description):
    """Returns the paragraphs of the details. Lines that begin with two spaces stay as they are."""
    text = ""
    for paragraph in filter(None, [description["summary"], *description["details"].split("\n\n")]):
        text += ".PP\n" if text else ""
        kept = []
        for line in paragraph.splitlines() + [""]:
            if line.startswith("  "):
                kept.append(line[2:])
                continue
            if kept:
                text += example_lines(kept) + ".PP\n" * bool(line)
                kept = []
            text += sentences(line) if line else ""
    return text


def exit_codes(words):
    """Returns a list of the exit codes from a sentence such as "Exit codes: 0 success, 1 a bug. Then ..."."""
    codes, rest = re.fullmatch(r"Exit codes: (.*?)\. (.*)", words).groups()
    text = ""
    for number, meaning in re.findall(r"(\d) (.*?)(?=, \d |$)", codes):
        text += f".TP\n{number}\n" + sentences(ended(meaning[0].upper() + meaning[1:]))
    return text + ".PP\n" + sentences(rest)


def see_also(call, descriptions):
    others = sorted(other.replace(" ", "-") for other in descriptions if other != call)
    return ",\n".join(f".BR {code(other)} (1)" for other in others).replace(" (1),", " (1),") + "\n"


def page_of(call, description, descriptions):
    """Returns the man page of a program, or of a command of one, such as "lffocus stack"."""
    name = call.replace(" ", "-")
    summary = description["summary"].rstrip(".")
    text = f".\\\" Made by scripts/program_pages/program_pages.py from {call} --describe.\n"
    text += f".TH {code(name.upper())} 1 \"{date()}\" \"lfrendertools {description['version']}\" \"User Commands\"\n"
    text += ".nh\n.ad l\n"  # without hyphens at the ends of lines, which could be part of a name
    text += f".SH NAME\n{code(name)} \\- {escaped(summary[0].lower() + summary[1:])}\n.SH SYNOPSIS\n"
    text += ".br\n".join(synopsis_line(line) + "\n" for line in description["usage"])
    text += ".SH DESCRIPTION\n" + description_text(description)
    if description["commands"]:
        text += ".SH COMMANDS\n"
        for command in description["commands"]:
            text += f".TP\n\\fB{code(command['name'])}\\fR\n" + sentences(ended(command["summary"]))
            text += f"See \\fB{code(command['call'].replace(' ', '-'))}\\fR(1).\n"
    text += ".SH OPTIONS\n"
    for group in description["groups"]:
        text += f".SS {code(group['name'])}\n" + "".join(map(option_text, group["options"]))
    text += ".SH EXIT STATUS\n" + exit_codes(description["exit_codes"])
    text += ".SH EXAMPLES\n" + example_lines(description["examples"]).removeprefix(".PP\n")
    return text + ".SH SEE ALSO\n" + see_also(call, descriptions)
