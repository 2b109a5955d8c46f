#!/usr/bin/env python3
"""What somebody who means harm would try, really tried against real servers, with the answers as a table. Fails where an answer is another one, and where docs/security.md tells something
else than the answers; `--update-docs` writes it anew."""
import concurrent.futures
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
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


# Each with servers of its own: most of the time of some is waiting.
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


def main():
    chosen = [word for word in sys.argv[1:] if not word.startswith("--")] or list(GROUPS)
    tables = {name: AttemptTable() for name in chosen}
    with concurrent.futures.ThreadPoolExecutor(len(chosen)) as hands:
        running = [hands.submit(GROUPS[name], tables[name]) for name in chosen]
        for each in running:
            each.result()
    table = AttemptTable()
    table.sections = [section for name in chosen for section in tables[name].sections]
    print(table.markdown())
    print(f"{sum(len(section.rows) for section in table.sections)} attempts")
    if "--update-docs" in sys.argv:
        table.write()
    elif len(chosen) == len(GROUPS):
        table.check_page()


if __name__ == "__main__":
    main()
