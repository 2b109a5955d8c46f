"""Comments on a model over HTTP: the rights to write, change and delete, positions, repeats and
races, and the comments of a deleted user."""
import json
import urllib.parse

import pytest
from support.browsers import uncoloured
from support.live_client import LiveClient
from support.meshes import folded_grid

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
ALL = M + "/comments"


def near(a, b, by=1e-6):
    assert len(a) == len(b) and all(abs(x - y) <= by for x, y in zip(a, b)), (a, b)


class Site:
    def __init__(self, server):
        self.server = server
        server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
        server.ok(
            "POST",
            M + "/layers",
            {"name": "Cracks", "kind": "numeric", "type": "u8", "resolution": 2048},
        )
        server.ok(
            "POST",
            M + "/layers",
            {"name": "Units", "kind": "database", "type": "u16", "resolution": 2048},
        )
        server.ok("POST", "/tables/units/records", {"values": {"name": "SU 1"}})
        self.tokens = {
            name: server.add_person(name, role)
            for name, role in (
                ("vera", "viewer"),
                ("Ada.L", "annotator"),
                ("bob", "annotator"),
                ("carl", "curator"),
            )
        }

    def request(self, who, method, path, body=None, **more):
        return self.server.request(method, path, body, token=self.tokens[who], **more)

    def ok(self, who, method, path, body=None, **more):
        return self.server.ok(method, path, body, token=self.tokens[who], **more)

    def begin(self, who, text="Look", position=(50, 50, 0), **more):
        return self.ok(who, "POST", ALL, {"text": text, "position": list(position), **more}).json()

    def reply(self, who, thread, text="Yes"):
        return self.ok(who, "POST", f"/comments/{thread['id']}/replies", {"text": text}).json()


def told(of, *, status, field=None):
    assert of.status == status, of
    problem = of.json()
    assert problem["status"] == status and problem["detail"], problem
    if field is not None:
        assert problem.get("field") == field, problem
    return problem


@pytest.fixture(scope="module")
def site(server):
    return Site(server)


def test_writing(site):
    """A thread has a position on the surface and a subject. Every user can read it."""
    made = site.ok(
        "Ada.L", "POST", ALL, {"text": "Is this\nthe crack? δ <b>&amp;", "position": [50, 40, 3]}
    )
    first = made.json()
    assert (
        made.headers["Location"] == f"/api/v1/comments/{first['id']}"
        and made.headers["ETag"] == '"v1"'
    )
    near(first["position"][:2], [50, 40], 1e-2)
    assert abs(first["position"][2]) < 0.1, "it lies on the surface"
    assert abs(abs(first["normal"][2]) - 1) < 1e-2
    assert (
        first["user"] == "Ada.L"
        and first["state"] == "open"
        and first["deleted"] is False
        and first["version"] == 1
    )
    assert first["text"] == "Is this\nthe crack? δ <b>&amp;" and not {
        "thread",
        "layer",
        "record",
        "resolved",
        "edited",
    } & set(first), first
    for who in site.tokens:
        assert site.ok(who, "GET", f"/comments/{first['id']}").json() == first
        assert site.ok(who, "GET", ALL).json() == {"comments": [first], "total": 1}
    about = site.begin("bob", "About SU 1", layer="units", record=1)
    units = site.server.ok("GET", M + "/layers/units").json()
    assert (about["layer"], about["table"], about["record"]) == (
        units["id"],
        units["table"],
        1,
    ), about
    assert "record" not in site.begin("bob", "About cracks", layer="cracks")
    reply = site.reply("bob", first, "Yes")
    assert (
        reply["thread"] == first["id"]
        and reply["model"] == first["model"]
        and not {"position", "state"} & set(reply)
    ), reply
    replies = site.ok("vera", "GET", f"/comments/{first['id']}/replies").json()
    assert replies == {"replies": [reply], "total": 1}, replies
    told(
        site.request("bob", "POST", f"/comments/{reply['id']}/replies", {"text": "No"}), status=422
    )
    told(site.request("bob", "GET", f"/comments/{reply['id']}/replies"), status=422)
    tag = site.request("bob", "GET", f"/comments/{first['id']}").headers["ETag"]
    assert tag.startswith('"v1.'), tag
    read = site.request("bob", "GET", f"/comments/{first['id']}", headers={"If-None-Match": tag})
    assert read.status == 304, read


