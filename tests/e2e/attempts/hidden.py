"""Requests hidden content in every way: the private content of a project, other projects, and
content through the copied link of a kiosk."""
import concurrent.futures

from attempts.tools import FOREIGN, statuses, upgraded
from support import kiosk_site, visibility_site
from support.live_client import LiveClient
from support.project_sites import Someone, make_sites, nothing_is_seen
from support.sql_reader import Reader, free_port
from support.strata_server import StrataServer


def as_role(server, role, camera, before, words, hidden, thread):
    """Returns the private content that a user with that role can find, by each kind of request."""
    token = server.add_person(role, role)
    answered, told = visibility_site.sweep(server, token, words, camera)
    assert answered > 100, answered
    assert visibility_site.doors_closed(server, token, words, hidden, thread) > 60
    names = visibility_site.names_unknown(server, token, camera)
    picture = server.ok(
        "POST", visibility_site.M + "/frame", {"camera": camera, "format": "png"}, token=token
    ).body
    with LiveClient(server, "sheet", token=token) as connection:
        welcome = connection.hello(dpr=1, accept=["jpeg"])
        server.ok(
            "POST",
            f"{visibility_site.M}/layers/{visibility_site.LAYER}/edits",
            {"op": "fill", "mode": "where", "where": "x < 30", "value": visibility_site.VALUE},
        )
        server.ok(
            "PATCH",
            "/tables/finds/records/1",
            {"values": {visibility_site.COLUMN: visibility_site.CELL + " of " + role}},
        )
        heard = connection.receive_until("record", "layer", "comment")
    return {
        "answered": answered,
        "told": len(told),
        "names": names,
        "same_picture": picture == before,
        "heard": heard["op"],
        "leaked": len(visibility_site.leaks(repr([welcome, heard]).encode())),
    }


def private(table):
    section = table.section("Private layers, columns and files, as a viewer and an annotator")
    port = free_port()
    with StrataServer(
        options=["--sql-listen", f"127.0.0.1:{port}"]
    ) as server, concurrent.futures.ThreadPoolExecutor(2) as hands:
        camera, before, public, hidden, thread = visibility_site.make_site(server)
        words = visibility_site.words(server, public)
        both = list(
            hands.map(
                lambda role: as_role(server, role, camera, before, words, hidden, thread),
                ("viewer", "annotator"),
            )
        )

        def of(what):
            return sum(each[what] for each in both)

        section.tried(
            "Every query of the contract, with each value of each parameter: points, profiles, statistics, exports, rasters, pictures, records, comments, views, tours, activity, jobs",
            f"secrets in {of('told')} operations",
            "secrets in 0 operations",
            "all code that reads layers, columns and files requires the role, without a default",
            f"{of('answered')} answers",
        )
        not_there = "exactly the answer for missing items"  # the function checks each response
        section.tried(
            "Addresses of private items, by slug and by id, for reading and changing",
            not_there,
            not_there,
            "the server searches only the content that the user can see",
        )
        section.tried(
            "Names of private items in conditions, filters, orders, lists, imports",
            "exactly the answer for unknown names",
            "exactly the answer for unknown names",
            "the server searches only the content that the user can see",
            f"{of('names')} calls",
        )
        section.tried(
            "A picture of the model",
            "same bytes as without private items" if of("same_picture") == 2 else "another",
            "same bytes as without private items",
            "the renderer gets only the visible layers",
        )
        section.tried(
            "The live connection, while curators paint and write private items",
            f"{of('leaked')} secrets, {'only the record’s public cells' if {each['heard'] for each in both} == {'record'} else both}",
            "0 secrets, only the record’s public cells",
            "the server filters each event for each client",
        )
        reader = Reader(server, port)
        leaked = {
            view
            for view in ("layers", "areas", "edits", "record_edits", '"Finds"')
            if visibility_site.leaks(reader.run(f"SELECT * FROM {view}").stdout.encode())
        }
        section.tried(
            "SQL views",
            f"in {len(leaked)} of 5 views",
            "in 0 of 5 views",
            "analysts see only public content",
        )
        sql(reader, table.section("SQL of analysts"))
        server.assert_clean_log()


def sql(reader, section):
    refused = "permission denied", "must be", "cannot"
    changes = (
        "DELETE FROM edits",
        "UPDATE models SET model = 'x'",
        "CREATE TABLE public.t (a int)",
        "CREATE ROLE r",
        "ALTER ROLE strata_reader SUPERUSER",
        "SELECT lo_create(0)",
    )
    secrets = [
        f"SELECT * FROM public.{name}"
        for name in ("tokens", "users", "blobs", "answers", "tile_revisions")
    ] + ["SELECT * FROM pg_authid", "SELECT * FROM records.t1"]
    machine = (
        "COPY (SELECT 1) TO PROGRAM 'id'",
        "SELECT pg_read_file('/etc/passwd')",
        "COPY (SELECT 1) TO '/tmp/x'",
        "SELECT pg_ls_dir('/')",
    )
    for what, statements, keeps in (
        (
            "Changes, after `default_transaction_read_only` is switched off",
            changes,
            "the rights of the role prevent changes, independent of this setting",
        ),
        ("Tables of tokens, people, files and texels", secrets, "rights only on views"),
        ("Files and commands of the server's machine", machine, "no such rights"),
    ):
        done = [
            reader.run("SET default_transaction_read_only = off", statement)
            for statement in statements
        ]
        let = [
            statement
            for statement, each in zip(statements, done)
            if each.returncode == 0 or not any(word in each.stderr for word in refused)
        ]
        section.tried(
            what, f"{len(let)} allowed", "0 allowed", keeps, f"{len(statements)} statements"
        )
    others = [
        reader.run("SELECT 1", password="wrong"),
        reader.run("SELECT 1", user="strata"),
        reader.run("SELECT 1", user="postgres"),
        reader.run("SELECT 1", database="postgres"),
    ]
    section.tried(
        "A wrong password, another role, another database",
        f"{sum(each.returncode == 0 for each in others)} accepted",
        "0 accepted",
        "a separate password for one role and one database",
    )


