#!/usr/bin/env python3
"""Attacks on real servers, with the results as a table.

Fails if a result differs from the expected one, or if docs/reference/security.md differs from the
results. `--update-docs` writes the results to that page."""
import concurrent.futures
import sys

import pytest
from attempts import (
    bodies,
    coming_in,
    files,
    foreign_pages,
    guessing,
    hidden,
    live,
    owner_token,
    readers,
    waiting,
)
from support.attempt_table import AttemptTable
from support.meshes import folded_grid
from support.strata_server import StrataServer


def site(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", "/models/sheet/layers", {"name": "Marks", "type": "u8"})
    server.ok(
        "POST",
        "/projects/default/tables",
        {"name": "Kept", "columns": [{"name": "Note"}, {"name": "Files", "kind": "document"}]},
    )
    server.ok("POST", "/tables/kept/records", {"values": {"note": "stays"}})


def at_one_server(*attempted):
    def run(table):
        with StrataServer() as server:
            site(server)
            for each in attempted:
                each.attempts(server, table)
            assert server.get("/tables/kept/records/1").json()["values"]["note"] == "stays"
            assert server.stop() == 0
            server.assert_clean_log()

    return run


# Each group has its own servers, because some groups mostly wait.
GROUPS = {
    "people": at_one_server(coming_in, guessing),
    "owner": lambda table: owner_token.attempts(table, site),
    "requests": at_one_server(foreign_pages, live, bodies, files),
    "private": hidden.private,
    "kiosk": hidden.kiosk,
    "projects": hidden.projects,
    "readers": readers.attempts,
    "waiting": waiting.plain,
    "https": waiting.tls,
}


def begun():
    """Starts all groups at the same time, because some groups mostly wait. Returns the future
    tables."""
    hands = concurrent.futures.ThreadPoolExecutor(len(GROUPS))

    def made(attempts):
        table = AttemptTable()
        attempts(table)
        return table

    return {name: hands.submit(made, attempts) for name, attempts in GROUPS.items()}


def joined(tables):
    table = AttemptTable()
    table.sections = [section for each in tables.values() for section in each.result().sections]
    return table


@pytest.fixture(scope="module")
def tables():
    return begun()


@pytest.mark.parametrize("name", GROUPS)
def test_each_answer_is_the_one_expected(tables, name):
    print(tables[name].result().markdown())


def test_the_page_tells_what_was_answered(tables):
    joined(tables).check_page()


def main():
    """Compares the table with the page, or writes it."""
    if sys.argv[1:] != ["--update-docs"]:
        sys.exit("security_attempts_test.py --update-docs; as a test it is run by pytest")
    joined(begun()).write()


if __name__ == "__main__":
    main()