def test_malformed(site):
    """A comment with invalid content or an invalid position is refused with its field, and nothing
    is written."""
    before = site.ok("bob", "GET", ALL).json()["total"]
    here = [50, 50, 0]
    for body, field in (
        ({"position": here}, "text"),
        ({"text": "", "position": here}, "text"),
        ({"text": " \n ", "position": here}, "text"),
        ({"text": "x" * 10001, "position": here}, "text"),
        ({"text": 7, "position": here}, "text"),
        ({"text": "x"}, "position"),
        ({"text": "x", "position": [1, 2]}, "position"),
        ({"text": "x", "position": [1, 2, "3"]}, "position[2]"),
        ({"text": "x", "position": [1, 2, 1e16]}, "position[2]"),
        ({"text": "x", "position": [50, 50, 8]}, "position"),
        ({"text": "x", "position": [1e9, 0, 0]}, "position"),
        ({"text": "x", "position": here, "layer": "nothing"}, "layer"),
        ({"text": "x", "position": here, "record": 1}, "layer"),
        ({"text": "x", "position": here, "layer": "cracks", "record": 1}, "record"),
        ({"text": "x", "position": here, "layer": "units", "record": 99}, "record"),
        ({"text": "x", "position": here, "user": "carl"}, "user"),
    ):
        refused = site.request("bob", "POST", ALL, body)
        assert refused.status in (404, 422) and refused.json().get("field") == field, (
            body,
            refused,
        )
    assert (
        site.begin("bob", "x", position=[50, 50, 6])["position"][2] < 0.1
    ), "7 mm are 5 % of the diagonal"
    for raw, status in (
        (b'{"text": "x", "position": [NaN, 0, 0]}', 400),
        (b'{"text": "\xff", "position": [0, 0, 0]}', 400),
        (b"{", 400),
        (b'{"text": "a\\u0000b", "position": [50, 50, 0]}', 422),
        (b'{"text": "\\ud800", "position": [50, 50, 0]}', 400),
    ):
        refused = site.request(
            "bob", "POST", ALL, raw, headers={"Content-Type": "application/json"}
        )
        assert refused.status == status, (raw, refused)
    for path, field in (
        ("?state=closed", "state"),
        ("?since=yesterday", "since"),
        ("?limit=0", "limit"),
        ("?offset=-1", "offset"),
    ):
        told(site.request("bob", "GET", ALL + path), status=422, field=field)
    told(site.request("bob", "GET", ALL + "?author=bob"), status=400)
    for path in (
        "/comments/999999",
        "/comments/x",
        "/comments/0",
        "/comments/99999999999999999999",
        "/models/nothing/comments",
    ):
        told(site.request("bob", "GET", path), status=404)
    told(
        site.request("bob", "POST", "/models/nothing/comments", {"text": "x", "position": here}),
        status=404,
    )
    thread = site.begin("bob")
    for body, field in (
        ({}, ""),
        ({"state": "closed"}, "state"),
        ({"text": ""}, "text"),
        ({"text": " "}, "text"),
        ({"position": here}, "position"),
    ):
        refused = site.request("bob", "PATCH", f"/comments/{thread['id']}", body)
        assert refused.status == 422 and refused.json().get("field", "") == field, (body, refused)
    reply = site.reply("bob", thread)
    told(
        site.request("bob", "PATCH", f"/comments/{reply['id']}", {"state": "resolved"}),
        status=422,
        field="state",
    )
    # The limit is ten thousand characters, however many bytes they have.
    assert site.begin("bob", "😀" * 10000)["text"] == "😀" * 10000
    assert site.ok("bob", "GET", ALL).json()["total"] == before + 4


