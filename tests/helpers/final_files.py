# SPDX-License-Identifier: Apache-2.0
"""Judges the files of a program that was disturbed: those with final names must be old or right."""
import hashlib
import json
import re
import sqlite3

TEMPORARY = re.compile(r"^\..*\.tmp|\.unfinished|-journal$|(^|\.)lock$")
# Folders of checkpoints and jobs, such as partial and stack.exr.partial: only the results made from them are judged.
OWN_FOLDER = re.compile(r"^(partial|cluster|.*\.partial)$")


def store_digest(path):
    """Returns a digest of the tables without values that differ from run to run."""
    database = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
    digest_of_rows = hashlib.sha256()
    for (table,) in sorted(database.execute("select name from sqlite_master where type = 'table'")):
        for row in database.execute(f"select * from {table} order by 1"):
            # Sizes of image files are not compared: they only inform people, and are unknown if stat() failed.
            if table == "codes":
                row = row[:-1]
            elif table == "lf_images" and path.suffix == ".lfp":
                row = row[:10] + row[11:]
            if table != "settings" or row[0] not in ("store",):
                digest_of_rows.update(repr(row).encode())
    database.close()
    return digest_of_rows.hexdigest()


def digest(path):
    """Returns a digest of a file's content. ValueError or sqlite3.Error if the file is damaged."""
    if path.suffix in (".lfs", ".lfp"):
        return store_digest(path)
    if path.name == "run.json" or path.suffix == ".json" and "report" in path.name:
        json.loads(path.read_text())  # times differ
        return "a report"
    return hashlib.sha256(path.read_bytes()).hexdigest()


def files_of(folder):
    """Returns the digest of each file with a final name, and the names of the temporary files."""
    final, temporary = {}, []
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder)
        if not path.is_file() or path.is_symlink():
            continue
        if TEMPORARY.search(path.name):
            is_kept_lock = "cluster" in name.parts and path.name.endswith("lock")
            if not any(part.endswith("partial") for part in name.parts) and not is_kept_lock:
                temporary.append(str(name))
            continue
        if any(map(OWN_FOLDER.search, name.parts)):
            continue
        try:
            final[str(name)] = digest(path)
        except (ValueError, sqlite3.Error) as error:
            final[str(name)] = f"damaged: {error}"
    return final, temporary


def last_line(errors):
    return errors.strip().splitlines()[-1] if errors.strip() else ""


def differing(final, right):
    """Returns the names of files that are missing, superfluous or wrong."""
    return sorted(name for name in {*right, *final} if right.get(name) != final.get(name))


def faults_of_success(final, temporary, right):
    """Returns what is wrong with the files of a program that ended with 0."""
    faults = []
    if wrong := differing(final, right):
        faults.append(f"status 0, other files: {wrong[:4]}")
    if temporary:
        faults.append(f"status 0, left over: {temporary[:4]}")
    return faults


def faults_of_status(code, errors, codes):
    """Returns what is wrong with the status and the last line of a program that failed."""
    last = last_line(errors)
    if code not in codes:
        return [f"status {code}: {last[:200]}"]
    return [] if last.startswith("error: ") else [f"last line: {last[:200]}"]


def faults_of_finals(final, right, old):
    """Returns the files with final names that are neither the old ones nor the right ones."""
    return [f"{name} is {what[:60]}, not what it should be" for name, what in final.items()
            if what not in (right.get(name), old.get(name))]


def faults_of_going_on(commands, call, files, right):
    """Resumes after a failure. All commands but the last may refuse; the last must end with the right files.

    call   runs a command and returns its status and its output
    files  returns the files with final names, and the temporary files
    """
    for command in commands:
        code, errors = call(command)
        final, temporary = files()
        if code != 0 and command is not commands[-1]:
            if faults := faults_of_status(code, errors, (2, 3, 4)):
                return [f"going on: {fault}" for fault in faults]
            continue
        wrong = differing(final, right)
        if code != 0 or wrong or temporary:
            return [f"once more: status {code}, {last_line(errors)[:200]}, other files {wrong[:4]}, "
                    f"left over {temporary[:4]}"]
        return []
    return []
