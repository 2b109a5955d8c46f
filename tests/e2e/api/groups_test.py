"""Groups of users: each role that a project gives a group, the highest role, the immediate end of a
role, and refusals."""
import pytest
from support.browsers import Browser, join, uncoloured
from support.event_reader import EventReader
from support.live_client import LiveClient, Refused
from support.project_sites import Someone, make_sites, nothing_is_seen
from support.strata_server import LONG_S

FILL = {"op": "fill", "mode": "where", "where": "true", "value": 1}


def give(server, project, group, role):
    """Sets the role of the group, or removes it if `role` is empty."""
    if role:
        server.ok("PUT", f"/projects/{project}/groups/{group}", {"role": role})
    else:
        server.ok("DELETE", f"/projects/{project}/groups/{group}")


def projects_of(person):
    return {
        project["slug"]: (project["role"], project.get("groups"))
        for project in person.ok("GET", "/projects").json()["projects"]
    }


@pytest.fixture(scope="module")
def villa(server):
    return make_sites(server)["villa"]


@pytest.fixture(scope="module", autouse=True)
def gus(server, villa):
    gus = Someone(server, "Gus", "guest")
    Someone(server, "Vera", "viewer")
    return gus


def test_making(server, story):
    """Groups are created, read, renamed, filled and emptied. Invalid requests are refused without
    effect."""
    made = server.ok("POST", "/groups", {"name": "Students", "members": ["gus", "Vera", "GUS"]})
    students = made.json()
    assert (
        made.status == 201 and made.headers["Location"] == f"/api/v1/groups/{students['id']}"
    ), made
    assert students == {
        "id": students["id"],
        "name": "Students",
        "members": [{"user": "Gus", "full_name": ""}, {"user": "Vera", "full_name": ""}],
        "projects": [],
        "losing": 0,
    }, students
    path = f"/groups/{students['id']}"
    assert server.ok("GET", "/groups").json() == {
        "groups": [{"id": students["id"], "name": "Students", "people": 2, "projects": 0}],
        "total": 1,
    }
    assert server.ok("PATCH", path, {"name": "Pupils", "remove": ["Vera"]}).json()["members"] == [
        {"user": "Gus", "full_name": ""}
    ]
    assert (
        server.ok("GET", "/users/gus").json()["groups"] == ["Pupils"]
        and server.ok("GET", "/users/Vera").json()["groups"] == []
    )
    other = server.ok("POST", "/groups", {"name": "Excavation 2026"}).json()
    assert [group["name"] for group in server.ok("GET", "/groups").json()["groups"]] == [
        "Excavation 2026",
        "Pupils",
    ]
    assert [
        group["name"] for group in server.ok("GET", "/groups?limit=1&offset=1").json()["groups"]
    ] == ["Pupils"]
    wrong = (
        ({"name": "pUPILS"}, 409, "name"),
        ({"name": ""}, 422, "name"),
        ({"name": " x"}, 422, "name"),
        ({"name": "x" * 101}, 422, "name"),
        ({"name": 7}, 422, "name"),
        ({"name": None}, 422, "name"),
    )
    for body, status, field in wrong + (
        ({}, 422, "name"),
        ({"name": "New", "members": ["nobody"]}, 422, "members"),
        ({"name": "New", "members": "Gus"}, 422, "members"),
        ({"name": "New", "members": ["Gus"] * 101}, 422, "members"),
        ({"name": "New", "role": "curator"}, 422, "role"),
        ([], 422, None),
    ):
        refused = server.post("/groups", body)
        assert refused.status == status and (
            field is None or refused.json()["field"].startswith(field)
        ), (body, refused)
    for body, status, field in wrong[:1] + (
        ({}, 422, None),
        ({"add": []}, 422, "add"),
        ({"add": ["Vera", "nobody"]}, 422, "add"),
        ({"remove": ["nobody"]}, 422, "remove"),
        ({"add": [""]}, 422, "add"),
        ({"members": ["Vera"]}, 422, "members"),
        ({"name": "Changed", "add": ["\u212airk"]}, 422, "add"),
    ):
        refused = server.request("PATCH", f"/groups/{other['id']}", body)
        assert refused.status == status and (
            field is None or refused.json()["field"].startswith(field)
        ), (body, refused)
    assert (
        server.ok("GET", f"/groups/{other['id']}").json() == other
    ), "something of what was refused was done"
    for raw in (b"", b"{", b'{"name": "\xff"}'):
        assert (
            server.post("/groups", raw, headers={"Content-Type": "application/json"}).status == 400
        ), raw
    for ref in ("987654321", "0", "-1", "pupils", "1e3", "99999999999999999999", "%00"):
        for method, body in (("GET", None), ("PATCH", {"name": "x"}), ("DELETE", None)):
            assert server.request(method, f"/groups/{ref}", body).status in (400, 404), (
                method,
                ref,
            )
        for method, body in (("PUT", {"role": "viewer"}), ("DELETE", None)):
            assert server.request(method, f"/projects/villa/groups/{ref}", body).status in (
                400,
                404,
            ), (method, ref)
    for body in (
        {"role": "administrator"},
        {"role": "guest"},
        {},
        {"role": "viewer", "x": 1},
        {"role": None},
    ):
        assert (
            server.request("PUT", f"/projects/villa/groups/{other['id']}", body).status == 422
        ), body
    assert (
        server.request("PUT", f"/projects/ghost/groups/{other['id']}", {"role": "viewer"}).status
        == 404
    )
    assert (
        server.request("DELETE", f"/projects/villa/groups/{other['id']}").status == 404
    ), "it has no role there"
    assert server.get("/groups?q=x").status == 400
    server.ok("DELETE", f"/groups/{other['id']}")
    assert server.request("DELETE", f"/groups/{other['id']}").status == 404
    server.ok("PATCH", path, {"name": "Students"})
    story.group = students["id"]


