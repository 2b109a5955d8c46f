"""Lists in pages: while others add and delete entries, a walk along `next` returns each permanent
entry exactly once."""
import base64
import itertools
import json
import re
import threading
import urllib.parse

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import png

M, T = "/models/sheet", "/tables/units"
KEPT = 7  # the number of permanent entries in each list


def next_of(answer):
    link = re.search(r'<([^>]*)>; rel="next"', answer.headers["Link"] or "")
    return link and link[1].removeprefix("/api/v1")


def walk(server, asked, member, limit=2):
    """Returns all entries of a list, page by page. Each page starts after the last returned
    entry."""
    told, pages = [], 0
    target = f"{asked}{'&' if '?' in asked else '?'}limit={limit}"
    while target:
        answer = server.ok("GET", target)
        entries = answer.json()[member]
        assert len(entries) <= limit, (target, len(entries))
        told += entries
        target = next_of(answer)
        assert target is None or (
            "after=" in target and "offset=" not in target and entries
        ), target
        pages += 1
        assert pages < 2000, f"{asked} has no end"
    return told


class Writer:
    """Adds entries to a list and deletes them, as fast as the server responds, until the test
    ends."""

    def __init__(self, churn):
        self.churn, self.stopped, self.rounds, self.failure = churn, threading.Event(), 0, None
        self.thread = threading.Thread(target=self.run)

    def run(self):
        try:
            while not self.stopped.is_set():
                self.churn(self.rounds)
                self.rounds += 1
        except BaseException as failure:  # the test's main thread reports it
            self.failure = failure

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.stopped.set()
        self.thread.join()
        if self.failure:
            raise self.failure


def check_walks(server, asked, member, name_of, kept, churn, in_order=True):
    """`kept` are the names (`name_of`) of the permanent entries, in their order."""
    with Writer(churn) as writer:
        walks = 0
        while walks < 3 or (writer.rounds < 4 and not writer.failure):
            told = [name_of(entry) for entry in walk(server, asked, member, limit=1 + walks % 3)]
            found = [name for name in told if name in set(kept)]
            assert len(found) == len(set(found)), f"{asked}: told twice: {found}"
            assert sorted(found) == sorted(kept), f"{asked}: missed {set(kept) - set(found)}"
            assert not in_order or found == list(kept), f"{asked}: {found} is not in order"
            walks += 1
    print(f"{asked}: {walks} walks while somebody wrote {writer.rounds} times", flush=True)


def make_site(server):
    model = server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    columns = [
        {"name": "Code"},
        {"name": "Depth", "kind": "numeric"},
        {"name": "Dug", "kind": "date"},
        {"name": "Period", "kind": "period"},
        {"name": "Sure", "kind": "boolean"},
    ]
    server.ok("POST", "/projects/default/tables", {"name": "Units", "columns": columns})
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Units", "kind": "database", "type": "u16", "table": "units"},
    )
    return camera_from(model, (0, 0, 1), up=(0, 1, 0))


@pytest.fixture(scope="module", autouse=True)
def camera(server):
    return make_site(server)


def test_records(server):
    """Records sorted by a column of each kind, in both directions, with equal and missing
    values."""
    values = []
    for n in range(KEPT * 2):
        values.append(
            {
                "code": None
                if n % 5 == 0
                else f"{'ABC'[n % 3]} ä{n % 2} {'long ' * 30 if n % 4 == 1 else ''}",
                "depth": None if n % 4 == 0 else 0.1 * (n % 3),
                "dug": None if n % 6 == 0 else f"2024-05-0{1 + n % 4}",
                "period": None if n % 7 == 0 else f"15{10 + n % 3}",
                "sure": None if n % 3 == 0 else n % 2 == 0,
            }
        )
    made = server.ok(
        "POST", T + "/records", {"records": [{"values": each} for each in values]}
    ).json()["records"]
    kept = [each["key"] for each in made]

    def churn(n):
        key = server.ok(
            "POST",
            T + "/records",
            {
                "values": {
                    "code": "ABC"[n % 3],
                    "depth": 0.1 * (n % 3),
                    "dug": f"2024-05-0{1 + n % 4}",
                    "sure": n % 2 == 0,
                }
            },
        ).json()["key"]
        server.ok("DELETE", f"{T}/records/{key}?texels=refuse")

    orders = [
        "",
        "key",
        "-key",
        "code",
        "-code",
        "depth",
        "-depth",
        "dug",
        "-period",
        "sure,-depth",
        "code,-dug,depth",
        "depth,-key",
    ]
    for order in orders:
        asked = f"{T}/records" + (f"?sortby={order}" if order else "")
        whole = [each["key"] for each in server.ok("GET", asked).json()["records"]]
        assert sorted(whole) == sorted(kept)
        assert [
            each["key"] for each in walk(server, asked, "records", limit=3)
        ] == whole, f"{order}: pages are not the whole list"
        check_walks(server, asked, "records", lambda entry: entry["key"], whole, churn)
    for asked in (
        f"{T}/records?sortby=code&lang=de",
        f"{T}/records?sortby=depth&at={server.ok('GET', T).json()['sequence']}",
        f"{T}/records?sortby=-depth&filter=" + urllib.parse.quote("depth > 0.05 or depth is null"),
    ):
        whole = [each["key"] for each in server.ok("GET", asked).json()["records"]]
        assert [each["key"] for each in walk(server, asked, "records", limit=2)] == whole, asked
    # records sorted by measurements of the layer
    server.ok(
        "POST",
        M + "/layers/units/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": kept[3]},
    )
    asked = M + "/layers/units/records?sortby=-area_m2"
    whole = [each["key"] for each in server.ok("GET", asked).json()["records"]]
    assert whole[0] == kept[3]
    check_walks(server, asked, "records", lambda entry: entry["key"], whole, churn)


