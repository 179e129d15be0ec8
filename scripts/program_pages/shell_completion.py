# SPDX-License-Identifier: Apache-2.0
"""Makes completion for bash, zsh and fish from descriptions of programs (tools/common/describe.h)."""
import shlex

# The functions that complete a word in bash. Neither the package bash-completion nor another program is needed.
BASH = r"""# Completion of the programs of lfrendertools for bash, made by scripts/program_pages/program_pages.py.

# Sets `spec` to what the option or positional argument $2 of program $1 takes:
#   flag, text, words WORD..., or files, then "/" if folders are values, then extensions (none: any).
_lfrendertools_spec() {
  spec=text
  case "$1 $2" in
@SPECS@  esac
}

# Sets `list` to the words of kind $2 of program $1: options, arguments (positional), commands, rest (the program whose
# options may follow "--"), or without (those of its options that may not).
_lfrendertools_list() {
  list=
  case "$1 $2" in
@LISTS@  esac
}

# Adds the files and folders that begin with $cur, and whose names end as $spec says.
_lfrendertools_files() {
  local name ending extensions=" ${spec#files} "
  extensions=${extensions/ \/ / }
  while IFS= read -r name; do
    if [[ -d ${name/#\~/$HOME} || -z ${extensions// } && $spec != "files /" ]]; then
      COMPREPLY+=("$name")
      continue
    fi
    for ending in $extensions; do
      if [[ ${name,,} == *"$ending" ]]; then COMPREPLY+=("$name"); fi
    done
  done < <(compgen -f -- "$cur")
  compopt -o filenames 2> /dev/null
}

_lfrendertools_value() {
  case $spec in
    words*) COMPREPLY=($(compgen -W "${spec#words }" -- "$cur")) ;;
    files*) _lfrendertools_files ;;
  esac
}

# Completes the call of program $1, whose arguments begin at the word with number $2.
_lfrendertools_call() {
  local program=$1 cur=${COMP_WORDS[COMP_CWORD]} i word spec list option= without= ended= arguments=()
  if [[ $cur == "=" ]]; then cur=; fi
  cur=${cur#[\"\']}
  cur=${cur//\\/}
  _lfrendertools_list "$program" arguments
  arguments=($list)
  for ((i = $2; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if [[ $word == "=" ]]; then
      continue
    elif [[ -n $option ]]; then
      option=
    elif [[ $word == -- && -z $ended ]]; then
      ended=yes
      _lfrendertools_list "$program" rest
      if [[ -n $list ]]; then
        word=$list
        _lfrendertools_list "$program" without
        without=" $list "
        program=$word
        ended=
        arguments=()
      fi
    elif [[ $word == -* && -z $ended ]]; then
      _lfrendertools_spec "$program" "$word"
      if [[ $spec != flag ]]; then option=$word; fi
    elif ((${#arguments[@]} > 0)) && [[ ${arguments[0]} != *... ]]; then
      arguments=("${arguments[@]:1}")
    fi
  done
  if [[ -n $option ]]; then
    _lfrendertools_spec "$program" "$option"
    _lfrendertools_value
  elif [[ $cur == -* && -z $ended ]]; then
    _lfrendertools_list "$program" options
    for word in $(compgen -W "$list" -- "$cur"); do
      if [[ $without != *" $word "* ]]; then COMPREPLY+=("$word"); fi
    done
  elif ((${#arguments[@]} > 0)); then
    _lfrendertools_spec "$program" "${arguments[0]}"
    _lfrendertools_value
  fi
}

# Completes the first word after program $1, which has commands, or the arguments of that command. The words of the
# call begin at the word with number $2.
_lfrendertools_command() {
  local list entry
  _lfrendertools_list "$1" commands
  if ((COMP_CWORD > $2)); then
    for entry in $list; do
      if [[ ${entry%%=*} == "${COMP_WORDS[$2]}" ]]; then
        _lfrendertools_any "${entry#*=}" $(($2 + 1))
        return
      fi
    done
    if [[ ${COMP_WORDS[$2]} != help ]]; then return; fi
  elif [[ ${COMP_WORDS[COMP_CWORD]} == -* ]]; then
    _lfrendertools_call "$1" "$2"
    return
  fi
  local names=()
  for entry in $list; do names+=("${entry%%=*}"); done
  COMPREPLY=($(compgen -W "${names[*]}" -- "${COMP_WORDS[COMP_CWORD]}"))
}

_lfrendertools_any() {
  local list
  _lfrendertools_list "${1//+/ }" commands
  if [[ -n $list ]]; then
    _lfrendertools_command "${1//+/ }" "$2"
  else
    _lfrendertools_call "${1//+/ }" "$2"
  fi
}

"""