def test_foreign(server, story):
    """Only administrators can read and change groups. Scripts cannot change them."""
    group = story.group
    calls = [
        ("GET", "/groups", None),
        ("POST", "/groups", {"name": "Mine"}),
        ("GET", f"/groups/{group}", None),
        ("PATCH", f"/groups/{group}", {"add": ["carl"]}),
        ("DELETE", f"/groups/{group}", None),
        ("PUT", f"/projects/villa/groups/{group}", {"role": "curator"}),
        ("DELETE", f"/projects/villa/groups/{group}", None),
    ]
    carl = Someone(server, "carl", "curator")
    for method, path, body in calls:
        assert carl.status(method, path, body) == 403, (method, path)
        assert Browser(server).request(method, path, body).status == 401, (method, path)
        assert carl.request(method, path, body, Origin="https://evil.example").status == 403, (
            method,
            path,
        )
    root = server.ok("POST", "/me/tokens", {"name": "t", "days": 1}).json()["secret"]
    for method, path, body in calls:
        assert server.request(method, path, body, token=root).status == (
            200 if method == "GET" else 403
        ), (method, path)
    anne = Someone(server, "anne", "administrator")
    made = anne.ok("POST", "/groups", {"name": "By Anne", "members": ["anne", "owner"]}).json()[
        "id"
    ]
    for role in ("curator", None):
        give(server, "villa", made, role)
    assert (
        anne.ok("GET", "/me").json()["role"] == "administrator"
    ), "a group takes nothing from anybody"
    anne.ok("DELETE", f"/groups/{made}")


def test_ladder(server, gus, villa, story):
    """Through a group, a guest has the rights of the role in the villa, from no role to curator and
    back. The guest has no rights in the forum."""
    group = story.group
    model = "/models/" + villa["model"]["slug"]
    tries = (
        ("GET", model, None),
        ("POST", model + "/layers/marks/edits", FILL),
        ("PATCH", model, {"credit": "x"}),
        ("GET", "/projects/villa/members", None),
        ("PUT", f"/projects/villa/groups/{group}", {"role": "curator"}),
        ("PATCH", f"/groups/{group}", {"name": "Mine"}),
    )
    for role, good in (
        (None, 0),
        ("viewer", 1),
        ("annotator", 2),
        ("curator", 4),
        ("viewer", 1),
        (None, 0),
    ):
        if role or good != 0 or projects_of(gus):
            give(server, "villa", group, role)
        for i, (method, path, body) in enumerate(tries):
            status = gus.status(method, path, body)
            assert status == (
                200 if i < good else 403 if role or path.startswith("/groups") else 404
            ), (role, method, path, status)
        assert projects_of(gus) == ({"villa": (role, ["Students"])} if role else {}), (
            role,
            projects_of(gus),
        )
        assert ("Gus" in str(server.ok("GET", "/projects/villa/people").json())) == (
            role is not None
        )
    give(server, "villa", group, "curator")
    token = gus.ok("POST", "/me/tokens", {"name": "t", "days": 1, "role": "viewer"}).json()[
        "secret"
    ]
    assert (
        server.get(model, token=token).status == 200
        and server.request("PATCH", model, {"credit": "x"}, token=token).status == 403
    ), "a token does no more than its own role"
    give(server, "villa", group, None)
    assert server.get(model, token=token).status == 404


def test_nothing_is_seen_without_a_role(server, gus, villa):
    nothing_is_seen(server, gus, villa)