def test_lists_that_others_write(server, camera):
    lists = lists_that_others_write(server, camera)
    for (asked, member), (make, remove, name_of) in lists.items():
        check_list(server, asked, member, make, remove, name_of)


def lists_that_others_write(server, camera):
    """Returns each list with functions that make, delete and identify its entries."""

    def views(kind, body):
        def make(n):
            return server.ok("POST", f"{M}/{kind}", {"name": f"{kind} {n}", **body}).json()["id"]

        return (
            make,
            lambda made: server.ok("DELETE", f"{M}/{kind}/{made}"),
            lambda entry: entry["id"],
        )

    thread = server.ok(
        "POST", M + "/comments", {"text": "A thread.", "position": [30, 30, 0]}
    ).json()["id"]
    tour = {"languages": ["en"], "stops": [{"view": "west", "title": {"en": "West"}}]}
    server.ok("POST", M + "/views", {"name": "West", "camera": camera})
    by_id = lambda entry: entry["id"]
    people = itertools.count()

    def add_person(_):
        name = f"{'aZmK'[next(people) % 4]}-{next(people)}"
        server.ok("POST", "/users", {"user": name, "role": "viewer"})
        return name

    def made(path, body, field="id"):
        return lambda n: server.ok("POST", path, body(n)).json()[field]

    def delete(path):
        return lambda one: server.ok("DELETE", f"{path}/{one}")

    def member(n):
        person = add_person(n)
        server.ok("PUT", f"/projects/default/members/{person}", {"role": "annotator"})
        return person

    def bin_entry(n):
        layer = server.ok("POST", M + "/layers", {"name": f"Gone {n}", "type": "u8"}).json()["id"]
        server.ok("DELETE", f"{M}/layers/{layer}")
        return f"layer-{layer}"

    picture = png(8, 8, lambda x, y: (9, 9, 9))
    shape = png(64, 64, lambda x, y: (255,) * 3 if x < 32 else (0,) * 3)
    names = lambda n: f"{'bAcB'[n % 4]} {n}"
    of_png = {"Content-Type": "image/png"}
    return {
        (M + "/comments", "comments"): (
            made(M + "/comments", lambda n: {"text": f"{n}", "position": [30, 30, 0]}),
            delete("/comments"),
            by_id,
        ),
        (f"/comments/{thread}/replies", "replies"): (
            made(f"/comments/{thread}/replies", lambda n: {"text": f"{n}"}),
            delete("/comments"),
            by_id,
        ),
        (M + "/views", "views"): views("views", {"camera": camera}),
        (M + "/tours", "tours"): views("tours", tour),
        (M + "/snapshots", "snapshots"): views("snapshots", {}),
        (M + "/selections", "selections"): views("selections", {"within": {"where": "true"}}),
        (M + "/layers", "layers"): (
            made(M + "/layers", lambda n: {"name": names(n), "type": "u8"}),
            delete(M + "/layers"),
            by_id,
        ),
        (M + "/looks", "looks"): (
            lambda n: server.ok("POST", f"{M}/looks?name=look{n}", picture, headers=of_png).json()[
                "id"
            ],
            delete(M + "/looks"),
            by_id,
        ),
        ("/tools", "tools"): (
            lambda n: server.ok(
                "POST",
                "/tools?" + urllib.parse.urlencode({"name": names(n)}),
                shape,
                headers=of_png,
            ).json()["id"],
            delete("/tools"),
            by_id,
        ),
        ("/projects", "projects"): (
            made("/projects", lambda n: {"name": names(n)}),
            delete("/projects"),
            by_id,
        ),
        ("/projects/default/tables", "tables"): (
            made("/projects/default/tables", lambda n: {"name": names(n)}),
            delete("/tables"),
            by_id,
        ),
        ("/projects/default/objects", "objects"): (
            made("/projects/default/objects", lambda n: {"name": f"{names(n)}"}),
            delete("/projects/default/objects"),
            by_id,
        ),
        ("/projects/default/bills", "bills"): (
            made("/projects/default/bills", lambda n: {"name": f"{names(n)}"}),
            delete("/projects/default/bills"),
            by_id,
        ),
        (T + "/columns", "columns"): (
            lambda n: server.ok("POST", T + "/columns", {"name": names(n)}).json()["column"]["id"],
            delete(T + "/columns"),
            by_id,
        ),
        ("/groups", "groups"): (
            made("/groups", lambda n: {"name": f"{names(n)}", "members": []}),
            delete("/groups"),
            by_id,
        ),
        ("/users", "users"): (add_person, delete("/users"), lambda entry: entry["user"]),
        ("/projects/default/people", "people"): (
            add_person,
            delete("/users"),
            lambda entry: entry["user"],
        ),
        ("/projects/default/members", "members"): (
            member,
            delete("/users"),
            lambda entry: entry["user"],
        ),
        ("/me/tokens", "tokens"): (
            lambda n: server.ok("POST", "/me/tokens", {"name": f"t{n}", "days": 1}).json()["token"][
                "id"
            ],
            delete("/me/tokens"),
            by_id,
        ),
        ("/projects/default/bin", "entries"): (bin_entry, delete("/projects/default/bin"), by_id),
    }