def options_of(description):
    return [option for group in description["groups"] for option in group["options"]]


def named(description):
    """Returns the options, without positional arguments."""
    return [option for option in options_of(description) if not option["positional"]]


def positional(description):
    return [option for option in options_of(description) if option["positional"]]


def has_own_commands(description):
    return any(command["call"].split()[0] == description["name"] for command in description["commands"])


def bash_spec(option):
    if option["type"] == "flag":
        return "flag"
    if option["choices"]:
        return "words " + " ".join(choice["value"] for choice in option["choices"])
    if option["files"]:
        return " ".join(["files", *(["/"] if option["files"]["folders"] else []), *option["files"]["extensions"]])
    return "text"


def bash(descriptions):
    """Returns the completion of all programs for bash."""
    specs = lists = ends = ""
    for call, description in descriptions.items():
        arguments = []
        for option in options_of(description):
            names = [name + "..." * (option["positional"] and option["repeats"]) for name in option["names"]]
            pattern = " | ".join(shlex.quote(f"{call} {name}") for name in names)
            if bash_spec(option) != "text":
                specs += f"    {pattern}) spec={shlex.quote(bash_spec(option))} ;;\n"
            arguments += names if option["positional"] else []
        options = " ".join(name for option in named(description) for name in option["names"])
        lists += f"    {shlex.quote(call + ' options')}) list={shlex.quote(options)} ;;\n"
        if description["commands"]:
            commands = " ".join(f"{command['name']}={command['call'].replace(' ', '+')}"
                                for command in description["commands"])
            lists += f"    {shlex.quote(call + ' commands')}) list={shlex.quote(commands)} ;;\n"
        elif arguments:
            lists += f"    {shlex.quote(call + ' arguments')}) list={shlex.quote(' '.join(arguments))} ;;\n"
        if description["rest"]:
            lists += f"    {shlex.quote(call + ' rest')}) list={description['rest']['program']} ;;\n"
            without = " ".join(description["rest"]["without"])
            lists += f"    {shlex.quote(call + ' without')}) list={shlex.quote(without)} ;;\n"
        if " " not in call:
            ends += f"_{call}() {{ COMPREPLY=(); _lfrendertools_any {call} 1; }}\ncomplete -F _{call} {call}\n"
    return BASH.replace("@SPECS@", specs).replace("@LISTS@", lists) + ends


def zsh_text(text):
    """Returns a text for a specification of _arguments, without quotes around it."""
    for letter in "\\:[]":
        text = text.replace(letter, "\\" + letter)
    return text


def zsh_action(option):
    if option["choices"]:
        return "(" + " ".join(choice["value"] for choice in option["choices"]) + ")"
    files = option["files"]
    if not files:
        return " "
    if files["extensions"]:
        return "_files -g \"*.(" + "|".join(end[1:] for end in files["extensions"]) + ")(-.)\""
    return "_files -/" if files["folders"] else "_files"


