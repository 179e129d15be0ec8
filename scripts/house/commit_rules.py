# SPDX-License-Identifier: Apache-2.0
"""Checks the messages of commits, for check_house.py (doc/style.md, "Commits"): a subject `folder: Imperative summary`
of at most 72 characters, and a body that says why, where more than 50 lines change."""
import datetime
import pathlib
import re
import subprocess

# Commits that were written before this time, when the check began to exist, are not checked. Squashing and rebasing
# change hashes of commits, but not when they were written.
FIRST_CHECKED = datetime.datetime.fromisoformat("2026-11-26T03:30:00+00:00")
# Subjects of commits whose fault (73 characters; tests without a body) was found after others had built on them.
# Published history is not rewritten.
TOLERATED = {"python: Tell the end of every phase, and shrink thumbnails by the library",
             "pixels/files: Test the joining of EXR files",
             "analysis/focus_stack: Test the planes, and fuzz their parser"}
SUBJECT_LIMIT, LINES_WITHOUT_BODY = 72, 50
SUBJECT = re.compile(r"^[\w./*{}-]+(?:, [\w./*{}-]+)*: (?P<verb>[A-Z][a-z]*)\b")
# Matches a verb in the past or in the progressive form, but not "Feed". IMPERATIVE lists the imperatives that it
# matches.
NOT_IMPERATIVE = re.compile(r"[A-Za-z]{2}(?:[^e]ed|ing)$")
IMPERATIVE = {"Embed", "Bring"}


def faults_of(subject, body, changed_lines):
    """Yields what is wrong with the message of a commit."""
    if len(subject) > SUBJECT_LIMIT:
        yield f"the subject has {len(subject)} characters, at most {SUBJECT_LIMIT} are allowed"
    match = SUBJECT.match(subject)
    if not match:
        yield "expected a subject such as 'render: Resume after a full disk'"
    elif match["verb"] not in IMPERATIVE and NOT_IMPERATIVE.search(match["verb"]):
        yield f"'{match['verb']}' is no imperative"
    if changed_lines > LINES_WITHOUT_BODY and not body.strip():
        yield f"{changed_lines} lines change, and no body says why"


def why_no_history(root):
    """Returns why commits cannot be looked up, or an empty text if they can."""
    git = lambda *words: subprocess.run(["git", "-C", root, *words], capture_output=True, text=True)
    top = git("rev-parse", "--show-toplevel")
    if top.returncode != 0 or pathlib.Path(top.stdout.strip()).resolve() != root.resolve():
        return "this is no clone of the repository, but its files alone"
    if git("rev-parse", "--is-shallow-repository").stdout.strip() == "true":
        return "this clone is shallow: git fetch --unshallow"
    return ""


def check_messages(root, first=FIRST_CHECKED):
    """Yields the faults of the commits that were written at `first` or later. The history must be whole."""
    log = subprocess.run(["git", "-C", root, "log", "--no-merges", "--shortstat",
                          "--format=%x00%h%x01%at%x01%s%x01%b%x01"], check=True, capture_output=True, text=True)
    for entry in log.stdout.split("\0")[1:]:
        commit, written, subject, body, statistics = entry.split("\1")
        if int(written) < first.timestamp() or subject in TOLERATED:
            continue
        changed_lines = sum(map(int, re.findall(r"(\d+) (?:insertion|deletion)", statistics)))
        for fault in faults_of(subject, body, changed_lines):
            yield f"commit {commit} ({subject}): {fault}"
