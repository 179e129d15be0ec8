# SPDX-License-Identifier: Apache-2.0
"""Checks tables of figures, for check_house.py: each table needs a record that states when, by which programs and with
which commands it was made (bench/record.py).

A table of a page stands between <!-- table: SCRIPT --> and <!-- end of table -->. A table of figures that no script
makes is preceded by <!-- table by hand: WHY -->. Tables of scripts/doc_tables.py have no figures and no record.
"""
import hashlib
import json
import re
import shlex

RECORDS, LISTING = "bench/results", "bench/defaults.txt"
# Tables that must be made again, and files of results that are no records, one per line.
STALE = "bench/stale_tables.txt"
BEGIN = re.compile(r"^<!-- table: (.+?) -->$")
END = "<!-- end of table -->"
# Begins the words of tables that have no record, because doc_tables.py makes them of the sources.
GENERATED = "scripts/doc_tables.py "
BY_HAND = re.compile(r"^<!-- table by hand: .+ -->$")
# A measured value: a number and its unit, or a number with two decimals.
FIGURE = re.compile(r"(?<![\w.-])\d[\d,.]*(?:(?: to [\d.]+)? ?(?:ns|µs|ms|s|h|min|dB|MB|GB|MiB|GiB|MB/s|GB/s|M/s|"
                    r"CPU s|x|×)(?![\w-])|(?<=\d\.\d\d)(?![\w.]))")
REFERENCE = re.compile(r"\b(?:Eq|Fig|Figures?|Tables?)\b\.?[\d\s.,–-]+")  # 2.18 is no figure in such a reference
FEWEST_FIGURES = 4
# Options with the largest influence on a render: one command of a table states all of them, another one none.
CHOICES = ("--mode", "--estimator", "--lens-weights")
RENDERERS = ("lfrenderer", "lfsubmit")


class Table:
    """A table between markers: the page, the line of its first marker, the words of the marker, and the text."""

    def __init__(self, page, line, words, text):
        self.page, self.line, self.words, self.text = page, line, words, text


def tables_of(root, page, lines):
    """Returns the tables of a page, and the faults of its markers."""
    tables, faults, begin = [], [], None
    for number, line in enumerate(lines, 1):
        match = BEGIN.match(line)
        if match and begin:
            faults.append((number, f"a table begins within that of line {begin[0]}"))
        if match:
            begin = (number, match[1])
        elif line == END and begin:
            tables.append(Table(page.relative_to(root), *begin, "\n".join(lines[begin[0]:number - 1]) + "\n"))
            begin = None
        elif line == END:
            faults.append((number, "a table ends that has no beginning"))
    if begin:
        faults.append((begin[0], f"the table has no line {END}"))
    return tables, faults


def tables_without_markers(lines):
    """Yields the first lines of tables with figures that have neither markers nor a reason."""
    inside, begin, figures, by_hand = False, None, 0, False
    for number, line in enumerate([*lines, ""], 1):
        if line.startswith("|"):
            begin = begin or number
            figures += len(FIGURE.findall(REFERENCE.sub("", line)))
        else:
            if begin and figures >= FEWEST_FIGURES and not inside and not by_hand:
                yield begin
            if line.strip():  # an empty line may stand between the reason and the table
                by_hand = bool(BY_HAND.match(line))
            if BEGIN.match(line) or line == END:
                inside = line != END
            begin, figures = None, 0


def is_page(root, path):
    return path.suffix == ".md" and path.relative_to(root).parts[0] == "doc"


def records_of(root, files):
    """Returns {words of the marker: (file, record)}, and the faults of the records' files."""
    records, faults = {}, []
    for path in files:
        if path.suffix != ".json" or path.parent != root / RECORDS:
            continue
        name = path.relative_to(root)
        try:
            record = json.loads(path.read_text())
            words = record["table"]
        except (ValueError, KeyError) as error:
            faults.append(f"{name}: not the record of a table: {error!r}")
            continue
        if words in records:
            faults.append(f"{name}: {records[words][0].relative_to(root)} is of the same table, {words}")
        records[words] = (path, record)
    return records, faults