def zsh_specs(description, without=()):
    """Yields the words of _arguments for the options, except some, and for the positional arguments."""
    for option in named(description):
        names = [name for name in option["names"] if name not in without]
        if not names:
            continue
        value = ""
        for placeholder in (option["placeholder"].split() * option["value_count"])[:option["value_count"]]:
            message = "value" if option["choices"] else zsh_text(placeholder)
            value += f":{message}:{zsh_action(option)}"
        if option["repeats"]:
            begin = "'*'"
        elif len(names) > 1:
            begin = shlex.quote(f"({' '.join(names)})")
        else:
            begin = ""
        # "=" after a long name: the value is the next word, or follows after "=".
        ends = [name + "=" * (option["value_count"] == 1 and name.startswith("--")) for name in names]
        alternatives = "{" + ",".join(ends) + "}" if len(names) > 1 else ends[0]
        yield f"{begin}{alternatives}" + shlex.quote(f"[{zsh_text(option['summary'])}]{value}")
    for option in positional(description) if not description["commands"] else []:
        begin = "*" if option["repeats"] else "" if option["required"] else ":"
        yield shlex.quote(f"{begin}:{zsh_text(option['names'][0])}:{zsh_action(option)}")


def zsh_rest(name, rest, descriptions):
    """Returns the words of a function that complete the options of another program after "--", and their function."""
    other = dict(descriptions[rest["program"]])
    other["groups"] = [{"options": named(other)}]
    words = " \\\n    ".join(zsh_specs(other, rest["without"]))
    call = (f"  local -i dashes=${{words[(ie)--]}}\n"
            f"  if (( dashes < CURRENT )); then\n"
            f"    words=({rest['program']} \"${{(@)words[dashes + 1, -1]}}\")\n"
            f"    (( CURRENT -= dashes - 1 ))\n"
            f"    {name}_rest\n"
            f"    return\n"
            f"  fi\n")
    return call, f"{name}_rest() {{\n  _arguments -s -S \\\n    {words}\n}}\n"


def zsh_function(call, descriptions):
    """Returns the function that completes a program or command."""
    description = descriptions[call]
    name = "_" + call.replace(" ", "_")
    words = " \\\n    ".join(zsh_specs(description))
    if not description["commands"]:
        rest, function = zsh_rest(name, description["rest"], descriptions) if description["rest"] else ("", "")
        return f"{name}() {{\n{rest}  _arguments -s -S \\\n    {words}\n}}\n{function}"
    commands = " ".join(f"{command['name']}\\:{shlex.quote(zsh_text(command['summary']))}"
                        for command in description["commands"])
    cases = "".join(f"      {command['name']}) _{command['call'].replace(' ', '_')} ;;\n"
                    for command in description["commands"])
    own = "" if has_own_commands(description) else \
        f"      help) _arguments {shlex.quote('1:command:((' + commands + '))')} ;;\n"
    return (f"{name}() {{\n  local curcontext=$curcontext state line\n"
            f"  _arguments -C \\\n    {words} \\\n"
            f"    {shlex.quote('1:command:((' + commands + '))')} \\\n    '*::argument:->arguments'\n"
            f"  if [[ $state == arguments ]]; then\n    case $words[1] in\n{cases}{own}    esac\n  fi\n}}\n")


def zsh(descriptions):
    """Returns the completion of all programs for zsh: one function, which the shell loads at the first TAB."""
    programs = [call for call in descriptions if " " not in call]
    functions = "".join(zsh_function(call, descriptions) for call in descriptions)
    cases = "".join(f"  {name}) _{name} ;;\n" for name in programs)
    return (f"#compdef {' '.join(programs)}\n"
            "# Completion of the programs of lfrendertools for zsh, made by scripts/program_pages/program_pages.py.\n"
            f"{functions}case $service in\n{cases}esac\n")


FISH_FILES = """# Lists folders, and files whose names end with one of the arguments.
function __lfrendertools_files
    set -l token (string replace -r -- '^--[^=]*=' '' (commandline -ct))
    set -l ends (string join '|' (string escape --style=regex -- $argv))
    __fish_complete_path $token | string match -ri -- "^[^\\t]*(?:/|$ends)(?:\\t.*)?\\$"
end
"""