def test_roles(site):
    """Viewers read comments. Annotators write comments and change their own. Curators delete the
    comments of others. Every user who may write can resolve a thread."""
    thread = site.begin("Ada.L")
    path = f"/comments/{thread['id']}"
    for method, where, body in (
        ("POST", ALL, {"text": "x", "position": [50, 50, 0]}),
        ("POST", path + "/replies", {"text": "x"}),
        ("PATCH", path, {"state": "resolved"}),
        ("DELETE", path, None),
    ):
        told(site.request("vera", method, where, body), status=403)
        assert site.server.request(method, where, body, token=False).status == 401
    assert site.server.request("GET", ALL, token=False).status == 401
    for who in ("bob", "carl"):
        told(site.request(who, "PATCH", path, {"text": "Mine"}), status=403, field="text")
    told(site.request("bob", "DELETE", path), status=403)
    changed = site.ok("Ada.L", "PATCH", path, {"text": "Look here"}).json()
    assert (
        changed["text"] == "Look here"
        and changed["edited"] >= changed["time"]
        and changed["version"] == 2
    ), changed
    resolved = site.ok("bob", "PATCH", path, {"state": "resolved"}).json()
    assert (
        resolved["state"] == "resolved"
        and resolved["resolved"]["user"] == "bob"
        and resolved["edited"] == changed["edited"]
    ), resolved
    again = site.ok("Ada.L", "PATCH", path, {"state": "resolved"}).json()
    assert again["resolved"] == resolved["resolved"], "who settled it first did"
    assert "resolved" not in site.ok("Ada.L", "PATCH", path, {"state": "open"}).json()
    theirs = site.reply("bob", thread)
    told(site.request("Ada.L", "DELETE", f"/comments/{theirs['id']}"), status=403)
    assert site.ok("carl", "DELETE", f"/comments/{theirs['id']}").status == 204
    assert site.ok("carl", "DELETE", path).status == 204
    told(site.request("carl", "DELETE", path), status=404)


def test_deleting(site):
    """A deleted first comment with replies remains as an empty comment. It is removed with the last
    reply."""
    thread = site.begin("bob", "A slip of the pen")
    path = f"/comments/{thread['id']}"
    replies = [site.reply(who, thread) for who in ("Ada.L", "bob")]
    site.ok("bob", "DELETE", path)
    left = site.ok("vera", "GET", path).json()
    assert (
        left["deleted"] is True
        and left["text"] == ""
        and left["position"] == thread["position"]
        and "edited" not in left
    ), left
    told(site.request("bob", "DELETE", path), status=409)
    told(site.request("bob", "PATCH", path, {"text": "Not so"}), status=409, field="text")
    assert site.ok("Ada.L", "PATCH", path, {"state": "resolved"}).json()["deleted"] is True
    replies.append(site.reply("Ada.L", thread, "Still talking"))
    for reply in replies:
        assert site.ok("vera", "GET", path).json()["deleted"] is True
        site.ok("carl", "DELETE", f"/comments/{reply['id']}")
    told(site.request("vera", "GET", path), status=404)