def check_list(server, asked, member, make, remove, name_of):
    numbers = itertools.count()
    for _ in range(KEPT):
        make(next(numbers))
    stays = [name_of(entry) for entry in server.ok("GET", asked + "?limit=1000").json()[member]]
    assert len(stays) >= KEPT

    def churn(_):
        # such an entry can start or end a page, and is deleted before the next page
        added = [make(next(numbers)) for _ in range(2)]
        for one in added:
            remove(one)

    check_walks(server, asked, member, name_of, stays, churn)
    # the last entry of a page is deleted before the next page is read
    lost = make(next(numbers))
    whole = [name_of(entry) for entry in server.ok("GET", asked + "?limit=1000").json()[member]]
    place = whole.index(lost) + 1
    first = server.ok("GET", f"{asked}?limit={place}")
    remove(lost)
    if next_of(first):
        rest = [
            name_of(entry)
            for entry in server.ok(
                "GET", next_of(first).replace(f"limit={place}", "limit=1000")
            ).json()[member]
        ]
        assert rest == whole[place:], f"{asked}: after what is gone come {rest}"
    page = server.ok("GET", f"{asked}?limit=2&offset=1")
    assert [name_of(entry) for entry in page.json()[member]] == stays[
        1:3
    ] and 'rel="prev"' in page.headers["Link"], asked


def test_edits(server):
    """The list has the newest edit first. While others paint, it grows at its start."""
    layer = M + "/layers/marks"
    server.ok("POST", M + "/layers", {"name": "Marks", "type": "u8"})
    fill = lambda n: server.ok(
        "POST",
        layer + "/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": 1 + n % 200},
    )
    for n in range(KEPT):
        fill(n)
    kept = [edit["sequence"] for edit in server.ok("GET", layer + "/edits").json()["edits"]]
    check_walks(server, layer + "/edits", "edits", lambda entry: entry["sequence"], kept, fill)
    kept = [edit["sequence"] for edit in server.ok("GET", T + "/edits?limit=9").json()["edits"]]
    depth = lambda n: server.ok("PATCH", T + "/records/1", {"values": {"depth": n}})
    with Writer(depth):
        told = [edit["sequence"] for edit in walk(server, T + "/edits", "edits", limit=50)]
    assert (
        len(set(told)) == len(told)
        and set(kept) <= set(told)
        and told == sorted(told, reverse=True)
    ), told[:50]
    server.ok("PATCH", layer, {"review": True})
    painter = server.add_person("paul", "annotator")
    for n in range(KEPT):
        server.ok(
            "POST",
            layer + "/edits",
            {"op": "fill", "mode": "where", "where": "true", "value": 201 + n},
            token=painter,
        )
    whole = [stroke["sequence"] for stroke in server.ok("GET", layer + "/review").json()["strokes"]]
    assert (
        len(whole) == KEPT
        and [stroke["sequence"] for stroke in walk(server, layer + "/review", "strokes")] == whole
    )