FISH_REST = """# Completes the options of another program after "--".
function __@NAME@_rest
    set -l words (commandline -opc)
    set -l dashes (contains -i -- -- $words); or return
    set -e words[1..$dashes]
    complete -C (string join ' ' -- @PROGRAM@ (string escape -- $words) (commandline -ct)) |
        string match -rv '^(@WITHOUT@)(\\t|$)'
end
complete -c @NAME@ -n 'contains -- -- (commandline -opc)' -f -a '(__@NAME@_rest)'
"""


def fish_value(option):
    """Returns the words of `complete` for the values of an option."""
    if option["type"] == "flag":
        return ""
    if option["choices"]:
        return " -x -a " + fish_quoted(" ".join(choice["value"] for choice in option["choices"]))
    files = option["files"]
    if not files:
        return " -x"
    if files["extensions"]:
        return " -x -a " + fish_quoted("(__lfrendertools_files " + " ".join(files["extensions"]) + ")")
    return " -x -a '(__fish_complete_directories)'" if files["folders"] else " -r -F"


def fish_quoted(text):
    """Returns a text in single quotes, in which fish knows two escapes."""
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def fish_lines(name, description, condition=""):
    """Yields a call of `complete` for each option, and one for the files of positional arguments."""
    begin = f"complete -c {name}" + (f" -n {fish_quoted(condition)}" if condition else "")
    for option in named(description):
        names = "".join(f" -s {word[1:]}" if not word.startswith("--") else f" -l {word[2:]}"
                        for word in option["names"])
        yield f"{begin}{names} -d {fish_quoted(option['summary'])}{fish_value(option)}"
    if description["commands"]:
        return
    words = [fish_value(option) for option in positional(description)]
    for value in dict.fromkeys(value for value in words if " -a " in value):
        yield begin + value.replace(" -x ", " -f ", 1)
    if not any(" -F" in value for value in words):
        yield f"{begin} -f"


def fish(name, descriptions):
    """Returns the completion of one program for fish."""
    description = descriptions[name]
    lines = ["# Completion for fish, made by scripts/program_pages/program_pages.py."]
    calls = {command["name"]: command["call"] for command in description["commands"]}
    if not description["commands"]:
        rest = description["rest"]
        condition = "not contains -- -- (commandline -opc)" if rest else ""
        lines += [FISH_FILES, *fish_lines(name, description, condition)]
        if rest:
            lines.append(FISH_REST.replace("@NAME@", name).replace("@PROGRAM@", rest["program"])
                         .replace("@WITHOUT@", "|".join(rest["without"])))
        return "\n".join(lines) + "\n"
    own = has_own_commands(description)
    first = "__fish_use_subcommand"
    if own:
        lines.append(FISH_FILES)
    else:
        # The command line of the program takes the place of that of the command.
        cases = "".join(f"        case {command}\n            set program {call}\n" for command, call in calls.items())
        lines.append(f"""function __{name}_complete
    set -l words (commandline -opc) (commandline -ct)
    set -l program
    switch $words[2]
{cases}        case '*'
            return
    end
    complete -C (string join ' ' -- $program (string escape -- $words[3..-2]) $words[-1])
end
complete -c {name} -n 'not {first}' -f -a '(__{name}_complete)'
complete -c {name} -n {first} -f -a help -d 'Show the help of a command'
complete -c {name} -n '__fish_seen_subcommand_from help' -f -a {fish_quoted(' '.join(calls))}""")
    for command in description["commands"]:
        lines.append(f"complete -c {name} -n {first} -f -a {command['name']} -d {fish_quoted(command['summary'])}")
    lines += fish_lines(name, description, first)
    for command, call in calls.items() if own else ():
        lines += fish_lines(name, descriptions[call], f"__fish_seen_subcommand_from {command}")
    return "\n".join(lines) + "\n"
