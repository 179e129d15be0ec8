"""What a result says besides its figures: commit, machine, day; and where it is kept."""
import datetime
import json
import os
import pathlib
import re
import subprocess

HERE = pathlib.Path(__file__).resolve().parent


def git(*words):
    return subprocess.run(["git", *words], capture_output=True, text=True, cwd=HERE).stdout.strip()


def commit():
    """of what was compiled; says so if that was changed since"""
    changed = git("status", "--porcelain", "--", "../lf", "../tools", "*.cc", "*.h")
    return git("rev-parse", "--short", "HEAD") + (" with changes" if changed else "")


def machine():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    field = lambda name: (re.search(rf"^{name}\s*: (.*)", text, re.M) or [None, "unknown"])[1]
    vectors = [flag for flag in ("avx2", "avx512f") if flag in field("flags").split()]
    return (f"{field('model name')}, family {field('cpu family')}, {os.cpu_count()} cores, "
            f"{' '.join(vectors)}")


def context():
    return {"date": datetime.date.today().isoformat(), "commit": commit(), "machine": machine(),
            "load": round(os.getloadavg()[0], 1)}


def sentence(record):
    return (f"Commit {record['commit']}, {record['date']}; {record['machine']}; "
            f"load {record['load']} when started.")


def save(name, record, text):
    folder = HERE / "results"
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.md").write_text(text)
    (folder / f"{name}.json").write_text(json.dumps(record, indent=1) + "\n")


def add_options(parser):
    parser.add_argument("--name", help="write bench/results/NAME.md and NAME.json")
    parser.add_argument("--again", type=pathlib.Path, metavar="JSON", help="of an earlier run")
    parser.add_argument("--write", type=pathlib.Path, metavar="PAGE",
                        help="put the table into this page, between its markers")


def publish(arguments, script, record, text):
    """Prints the table, and writes it where the options say."""
    print(text)
    if arguments.name:
        save(arguments.name, record, text)
    if arguments.write:
        page = arguments.write.read_text()
        begin, end = f"<!-- table: bench/{script} -->", "<!-- end of table -->"
        before, rest = page.split(begin)
        after = rest.split(end, 1)[1]
        arguments.write.write_text(f"{before}{begin}\n{text}{end}{after}")
