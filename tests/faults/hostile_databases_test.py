#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests packages and packed stores made to do harm: with other schemas, values or pages, each under a correct seal and
correct checksums. Programs must keep to the limits of memory and time and report one error.

usage: hostile_databases_test.py LFRENDERER LFPREPROCESSOR LFCOMPRESSOR LFIMPORT [--all]

--all  tests every value in every column, and a thousand damages, instead of a selection
"""
import pathlib
import random
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest

import xxhash

from bounded_runs import BoundedRuns
from small_field import wall, write_field, write_path

PROGRAMS = []
MEMORY_MIB = 128
SEAL = b"LFSEAL1\n"
SEAL_BYTES = 24
ENDLESS = "with recursive c(x) as (select 1 union all select x + 1 from c) select"
EVERY = 11  # one of this many values is tried; a prime, so that all kinds of values meet all types of columns
DAMAGES = 20


def unseal(file):
    """Removes the seal. Returns True if there was one."""
    data = file.read_bytes()
    if data[-SEAL_BYTES:-SEAL_BYTES + len(SEAL)] != SEAL:
        return False
    file.write_bytes(data[:-SEAL_BYTES])
    return True


def seal(file):
    data = file.read_bytes()
    file.write_bytes(data + SEAL + struct.pack("<QQ", len(data), xxhash.xxh3_64_intdigest(data)))


def with_checksum(data):
    return data + struct.pack("<Q", xxhash.xxh3_64_intdigest(data))


def tables_of(file):
    """Returns name -> column names of the tables that have rows."""
    with sqlite3.connect(file) as database:
        names = [name for name, in database.execute("select name from sqlite_master where type = 'table'")]
        tables = {name: [row[1] for row in database.execute(f"pragma table_info({name})")] for name in names}
        return {name: columns for name, columns in tables.items()
                if database.execute(f"select count(*) from {name}").fetchone()[0]}


def key_of(database, table):
    """Returns the column that orders the rows of a table, which may have no rowid."""
    keys = [row[1] for row in database.execute(f"pragma table_info({table})") if row[5]]
    return keys[0] if keys else "rowid"


def schemas(tables):
    """Yields (name, script) for scripts that replace tables."""
    for table, columns in tables.items():
        numbers = ", ".join(f"x as {column}" for column in columns)
        zeros = ", ".join(f"zeroblob(1000000000) as {column}" for column in columns)
        drop = f"drop table {table};"
        yield f"{table} is an endless view", f"{drop} create view {table} as {ENDLESS} {numbers} from c;"
        yield f"{table} is a view of zeros", f"{drop} create view {table} as select {zeros};"
        yield (f"{table} has generated columns", f"{drop} create table {table} (k integer primary key, " + ", ".join(
            f"{column} generated always as (zeroblob(1000000000)) virtual" for column in columns
        ) + f"); insert into {table} (k) values (1);")
        yield f"{table} is gone", drop
        yield f"{table} has one column more", f"alter table {table} add column more;"
        yield f"{table} has a trigger", (f"create trigger t after insert on {table} begin insert into {table} "
                                         f"select * from {table}; end;")
        yield f"{table} has an index of ours", f"create index i on {table} (abs({columns[0]}));"
        yield f"{table} sorts by a collation that is not there", (
            "pragma writable_schema = on; update sqlite_master set sql = replace(replace(sql, ' integer', "
            f"' integer collate nobody'), ' text', ' text collate nobody') where name = '{table}';")
    yield "thousands of tables", "begin;" + "".join(f"create table t{i} (a);" for i in range(3000)) + "commit;"


LONG_TEXT, ZEROS = "../" * 300_000, with_checksum(bytes(10_000_000))


def values(column_value):
    """Yields (name, value) for the values that are tried in place of a value in a column."""
    yield "null", None
    for number in (-1, 0, 1, 65535, 2**31, 2**62, -2**63):
        yield str(number), number
    for number in (1e308, -1e308, 5e-324, float("inf")):
        yield str(number), number
    yield "a text", "x"
    yield "a long text", LONG_TEXT
    yield "control characters", "a\n\x1b[2J\0error: done"
    yield "zeros", ZEROS
    if isinstance(column_value, bytes):
        length = max(0, len(column_value) - 8)
        yield "no bytes", with_checksum(b"")
        yield "bytes 255", with_checksum(b"\xff" * length)
        yield "half of it", with_checksum(column_value[:length // 2])
        yield "twice", with_checksum(column_value[:length] * 2)
        yield "random bytes", with_checksum(random.Random(1).randbytes(length))
        mutated = bytearray(column_value[:length])
        for place in range(0, min(length, 64), 7):
            mutated[place] ^= 0x80
        yield "a few bits", with_checksum(bytes(mutated))


class HostileDatabasesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        renderer, preprocessor, compressor, _ = PROGRAMS
        field = write_field(cls.folder / "field", wall)
        path = cls.path = write_path(cls.folder, frames=1)
        for words in ([preprocessor, field, path, "-o", cls.folder / "packages", "--packages", 1],
                      [compressor, field, "-o", cls.folder / "film.lfs"],
                      [compressor, field, "-o", cls.folder / "lossless.lfs", "--profile", "lossless"]):
            subprocess.run(list(map(str, words)), check=True, capture_output=True)
        cls.package = next((cls.folder / "packages").glob("*.lfp"))
        # A path of a narrow lens at the rim leaves most LF images out of a store of its packages.
        (cls.folder / "rim").mkdir()
        rim = write_path(cls.folder / "rim", frames=1, aperture=0.012, x=-0.02)
        for words in ([preprocessor, field, rim, "-o", cls.folder / "rim", "--packages", 1],
                      [compressor, cls.folder / "rim" / "package-0000.lfp", "-o", cls.folder / "part.lfs"]):
            subprocess.run(list(map(str, words)), check=True, capture_output=True)
        cls.stores = [cls.folder / "film.lfs", cls.folder / "lossless.lfs"]
        cls.part = cls.folder / "part.lfs"
        cls.runs = BoundedRuns(cls.folder, MEMORY_MIB)
        cls.number = 0

    @classmethod
    def tearDownClass(cls):
        print(cls.runs.table(), file=sys.stderr)

    def tearDown(self):
        faults, self.runs.faults[:] = list(self.runs.faults), []
        self.assertEqual([], faults, "\n".join(faults))

    def changed(self, original, change):
        """Returns a copy that change(file) has changed, with a seal if the original has one."""
        type(self).number += 1
        file = self.folder / f"{self.number}{original.suffix}"
        shutil.copyfile(original, file)
        is_sealed = unseal(file)
        change(file)
        if is_sealed:
            seal(file)
        return file

    def calls(self, name, file):
        renderer = PROGRAMS[0]
        out = self.folder / f"out {file.name}"
        if file.suffix == ".lfp":
            # Packages must lie beside the light field that they name.
            moved = self.package.parent / file.name
            file.rename(moved)
            return [(name, [renderer, moved, "-o", out, "--no-contact-sheet"]),
                    (f"{name}, compressed", [PROGRAMS[2], moved, "-o", f"{out}.lfs"])]
        return [(name, [renderer, file, self.path, "-o", out, "--no-contact-sheet"])]

    def all(self, kind, original, changes, accepts):
        calls = []
        for name, change in changes:
            calls += self.calls(name, self.changed(original, change))
        self.runs.all(f"{original.suffix[1:]}: {kind}", calls, accepts)

    @staticmethod
    def script(text):
        def change(file):
            database = sqlite3.connect(file)
            database.execute("pragma synchronous = off")
            database.executescript(text)
            database.close()
        return change

    @staticmethod
    def value(table, column, new):
        def change(file):
            database = sqlite3.connect(file)
            database.execute("pragma synchronous = off")
            key = key_of(database, table)
            database.execute(f"update {table} set {column} = ? where {key} = "
                             f"(select min({key}) from {table})", (new,))
            database.commit()
            database.close()
        return change

    def originals(self):
        return [self.package, *self.stores]

    def test_the_originals_are_accepted(self):
        for original in self.originals():
            self.all("as it is", original, [("as it is", lambda file: None)], accepts=(0,))

    def test_other_schemas_are_refused(self):
        for original in (self.package, self.stores[0]):
            self.all("schemas", original,
                     [(name, self.script(text)) for name, text in schemas(tables_of(original))], accepts=(2, 3))

    def test_lfimport_reads_a_store_without_codes(self):
        """A store whose encoded images lie in other files has no table of them."""
        file = self.changed(self.stores[0], self.script("drop table blobs; drop table fronts;"))
        self.runs.all("lfs: without codes", [("lfimport", [PROGRAMS[3], file])], accepts=(0,))

    def test_marks_of_lf_images_that_are_left_out_may_be_anything(self):
        """The path needs LF images that the store leaves out."""
        texts = ["delete from left_out", "insert into left_out select id from codes",
                 "insert or ignore into left_out select id from lf_images", "insert into left_out values (-1)",
                 "insert into left_out values (1000000000000)", "drop table left_out",
                 "update left_out set id = id + 1000"]
        self.all("marks", self.part, [(text, self.script(text)) for text in ["", *texts]], accepts=(3, 6))

    def test_any_value_may_stand_anywhere(self):
        """Some values, such as another seed or another name of a lens, are as valid as the original ones and are
        accepted."""
        for original in self.originals():
            changes = []
            for table, columns in tables_of(original).items():
                with sqlite3.connect(original) as database:
                    row = database.execute(f"select * from {table} order by {key_of(database, table)}").fetchone()
                for column, old in zip(columns, row):
                    for name, new in values(old):
                        changes.append((f"{table}.{column}: {name}", self.value(table, column, new)))
            self.all("values", original, self.possible(original, changes[::EVERY]), accepts=(0, 2, 3, 6))

    def possible(self, original, changes):
        """Yields the changes that SQLite accepts: an integer primary key, for example, cannot hold a text."""
        for name, change in changes:
            try:
                self.changed(original, change).unlink()
                yield name, change
            except sqlite3.IntegrityError:
                pass

    def test_pages_may_be_damaged_under_a_seal(self):
        for original in self.originals():
            changes = []
            for seed in range(DAMAGES):
                def change(file, seed=seed):
                    chance = random.Random(seed)
                    data = bytearray(file.read_bytes())
                    for _ in range(chance.choice((1, 3, 30))):
                        data[chance.randrange(100, len(data))] = chance.choice((0, 1, 13, 127, 255))
                    file.write_bytes(data)
                changes.append((f"damage {seed}", change))
            for page_bytes in (512, 4096, 65536):
                def change(file, page_bytes=page_bytes):  # each number that may name a child page names its own page
                    data = bytearray(file.read_bytes())
                    for place in range(100, len(data) - 4, 4):
                        if data[place:place + 3] == b"\0\0\0" and 0 < data[place + 3] < 64:
                            data[place + 3] = 1 + place // page_bytes % 8
                    file.write_bytes(data)
                changes.append((f"pages in a ring of {page_bytes}", change))
            self.all("damaged pages", original, changes, accepts=(0, 2, 3, 6))


if __name__ == "__main__":
    PROGRAMS = sys.argv[1:5]
    if sys.argv[5:] == ["--all"]:
        EVERY, DAMAGES = 1, 1000
    unittest.main(argv=sys.argv[:1], verbosity=2)
