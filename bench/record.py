# SPDX-License-Identifier: Apache-2.0
"""The record of a table: its figures, and all that is needed to judge and to reproduce them.

A script that makes a table does four things:

    results.add_options(parser)                        # --name, --write, --again
    record = results.record_of(parser, arguments, arguments.build, measure)  # measures, or reads --again
    results.call([build / "bin/lfsynth", "chart", ...])           # runs a program; fails with its message
    used = results.timed([build / "bin/lfrenderer", field, ...])  # also measures it
    results.publish(arguments, "script.py", record, text)         # prints, writes bench/results/ and the page

Every call of our programs and benchmarks is noted, however a script makes it. The record,
bench/results/NAME.json, has

    table     the words of the marker in the page: <!-- table: bench/script.py -->
    version   of the project, and sources, a hash of the compiled sources and the scripts as they were measured.
              Squashed and rebased history keeps it: bench/tables.py --find HASH names commits with these sources.
              Older records state a commit instead.
    date, machine, load when started
    made_by   the command line of the script
    commands  each different command with its options; only the last part of paths
    defaults  the lines of bench/defaults.txt for the programs among the commands, as these programs print them
    defaults_hash   hash of these lines
    and what the script adds: its rows

Each row, command and default has a line of its own, so that a table made again changes the lines of what changed.
Measured numbers are rounded to DIGITS.

NAME.md beside it is the text between the markers. scripts/check_house.py . tables compares all of them.
"""
import datetime
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import defaults

HERE = pathlib.Path(__file__).resolve().parent
END = "<!-- end of table -->"
# Figures depend on these: compiled sources, and the scripts that measure.
SOURCES = ("../lf", "../tools", "../cmake", "../CMakeLists.txt", "*.cc", "*.h", "*.py")
DIGITS = 7  # tables show fewer: a table made of a rounded record has the same text
LINE = 100  # a list or object of at most so many characters is written as one line

_commands = []  # commands of this run, each once
_programs = {}  # name -> path
_is_noting = True


def git(*words, **more):
    return subprocess.run(["git", *words], capture_output=True, text=True, cwd=HERE, **more).stdout.strip()


def sources_of(commit="HEAD", with_changes=False):
    """Returns a hash of the sources of a commit, or of the present ones: those of HEAD with what was changed since."""
    with tempfile.TemporaryDirectory() as folder:
        index = os.environ | {"GIT_INDEX_FILE": f"{folder}/index"}
        git("read-tree", commit, env=index)
        if with_changes:
            git("add", "--all", "--", *SOURCES, env=index)
        files = git("ls-files", "--stage", "--full-name", "--", *SOURCES, env=index)
    return hashlib.sha256(files.encode()).hexdigest()[:12] if files else "unknown"


def present_sources():
    return sources_of("HEAD", with_changes=True)


def machine():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    field = lambda name: (re.search(rf"^{name}\s*: (.*)", text, re.M) or [None, "unknown"])[1]
    vectors = [flag for flag in ("avx2", "avx512f") if flag in field("flags").split()]
    return (f"{field('model name')}, family {field('cpu family')}, {os.cpu_count()} cores, "
            f"{' '.join(vectors)}")


def context():
    version = (HERE.parent / "VERSION").read_text().strip()
    return {"date": datetime.date.today().isoformat(), "version": version, "sources": present_sources(),
            "machine": machine(), "load": round(os.getloadavg()[0], 1)}


def sentence(record):
    made_from = (f"Version {record['version']}, sources {record['sources']}" if "sources" in record else
                 f"Commit {record['commit']}")
    return f"{made_from}, {record['date']}; {record['machine']}; load {record['load']} when started."


def shown(word):
    """Returns a word of a command as records show it: only the last part of a path, without the machine's folders."""
    option, equals, value = str(word).rpartition("=")
    return option + equals + (pathlib.Path(value).name if value.startswith(("/", "./", "../")) else value)


def note(words):
    """Notes a command that is about to be run. Returns its words as text."""
    words = [str(word) for word in words]
    text = shlex.join(map(shown, words))
    if text not in _commands:
        _commands.append(text)
    program = pathlib.Path(words[0])
    if program.name in defaults.PROGRAMS:
        _programs[program.name] = program.resolve()
    return words


def _note_call(event, details):
    """Notes a process that Python is about to start (an audit hook)."""
    if event != "subprocess.Popen" or not _is_noting:
        return
    words = details[1] if isinstance(details[1], (list, tuple)) else [details[1]]
    name = pathlib.Path(os.fsdecode(words[0])).name
    if name in defaults.PROGRAMS or name.startswith("lf_"):
        note([os.fsdecode(word) for word in words])


sys.addaudithook(_note_call)


