#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes man pages, completion for shells and a reference page from what the programs say of themselves.

usage: scripts/program_pages/program_pages.py FOLDER_OF_THE_PROGRAMS OUT NAME...

Each program NAME is asked by its hidden option --describe (tools/common/describe.h). OUT receives
  programs.md                                 the reference page
  share/man/man1/NAME.1                       and NAME-COMMAND.1 for a program with commands
  share/bash-completion/completions/NAME      links to one file, lfrendertools
  share/zsh/site-functions/_lfrendertools
  share/fish/vendor_completions.d/NAME.fish
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys

import man_pages
import shell_completion


def describe(folder, call):
    """Returns the description of a program, or of a command of one, such as "lffocus stack"."""
    program, *words = call.split()
    result = subprocess.run([folder / program, *words, "--describe"], stdout=subprocess.PIPE, text=True, check=True)
    description = json.loads(result.stdout)
    if description["format"] != "lfrendertools program 1" or description["name"] != call:
        raise ValueError(f"{call} --describe: describes {description['name']} as '{description['format']}'")
    return description


def describe_all(folder, names):
    """Returns {call: description} of the programs, each followed by its own commands."""
    found = {}
    for name in names:
        found[name] = describe(folder, name)
        for command in found[name]["commands"]:
            if command["call"].split()[0] == name:
                found[command["call"]] = describe(folder, command["call"])
    for description in found.values():
        for command in description["commands"]:
            if command["call"] in found:
                command["summary"] = found[command["call"]]["summary"]
    return found


def facts_of(option):
    """Returns what the parser knows of an option as sentences without marks."""
    facts = ["required"] if option["required"] else []
    if option["default"]:
        means = option["default_means"]
        facts.append(f"default: {option['default']}" + (f" ({means})" if means else ""))
    elif option["default_means"]:
        facts.append(f"default: {option['default_means']}")
    if option["values"]:
        facts.append(f"values: {option['values']}")
    if option["needs"]:
        facts.append("needs " + ", ".join(option["needs"]))
    if option["excludes"]:
        facts.append("not with " + ", ".join(option["excludes"]))
    text = "; ".join(facts)
    return text[:1].upper() + text[1:]


def meanings_of(option):
    """Returns {meaning: words} of the choices whose meaning is told."""
    meanings = {}
    for choice in option["choices"]:
        if choice["meaning"]:
            meanings.setdefault(choice["meaning"], []).append(choice["value"])
    return meanings


def shown_names(option):
    """Returns "-o, --output DIR", or "PACKAGE..."."""
    if option["positional"]:
        return option["names"][0] + ("..." if option["repeats"] else "")
    return " ".join(filter(None, (", ".join(option["names"]), option["placeholder"])))


def lines_of_option(option):
    """Yields the lines of a list of Markdown."""
    yield f"- **`{shown_names(option)}`** {option['summary']}."
    yield from (f"  {line}  " for line in option["details"])
    facts = facts_of(option)
    for meaning, words in meanings_of(option).items():
        yield "  - " + ", ".join(f"`{word}`" for word in words) + f": {meaning}"
    if facts:
        yield f"\n  {facts}."


def block(lines):
    return "```\n" + "\n".join(lines) + "\n```\n"


def section(call, description):
    """Returns the part of the reference page on one program or command."""
    lines = [f"## {call}\n", description["summary"] + "\n", block(description["usage"])]
    if description["commands"]:
        lines += [f"- `{command['name']}` ({command['call']}): {command['summary']}"
                  for command in description["commands"]] + [""]
    lines += ["Examples:\n", block(description["examples"])]
    if description["details"]:
        lines.append(re.sub(r"(?m)^(  .*)$", r"  \1", description["details"]) + "\n")
    for group in description["groups"]:
        lines.append(f"### {call}: {group['name']}\n")
        for option in group["options"]:
            lines += lines_of_option(option)
        lines.append("")
    return "\n".join(lines)


def reference_page(descriptions):
    head = f"""# The programs and their options

Find here every option of every program of lfrendertools {next(iter(descriptions.values()))['version']}, as `--help-all`
shows it. This page is made when the programs are built (`scripts/program_pages/program_pages.py`).

"""
    lists = [f"- [`{call}`](#{call.replace(' ', '-')}): {description['summary']}"
             for call, description in descriptions.items()]
    codes = next(iter(descriptions.values()))["exit_codes"]
    parts = [section(call, description) for call, description in descriptions.items()]
    return head + "\n".join(lists) + f"\n\n{codes}\n\n" + "\n".join(parts)


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def main():
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    folder, out, names = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
    descriptions = describe_all(folder, names)
    shutil.rmtree(out, ignore_errors=True)
    write(out / "programs.md", reference_page(descriptions))
    for call, description in descriptions.items():
        page = call.replace(" ", "-")
        write(out / f"share/man/man1/{page}.1", man_pages.page_of(call, description, descriptions))
    bash = out / "share/bash-completion/completions"
    write(bash / "lfrendertools", shell_completion.bash(descriptions))
    for name in names:
        (bash / name).symlink_to("lfrendertools")
        write(out / f"share/fish/vendor_completions.d/{name}.fish", shell_completion.fish(name, descriptions))
    write(out / "share/zsh/site-functions/_lfrendertools", shell_completion.zsh(descriptions))
    return 0


if __name__ == "__main__":
    sys.exit(main())