def test_repeats_and_races(site):
    """A repeated request writes nothing twice. A change that is based on an old version is
    refused."""
    key = {"Idempotency-Key": "9b2d0e7a-7c1a-4c3e-9a57-0e7d3c1d2f10"}
    before = site.ok("bob", "GET", ALL).json()["total"]
    body = {"text": "Once", "position": [10, 10, 0]}
    first = site.ok("bob", "POST", ALL, body, headers=key)
    again = site.ok("bob", "POST", ALL, body, headers=key)
    assert (
        again.json() == first.json()
        and again.status == 201
        and again.headers["ETag"] == first.headers["ETag"]
    )
    told(site.request("bob", "POST", ALL, {**body, "text": "Twice"}, headers=key), status=422)
    assert site.ok("bob", "GET", ALL).json()["total"] == before + 1
    path = f"/comments/{first.json()['id']}"
    reply_key = {"Idempotency-Key": "a reply"}
    replies = [
        site.ok("bob", "POST", path + "/replies", {"text": "Yes"}, headers=reply_key).json()
        for _ in range(2)
    ]
    assert (
        replies[0] == replies[1] and site.ok("bob", "GET", path + "/replies").json()["total"] == 1
    )
    assert (
        site.ok("bob", "PATCH", path, {"text": "Two"}, headers={"If-Match": '"v1"'}).headers["ETag"]
        == '"v2"'
    )
    for method, body in (
        ("PATCH", {"text": "Three"}),
        ("PATCH", {"state": "resolved"}),
        ("DELETE", None),
    ):
        told(site.request("bob", method, path, body, headers={"If-Match": '"v1"'}), status=412)
    assert site.ok("bob", "GET", path).json()["text"] == "Two"
    site.ok("bob", "DELETE", path, headers={"If-Match": '"v2"'})


def test_lists(site):
    """Lists of comments by state and time, in pages."""
    for comment in site.ok("carl", "GET", ALL + "?limit=1000").json()["comments"]:
        site.request("carl", "DELETE", f"/comments/{comment['id']}")
    threads = [site.begin("bob", f"Number {n}", position=(10 * n + 5, 50, 0)) for n in range(5)]
    reply = site.reply("Ada.L", threads[1])
    settled = site.ok(
        "Ada.L", "PATCH", f"/comments/{threads[1]['id']}", {"state": "resolved"}
    ).json()
    ids = lambda query: [
        comment["id"] for comment in site.ok("vera", "GET", ALL + query).json()["comments"]
    ]
    assert ids("?state=resolved") == [threads[1]["id"], reply["id"]]
    assert ids("?state=open") == [
        thread["id"] for thread in threads if thread["id"] != threads[1]["id"]
    ]
    assert ids("?since=" + urllib.parse.quote(settled["resolved"]["time"])) == [threads[1]["id"]]
    assert ids("?since=2001-01-01") == ids("") and ids("?since=2999-01-01T00:00:00%2B01:00") == []
    page = site.ok("vera", "GET", ALL + "?limit=4")
    assert (
        page.json()["total"] == 6
        and len(page.json()["comments"]) == 4
        and 'rel="next"' in page.headers["Link"]
    )
    assert ids("?limit=4") + ids("?limit=4&offset=4") == ids("")


def test_live(site):
    """Participants at the model receive every change. Other participants receive none."""
    site.server.import_model(folded_grid(fold=0.001), "other.ply", name="Other", unit="mm")
    with LiveClient(site.server, "sheet", token=site.tokens["vera"]) as here, LiveClient(
        site.server, "other", token=site.tokens["vera"]
    ) as elsewhere:
        here.hello(dpr=1, accept=["jpeg"])
        elsewhere.hello(dpr=1, accept=["jpeg"])
        thread = site.begin("bob", "Live")
        assert here.receive_until("comment") == {
            "op": "comment",
            "event": "created",
            "comment_id": thread["id"],
            "comment": thread,
            "user": "bob",
        }
        reply = site.reply("Ada.L", thread)
        assert here.receive_until("comment")["comment"] == reply
        site.ok("Ada.L", "PATCH", f"/comments/{thread['id']}", {"state": "resolved"})
        event = here.receive_until("comment")
        assert (event["event"], event["user"], event["comment"]["state"]) == (
            "changed",
            "Ada.L",
            "resolved",
        ), event
        site.ok("bob", "DELETE", f"/comments/{thread['id']}")
        event = here.receive_until("comment")
        assert (
            event["event"] == "changed"
            and event["comment"]["deleted"] is True
            and event["comment"]["text"] == ""
        ), event
        site.ok("carl", "DELETE", f"/comments/{reply['id']}")
        gone = [here.receive_until("comment") for _ in range(2)]
        assert [(event["event"], event["comment_id"]) for event in gone] == [
            ("deleted", reply["id"]),
            ("deleted", thread["id"]),
        ], gone
        assert all("comment" not in event for event in gone)
        there = site.ok(
            "bob", "POST", "/models/other/comments", {"text": "There", "position": [50, 50, 0]}
        ).json()
        assert (
            elsewhere.receive_until("comment")["comment_id"] == there["id"]
        ), "the first that is heard there"