def call(words, **more):
    """Runs a command and returns its standard output. If it fails, ends the script with its output."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          **more)
    if done.returncode != 0:
        raise SystemExit(f"{shlex.join(map(str, words))} ended with {done.returncode}:\n{done.stderr}")
    return done.stdout


def timed(words, watch=None, folder=None, codes=(0,)):
    """Runs a command, notes it, and returns its use of resources:

    seconds, cpu_s, peak_bytes     of this process alone (measured.py says why that is not obvious)
    read_bytes                     by system calls, from files that are in memory as well
    open_files, folder_bytes       the most seen, every `watch` seconds, of its open files and of the bytes
                                   that `folder` takes on the disk; 0 without `watch`
    stdout                         its standard output

    Ends the script if the exit code is not among `codes`.
    """
    with tempfile.NamedTemporaryFile() as result:
        done = subprocess.run([sys.executable, "-I", "-S", HERE / "measured.py", result.name, str(watch or 0),
                               str(folder or "-"), *note(words)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode not in codes:
            raise SystemExit(f"{shlex.join(map(str, words))} ended with {done.returncode}:\n{done.stderr}")
        return json.load(open(result.name)) | {"stdout": done.stdout}


def rounded(value):
    """Returns a value whose floating-point numbers have DIGITS significant digits. Integers are not rounded."""
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    return [rounded(item) for item in value] if isinstance(value, (list, tuple)) else value


def text_of(value, depth=0):
    """Returns JSON with one row per line. Each item of a list or object at the top has a line, such as each command;
    further below, each object of a list or object of objects. A row is one line, whatever it holds."""
    flat = json.dumps(value)
    if not isinstance(value, (dict, list)) or depth > 0 and len(flat) <= LINE:
        return flat
    items = list(value.values() if isinstance(value, dict) else value)
    if depth > 1 and not all(isinstance(item, dict) for item in items):
        return flat
    names = [json.dumps(name) + ": " for name in value] if isinstance(value, dict) else [""] * len(items)
    begin, end = "{}" if isinstance(value, dict) else "[]"
    indent = "\n" + " " * depth
    lines = ",".join(f"{indent} {name}{text_of(item, depth + 1)}" for name, item in zip(names, items))
    return begin + lines + indent + end


def write_json(path, record):
    """Writes a record, replacing the file in one step."""
    part = path.with_suffix(".part")
    part.write_text(text_of(rounded(record)) + "\n")
    part.replace(path)


def save(name, record, text):
    folder = HERE / "results"
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.md").write_text(text)
    write_json(folder / f"{name}.json", record)


def add_options(parser):
    parser.add_argument("--name", help="write bench/results/NAME.md and NAME.json; with --write the name of the "
                                       "script unless given")
    parser.add_argument("--again", type=pathlib.Path, metavar="JSON", help="of an earlier run: measure nothing")
    parser.add_argument("--write", type=pathlib.Path, metavar="PAGE",
                        help="put the table into this page, between its markers, and keep its record")


def record_of(parser, arguments, given, measure, names="BUILD_DIR"):
    """Returns the record of --again, or context() with what measure(folder) returns; the folder is temporary.

    given  an argument that must be there if --again is not
    names  arguments that the message then asks for
    """
    if arguments.again:
        return json.loads(arguments.again.read_text())
    if not given:
        parser.error(f"{names} or --again is needed")
    record = context()
    with tempfile.TemporaryDirectory() as temporary:
        return record | measure(pathlib.Path(temporary))


def marker_of(script):
    """Returns the words of the marker; scripts of bench/ are named without their folder."""
    return script if script.startswith("scripts/") else f"bench/{script}"


def name_of(script):
    """Returns the name of a record: lens_weights-captures for "bench/quality/lens_weights.py captures"."""
    return re.sub(r"[^\w.]+", "-", pathlib.Path(script).name.replace(".py", "")).strip("-")


def publish(arguments, script, record, text):
    """Prints the table, and writes it to the places that the options state.

    script  "name.py WORDS", "quality/name.py WORDS", or "scripts/name.py WORDS": the words of the page's marker
    """
    global _is_noting
    _is_noting = False  # the query of the defaults is no command of the table
    print(text)
    record.setdefault("table", marker_of(script))
    record.setdefault("made_by", shlex.join(map(shown, sys.argv)))
    record.setdefault("commands", list(_commands))
    if "defaults" not in record:
        record["defaults"] = defaults.of_programs(list(_programs.values()))
        record["defaults_hash"] = defaults.hash_of(record["defaults"])
    name = arguments.name or (arguments.write and name_of(script))
    if name:
        save(name, record, text)
    if arguments.write:
        page = arguments.write.read_text()
        begin = f"<!-- table: {record['table']} -->"
        if page.count(begin) != 1:
            raise SystemExit(f"{arguments.write}: expected one line {begin}, found {page.count(begin)}")
        before, rest = page.split(begin)
        after = rest.split(END, 1)[1]
        arguments.write.write_text(f"{before}{begin}\n{text}{END}{after}")