def default_values(record):
    """Returns {"--estimator": {"auto", "bilinear"}, ...}: the values in --help-all, and those that small renders
    reported."""
    values = {choice: set() for choice in (*CHOICES, "--filter")}
    for line in record["defaults"]:
        program, _, rest = line.partition(" ")
        words = rest.split()
        if program == "lfrenderer" and words[0] in values:
            values[words[0]].add(words[1])
        elif program == "lfrenderer" and words[0].endswith(":"):
            for key, value in (part.split() for part in rest.partition(": ")[2].split(", ")):
                values.get("--" + key.replace("_", "-"), set()).add(value)
    return values


def missing_choices(record):
    """Yields what the commands of a record lack: a render that states the choices, and one with the defaults."""
    renders = [shlex.split(command) for command in record["commands"]]
    renders = [words for words in renders if words[0] in RENDERERS]
    if not renders:
        return
    if not any(set(CHOICES) <= set(words) for words in renders):
        yield f"none of its renders names {', '.join(CHOICES)}"
    values = default_values(record)
    if not any(all(words[i + 1] in values[word] for i, word in enumerate(words[:-1]) if word in values)
               for words in renders):
        yield "none of its renders is that of the defaults"


def changed_defaults(record, today):
    return [line for line in record["defaults"] if line not in today]


def faults_of(root, table, records, today):
    """Yields the faults of one table."""
    if table.words not in records:
        yield f"no record in {RECORDS} is of this table: make it again"
        return
    path, record = records[table.words]
    name = path.relative_to(root)
    absent = [key for key in ("date", "machine", "load", "commands", "defaults", "defaults_hash") if key not in record]
    if "sources" not in record and "commit" not in record:  # older records state a commit
        absent.append("sources")
    if absent:
        yield f"{name} has no {', '.join(absent)}: make the table again"
        return
    text = path.with_suffix(".md")
    if not text.exists() or text.read_text() != table.text:
        yield f"the table is not that of {text.relative_to(root)}: tables are not edited"
    if hashlib.sha256("\n".join(record["defaults"]).encode()).hexdigest()[:16] != record["defaults_hash"]:
        yield f"{name}: defaults_hash is not that of its defaults"
    changed = changed_defaults(record, today)
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        yield f"made when a default was '{changed[0]}'{more}, which is another one today: make it again"
    for fault in missing_choices(record):
        yield f"{name}: {fault}"


def all_tables(root, files, text_lines):
    """Returns the tables of all pages that need a record, and the faults of all markers as lines."""
    tables, faults = [], []
    for page in filter(lambda path: is_page(root, path), files):
        of_page, wrong = tables_of(root, page, text_lines(page))
        tables += [table for table in of_page if not table.words.startswith(GENERATED)]
        faults += [f"{page.relative_to(root)}:{number}: {fault}" for number, fault in wrong]
    return tables, faults


def stale_tables(root):
    path = root / STALE
    lines = path.read_text().splitlines() if path.exists() else []
    return {line for line in lines if line and not line.startswith("#")}


def check_tables(root, files, text_lines):
    """Checks that every table of figures has a record that fits it and the present programs."""
    tables, faults = all_tables(root, files, text_lines)
    yield from faults
    for page in filter(lambda path: is_page(root, path), files):
        for number in tables_without_markers(text_lines(page)):
            yield (f"{page.relative_to(root)}:{number}: a table of figures without markers: make it by a script, "
                   "or say why not in a line <!-- table by hand: ... --> before it")
    stale = stale_tables(root)
    records, faults = records_of(root, files)
    yield from (fault for fault in faults if fault.split(":")[0] not in stale)
    listing = root / LISTING
    today = set(listing.read_text().splitlines()) if listing.exists() else set()
    for table in tables:
        faults = list(faults_of(root, table, records, today))
        if table.words in stale:
            faults = [] if faults else [f"{STALE} lists it, and it is not stale: remove the line"]
        for fault in faults:
            yield f"{table.page}:{table.line}: {fault}"
    known = {table.words for table in tables} | {str(path.relative_to(root)) for path in files}
    for name in sorted(stale - known):
        yield f"{STALE}: {name}: there is no such table or file: remove the line"
    shown = {table.words for table in tables}
    for words, (path, _) in records.items():
        if words not in shown:
            yield f"{path.relative_to(root)}: no page shows its table, {words}"
