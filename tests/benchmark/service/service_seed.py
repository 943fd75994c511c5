# SPDX-License-Identifier: Apache-2.0
"""A long history in little time: real jobs, made over HTTP, are copied in the store under new ids.

Nothing here knows the schema: columns and tables are read from the database, and a copy differs from
its original in its id only. Every copy gets a folder with the events of its original, so that a
daemon that starts finds what it would find."""
import os
import sqlite3

ALPHABET = "0123456789abcdefghjkmnpqrstvwxyz"  # of ids: the first ten are milliseconds since 1970


def make_id(milliseconds, number):
    text = ""
    for value, digits in ((milliseconds, 10), (number, 16)):
        part = ""
        for _ in range(digits):
            part = ALPHABET[value % 32] + part
            value //= 32
        text += part
    return text


def columns_of(database, table):
    """Names of a table's columns, without an automatic row number."""
    return [name for _, name, kind, *_, key in database.execute(f"PRAGMA table_info({table})")
            if not (key and kind == "INTEGER")]


def tables_of_jobs(database):
    """Tables that hold rows of jobs beside the table of jobs itself."""
    names = [name for name, in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
    return [name for name in names if "job" in columns_of(database, name)]


def copy_rows(database, table, key, original, copies):
    columns = columns_of(database, table)
    place = columns.index(key)
    rows = database.execute(f"SELECT {', '.join(columns)} FROM {table} WHERE {key} = ?", (original,))
    marks = ", ".join("?" * len(columns))
    for row in rows.fetchall():
        database.executemany(f"INSERT OR IGNORE INTO {table} ({', '.join(columns)}) VALUES ({marks})",
                             (row[:place] + (copy,) + row[place + 1:] for copy in copies))


def seed(state, originals, count, begin=1_600_000_000_000):
    """Adds `count` jobs to the store in `state` while no daemon runs; returns their ids, oldest
    first. Neighbours in time are copies of different originals."""
    ids = [make_id(begin + 1000 * number, number) for number in range(count)]
    database = sqlite3.connect(os.path.join(state, "talus.sqlite"))
    database.execute("PRAGMA synchronous = OFF")
    database.execute("PRAGMA foreign_keys = ON")
    with database:
        for place, original in enumerate(originals):
            copies = ids[place::len(originals)]
            copy_rows(database, "jobs", "id", original, copies)
            for table in tables_of_jobs(database):
                copy_rows(database, table, "job", original, copies)
    database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    database.close()
    for place, copy in enumerate(ids):
        original = os.path.join(state, "jobs", originals[place % len(originals)])
        folder = os.path.join(state, "jobs", copy)
        os.mkdir(folder)
        os.link(os.path.join(original, "events.ndjson"), os.path.join(folder, "events.ndjson"))
    return ids