def test_the_highest_role_counts(server, gus, story):
    """The highest role applies: the user's own role, or a role from a group. The response contains
    the origin of the role."""
    group = story.group
    diggers = server.ok("POST", "/groups", {"name": "Diggers", "members": ["Gus"]}).json()["id"]
    give(server, "villa", group, "annotator")
    give(server, "villa", diggers, "annotator")
    give(server, "forum", diggers, "viewer")
    assert projects_of(gus) == {
        "villa": ("annotator", ["Diggers", "Students"]),
        "forum": ("viewer", ["Diggers"]),
    }
    gus.now("villa", "viewer")
    assert projects_of(gus)["villa"] == (
        "annotator",
        ["Diggers", "Students"],
    ), "a lower role of one's own takes nothing"
    gus.now("villa", "curator")
    assert projects_of(gus)["villa"] == ("curator", None), "their own"
    listed = server.ok("GET", "/projects/villa/members").json()
    listed["members"] = [uncoloured(person) for person in listed["members"]]
    assert listed == {
        "members": [{"user": "Gus", "full_name": "", "role": "curator"}],
        "groups": [
            {"id": diggers, "name": "Diggers", "people": 1, "role": "annotator"},
            {"id": group, "name": "Students", "people": 1, "role": "annotator"},
        ],
        "total": 1,
    }, listed
    give(server, "villa", diggers, "curator")
    gus.now("villa", None)
    assert projects_of(gus)["villa"] == ("curator", ["Diggers"])
    assert (
        server.ok("GET", f"/groups/{diggers}").json()["losing"] == 1
        and server.ok("GET", f"/groups/{group}").json()["losing"] == 0
    )
    # for a user with a role for all projects, a group is listed only if it gives a higher role
    vera = Someone(server, "Vesta", "viewer")
    server.ok("PATCH", f"/groups/{diggers}", {"add": ["Vesta"]})
    assert projects_of(vera) == {
        "default": ("viewer", None),
        "forum": ("viewer", None),
        "villa": ("curator", ["Diggers"]),
    }
    # each way to end the role takes effect immediately
    server.ok("PATCH", f"/groups/{diggers}", {"remove": ["gus"]})
    assert projects_of(gus) == {"villa": ("annotator", ["Students"])}
    server.ok("DELETE", f"/groups/{diggers}")
    assert projects_of(vera)["villa"] == ("viewer", None)
    server.ok("DELETE", "/users/Vesta")
    give(server, "villa", group, None)


def test_ends_at_once(server, gus, villa, story):
    """Open connections and event streams end with the group's role, for each way to end it. Users
    who still have a role can reconnect with it."""
    group = story.group
    model = villa["model"]["slug"]

    def look():
        return LiveClient(server, model, token="", cookie=gus.cookie, origin=server.url)

    give(server, "villa", group, "annotator")
    token = gus.ok("POST", "/me/tokens", {"name": "events", "days": 1}).json()["secret"]
    with look() as connection:
        assert connection.hello(dpr=1, accept=["jpeg"])["role"] == "annotator"
        give(server, "villa", group, "viewer")
        connection.until_closed()
    for end, again in (
        (
            lambda: server.ok("PATCH", f"/groups/{group}", {"remove": ["Gus"]}),
            lambda: server.ok("PATCH", f"/groups/{group}", {"add": ["Gus"]}),
        ),
        (
            lambda: give(server, "villa", group, None),
            lambda: give(server, "villa", group, "viewer"),
        ),
        (lambda: server.ok("DELETE", f"/groups/{group}"), None),
    ):
        reader = EventReader(server, "/models/" + model, token).listening()
        with look() as connection:
            assert connection.hello(dpr=1, accept=["jpeg"])["role"] == "viewer"
            end()
            connection.until_closed()
        assert gus.status("GET", "/models/" + model) == 404
        try:
            look()
            raise AssertionError("nothing lets them in any more")
        except Refused as refused:
            assert refused.status == 404, refused
        assert reader.ended.wait(LONG_S), "events go on"
        if again:
            again()
    assert projects_of(gus) == {}


def test_coming_and_going(server):
    """Invitations can contain groups. Deleted users leave their groups. The activity of each
    project lists such changes."""
    group = server.ok("POST", "/groups", {"name": "Season"}).json()["id"]
    give(server, "forum", group, "annotator")
    for groups, status in (
        ([group, 987654321], 422),
        ([], 422),
        (["Season"], 422),
        ([0], 422),
        (group, 422),
    ):
        refused = server.post("/users", {"user": "ida", "role": "guest", "groups": groups})
        assert refused.status == status and refused.json()["field"].startswith("groups"), (
            groups,
            refused,
        )
    invitation = server.ok(
        "POST", "/users", {"user": "ida", "role": "guest", "groups": [group]}
    ).json()
    assert invitation["user"]["groups"] == ["Season"], invitation
    ida = join(server, invitation)
    assert projects_of(ida) == {"forum": ("annotator", ["Season"])}
    told = [
        line
        for line in server.ok("GET", "/projects/forum/activity").json()["activity"]
        if line["kind"] == "member" and line.get("group") == "Season"
    ]
    assert [(line["op"], line.get("person"), line["role"], line["user"]) for line in told] == [
        ("added", "ida", "annotator", "owner"),
        ("added", None, "annotator", "owner"),
    ], told
    server.ok("DELETE", "/users/ida")
    assert server.ok("GET", f"/groups/{group}").json()["members"] == []
    server.ok("DELETE", f"/groups/{group}")
    last = server.ok("GET", "/projects/forum/activity").json()["activity"][0]
    assert (last["kind"], last["op"], last["group"]) == (
        "member",
        "removed",
        "Season",
    ) and "person" not in last, last


def test_the_log_is_clean(server):
    server.assert_clean_log()