def test_jobs(server):
    """The list has the newest job first."""
    for _ in range(4):
        server.wait_for_job(
            server.ok(
                "POST",
                M + "/figures",
                {"format": "png", "dpi": 50},
                headers={"Prefer": "respond-async"},
            ).json()["id"]
        )
    whole = [job["id"] for job in server.ok("GET", "/jobs").json()["jobs"]]
    assert len(whole) >= 4 and [job["id"] for job in walk(server, "/jobs", "jobs")] == whole
    models = [model["id"] for model in server.ok("GET", "/models").json()["models"]]
    assert [model["id"] for model in walk(server, "/models", "models", limit=1)] == models
    assert (
        len(walk(server, "/templates", "templates", limit=1))
        == server.ok("GET", "/templates").json()["total"]
    )
    assert (
        len(walk(server, "/me/sessions", "sessions", limit=1))
        == server.ok("GET", "/me/sessions").json()["total"]
        >= 1
    )


def encoded(value):
    text = value if isinstance(value, bytes) else json.dumps(value, separators=(",", ":")).encode()
    return base64.urlsafe_b64encode(text).decode().rstrip("=")


def test_nonsense(server):
    """A value that is not a position in the list is refused."""
    cursor = next_of(server.ok("GET", T + "/records?limit=1")).partition("after=")[2]
    values = json.loads(base64.urlsafe_b64decode(cursor + "=" * (-len(cursor) % 4)))
    mark = values[0]
    many = ",".join(f"column-{i}" for i in range(17))
    refused = server.get(f"{T}/records?sortby={many}")
    assert refused.status == 422 and refused.json()["field"] == "sortby", refused
    assert next_of(
        server.ok("GET", f"{T}/records?limit=1&sortby=" + ",".join(["depth"] * 1000))
    ), "a column that is repeated"
    sorted_cursor = next_of(server.ok("GET", T + "/records?limit=1&sortby=depth")).partition(
        "after="
    )[2]
    depth_mark = json.loads(
        base64.urlsafe_b64decode(sorted_cursor + "=" * (-len(sorted_cursor) % 4))
    )[0]
    for path, after in (
        [
            (T + "/records", each)
            for each in (
                "",
                "x",
                "%",
                "====",
                cursor + "=",
                cursor[:-1],
                "A" * 7000,
                encoded({}),
                encoded([]),
                encoded([mark]),
                encoded(["00000000", "1"]),
                encoded([mark, 1]),
                encoded([mark, None, None]),
                encoded([mark, "1", "2"]),
                encoded([mark, "one"]),
                encoded([mark, "99999999999999999999999"]),
                encoded([mark, "\0"]),
                encoded([mark, ["1"]]),
                encoded(b"\xff\xfe[]"),
                encoded(b"[" * 4000),
                encoded([mark, "1"]) + "A",
                sorted_cursor,
            )
        ]
        + [
            (T + "/records?sortby=depth", each)
            for each in (cursor, encoded([depth_mark, "deep", "1"]), encoded([depth_mark, "1"]))
        ]
        + [
            (M + "/layers", cursor),
            ("/users", cursor),
            ("/projects/default/bin", cursor),
            (M + "/layers/marks/edits", cursor),
        ]
    ):
        answer = server.get(f"{path}{'&' if '?' in path else '?'}after={urllib.parse.quote(after)}")
        assert answer.status == 422 and answer.json()["field"] == "after", (path, after, answer)
    both = server.get(f"{T}/records?offset=1&after={cursor}")
    assert both.status == 422 and both.json()["field"] == "after", both
    # a position in the right format may have no matching entry; the list then starts or ends at
    # that position
    for path, own in (("/users", ["zzzzz", 99]), (M + "/layers", [-5, 0])):
        link = next_of(server.ok("GET", path + "?limit=1")).partition("after=")[2]
        own_mark = json.loads(base64.urlsafe_b64decode(link + "=" * (-len(link) % 4)))[0]
        assert server.get(f"{path}?after={encoded([own_mark, *own])}").status == 200
        for wrong in (own[:1], [*own, 1], [None, None], ["x", "y"], [1.5, 1]):
            answer = server.get(f"{path}?after={encoded([own_mark, *wrong])}")
            assert answer.status == 422 and answer.json()["field"] == "after", (path, wrong, answer)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