def test_names(site):
    """A comment can mention the users who may sign in and see the project."""
    people = "/projects/default/people"
    told(site.request("vera", "GET", people), status=403)
    assert site.server.request("GET", people, token=False).status == 401
    told(site.request("bob", "GET", "/projects/nowhere/people"), status=404)

    def listed(query=""):
        return [person["user"] for person in site.ok("bob", "GET", people + query).json()["people"]]

    everybody = ["Ada.L", "bob", "carl", "owner", "vera"]
    assert listed() == everybody, listed()
    site.server.ok("POST", "/users", {"user": "gus", "full_name": "Gustav G.", "role": "guest"})
    site.server.ok("POST", "/users", {"user": "dora", "role": "viewer"})
    site.server.ok("PATCH", "/users/dora", {"disabled": True})
    assert listed() == everybody, "guests of other projects and who may not sign in are none"
    site.server.ok("PUT", "/projects/default/members/gus", {"role": "viewer"})
    assert listed() == ["Ada.L", "bob", "carl", "gus", "owner", "vera"]
    page = site.ok("bob", "GET", people + "?limit=2&offset=3")
    assert [uncoloured(person) for person in page.json()["people"]] == [
        {"user": "gus", "full_name": "Gustav G."},
        {"user": "owner", "full_name": ""},
    ], page
    assert page.json()["total"] == 6, page
    assert 'rel="next"' in page.headers["Link"]
    for user in ("gus", "dora"):
        site.server.ok("DELETE", f"/users/{user}")


def test_people_and_models(site):
    """The name of a deleted user is removed, also from the texts of others. Comments are deleted
    with their model."""
    person = next(
        user for user in site.server.ok("GET", "/users").json()["users"] if user["user"] == "Ada.L"
    )
    former = f"former-{person['id']}"
    hers = site.begin("Ada.L", "Mine")
    others = site.begin("bob", "@ada.l: see @bob, and mail to ada.l@example.org")
    site.ok("Ada.L", "PATCH", f"/comments/{others['id']}", {"state": "resolved"})
    site.server.ok("DELETE", "/users/Ada.L")
    assert site.ok("bob", "GET", f"/comments/{hers['id']}").json()["user"] == former
    others = site.ok("bob", "GET", f"/comments/{others['id']}").json()
    assert (
        others["resolved"]["user"] == former
        and others["text"] == f"@{former}: see @bob, and mail to ada.l@example.org"
    ), others
    assert "Ada.L" not in json.dumps(site.ok("bob", "GET", ALL + "?limit=1000").json())
    told(site.request("bob", "DELETE", f"/comments/{hers['id']}"), status=403)
    site.ok("carl", "DELETE", f"/comments/{hers['id']}")
    layer = site.server.ok("GET", M + "/layers/units").json()
    about = site.begin("bob", "About SU 1", layer=layer["id"], record=1)
    site.server.ok("DELETE", M + "/layers/units")
    left = site.ok("bob", "GET", f"/comments/{about['id']}").json()
    assert "layer" not in left and left["record"] == 1, left
    site.server.ok("DELETE", M)
    told(site.request("bob", "GET", f"/comments/{about['id']}"), status=404)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
