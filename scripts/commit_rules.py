# SPDX-License-Identifier: Apache-2.0
"""Checks the messages of commits, for check_house.py (doc/style.md, "Commits"): a subject `folder: Imperative summary`
of at most 72 characters, and a body that says why, where more than 50 lines change."""
import re
import subprocess

# Commits up to this one were written before the check existed.
LAST_UNCHECKED = "159f65395b40"
# Commits whose fault (a subject of 73 characters; tests without a body) was found after others had built on them.
# Published history is not rewritten.
TOLERATED = {"75ac7e834ae9", "87a71d5d5c5a", "c326c947c25b"}
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


def check_messages(root, after=LAST_UNCHECKED):
    """Yields the faults of the commits after `after`. The history of the repository must be whole."""
    log = subprocess.run(["git", "-C", root, "log", "--no-merges", "--shortstat", "--format=%x00%H%x01%s%x01%b%x01",
                          f"{after}..HEAD"], capture_output=True, text=True)
    if log.returncode != 0:
        yield f"scripts/commit_rules.py: commit {after} is not in the history: {log.stderr.strip()}"
    for entry in log.stdout.split("\0")[1:]:
        full_hash, subject, body, statistics = entry.split("\1")
        commit = full_hash[:12]
        if commit in TOLERATED:
            continue
        changed_lines = sum(map(int, re.findall(r"(\d+) (?:insertion|deletion)", statistics)))
        for fault in faults_of(subject, body, changed_lines):
            yield f"commit {commit} ({subject}): {fault}"