def kiosk(table):
    section = table.section("A kiosk's link, copied from its screen")
    with StrataServer() as server:
        _, files, thread = kiosk_site.make_site(server)
        server.add_person("carl", "curator")
        tour = (
            kiosk_site.ALL + "/" + server.ok("POST", kiosk_site.ALL, kiosk_site.TOUR).json()["slug"]
        )
        made, secret = kiosk_site.make_kiosk(server, tour)
        answered, refused = kiosk_site.sweep(server, secret, tour, files, thread)
        section.tried(
            "Every call of the contract that changes something, or reads content that kiosks do not show",
            403,
            403,
            "a list of allowed calls: all others are refused, also future ones",
            f"{refused} calls; {answered} that read the tour's model are allowed",
        )
        kiosk_site.others_closed(server, secret, files)
        section.tried(
            "Other models, tables that neither its layers nor the tour use, private files",
            404,
            404,
            "the server compares the address with the tour",
        )
        section.tried(
            "Signing in with the link, or accepting an invitation with it",
            statuses(
                [
                    server.post(
                        "/login", {"token": secret}, token=False, headers={"Origin": server.url}
                    ),
                    server.post(
                        "/invitations/accept",
                        {"invitation": secret, "password": "seven blue herons at noon"},
                        token=False,
                        headers={"Origin": server.url},
                    ),
                ]
            ),
            {401, 403},
            "the link is not a user's token",
        )
        as_session = {
            server.get(
                kiosk_site.M, token=False, headers={"Cookie": "strata_session=" + secret}
            ).status,
            server.get(
                kiosk_site.M, token=False, headers={"Cookie": "strata_kiosk=" + secret}
            ).status,
            upgraded(server, token="", cookie="strata_session=" + secret, origin=server.url),
        }
        section.tried(
            "The link as the session cookie, or as the kiosk's cookie without `as=kiosk`",
            as_session,
            401,
            "each cookie is valid only for its own page",
        )
        section.tried(
            "The kiosk's live connection from a foreign page, or to another model",
            {
                upgraded(
                    server,
                    token="",
                    cookie="strata_kiosk=" + secret,
                    origin=FOREIGN,
                    query="?as=kiosk",
                ),
                upgraded(server, "other", token=secret),
            },
            {403, 404},
            "as for users",
        )
        with LiveClient(server, "sheet", token=secret) as connection:
            connection.hello(dpr=1, accept=["jpeg"])
            one = "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b01"
            answers = set()
            for message in (
                {
                    "op": "edit",
                    "id": one,
                    "layer": "cracks",
                    "edit": {"op": "fill", "mode": "where", "where": "true", "value": 1},
                },
                {"op": "undo", "id": one, "layer": "cracks"},
                {"op": "presence", "pointer": [1, 1]},
                {"op": "record.edit", "id": one, "table": 1, "key": 1, "editing": True},
            ):
                connection.send(message)
                answers.add(connection.receive_until("problem")["status"])
            section.tried(
                "Painting, undo, pointing and locks over the kiosk's live connection",
                answers,
                403,
                "the server accepts five kinds of messages",
            )
            server.ok("DELETE", f"/kiosks/{made['id']}")
            connection.until_closed()
        section.tried(
            "The link after it was revoked",
            {
                server.get(kiosk_site.M, token=secret).status,
                server.post("/auth/kiosk", {"link": secret}, token=False).status,
                upgraded(server, token=secret),
            },
            401,
            "the link ends immediately, and open screens are disconnected",
        )
        server.assert_clean_log()


def projects(table):
    section = table.section("Other projects")
    with StrataServer() as server:
        sites = make_sites(server)
        guest = Someone(server, "Gus", "guest")
        section.tried(
            "Every address of the contract in a project without a role for the guest, by slug and by id, for reading and changing",
            "404, as for missing items"
            if nothing_is_seen(server, guest, sites["villa"]) > 120
            else "few",
            "404, as for missing items",
            "the server checks the project before the handler runs",
            "more than 120 addresses; also lists, uploads and the live connection",
        )
        guest.now("villa", "curator")
        section.tried(
            "The same addresses, as a curator of another project",
            "404, as for missing items"
            if nothing_is_seen(server, guest, sites["forum"]) > 120
            else "few",
            "404, as for missing items",
            "a role applies only to its own project",
        )
        server.assert_clean_log()
