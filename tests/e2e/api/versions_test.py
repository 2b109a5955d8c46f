"""A project can require that changes contain the version that they are based on (If-Match, 428)."""
import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import png

M, T, P = "/models/sheet", "/tables/finds", "/projects/default"
OF_PATH = {
    "project": "default",
    "model": "sheet",
    "layer": "finds",
    "table": "finds",
    "column": "name",
    "key": "1",
    "view": "west",
    "tour": "round",
    "snapshot": "first",
    "selection": "sunny",
    "look": "plain",
}


def make_site(server):
    model = server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    camera = camera_from(model, (0, 0, 1), up=(0, 1, 0))
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Finds", "kind": "database", "type": "u16", "columns": [{"name": "Name"}]},
    )
    server.ok("POST", T + "/records", {"values": {"name": "One"}})
    server.ok(
        "POST",
        M + "/looks?name=Plain",
        png(8, 8, lambda x, y: (9, 9, 9)),
        headers={"Content-Type": "image/png"},
    )
    server.ok("POST", M + "/views", {"name": "West", "camera": camera})
    server.ok(
        "POST",
        M + "/tours",
        {
            "name": "Round",
            "languages": ["en"],
            "stops": [{"view": "west", "title": {"en": "West"}}],
        },
    )
    server.ok("POST", M + "/snapshots", {"name": "First"})
    server.ok(
        "POST",
        M + "/selections",
        {"name": "Sunny", "audience": "everyone", "within": {"where": "true"}},
    )
    OF_PATH["bill"] = str(server.ok("POST", P + "/bills", {"name": "Sheet"}).json()["id"])
    OF_PATH["object"] = str(server.ok("POST", P + "/objects", {"name": "Sheet"}).json()["id"])
    OF_PATH["comment"] = str(
        server.ok("POST", M + "/comments", {"text": "Look.", "position": [30, 30, 0]}).json()["id"]
    )


def versioned_changes(server):
    """Returns the changes for which the contract lists 428, below /api/v1, with a body from the
    contract if it has one."""
    found = []
    for path, item in server.contract.document["paths"].items():
        for method in ("patch", "put", "delete"):
            operation = item.get(method)
            if not operation or "428" not in operation["responses"]:
                continue
            asked = path.removeprefix("/api/v1")
            for name, value in OF_PATH.items():
                asked = asked.replace("{" + name + "}", value)
            assert "{" not in asked, asked
            found.append((method.upper(), asked))
    assert len(found) == 31, found
    return found


# Returns the address that provides the version. Some objects have no address of their own.
def address_of_version(asked):
    return asked.rpartition("/columns/")[0] or asked


BODIES = {
    P: {"description": "x"},
    P + "/metadata": {"titles": [{"title": "Survey"}]},
    M: {"name": "Sheet"},
    M + "/looks/plain": {"opacity": 0.5},
    M + "/layers/finds": {"opacity": 0.5},
    T: {"description": "x"},
    T + "/columns/name": {"name": "Name"},
    T + "/records/1": {"values": {"name": "Two"}},
    M + "/layers/finds/records/1": {"values": {"name": "Three"}},
    M + "/views/west": {"name": "West"},
    M + "/tours/round": {"name": "Round"},
    M + "/snapshots/first": {"name": "First"},
    M + "/selections/sunny": {"name": "Sunny"},
}


WITH_BODY = ("PATCH", "PUT")


def body_of(asked):
    has_name = "/objects/" in asked or "/bills/" in asked
    other = {"name": "Sheet"} if has_name else {"text": "Look!"}
    return BODIES.get(asked, other)


@pytest.fixture(scope="module")
def changes(server):
    make_site(server)
    return versioned_changes(server)


def test_versions_are_not_demanded_at_first(server, changes):
    assert server.get(P).json()["require_if_match"] is False
    for method, asked in changes:
        if method in WITH_BODY:
            server.ok(method, asked, body_of(asked))


def test_a_project_may_demand_them(server):
    server.ok("PATCH", P, {"require_if_match": True})
    listed = [
        each for each in server.get("/projects").json()["projects"] if each["slug"] == "default"
    ]
    assert listed[0]["require_if_match"] is True, listed


def test_demanded(server, changes):
    for method, asked in changes:
        body = body_of(asked) if method in WITH_BODY else None
        answer = server.request(method, asked, body)
        problem = answer.json()
        assert (
            answer.status == 428 and problem["field"] == "If-Match" and "ETag" in problem["detail"]
        ), (method, asked, answer)
        assert answer.headers["Content-Type"] == "application/problem+json"
        empty = server.request(method, asked, body, headers={"If-Match": ""})
        assert empty.status == 428, (method, asked, empty)
        stale = server.request(method, asked, body, headers={"If-Match": '"v999"'})
        assert stale.status == 412, (method, asked, stale)
        if method in WITH_BODY:
            etag = server.get(address_of_version(asked)).headers["ETag"]
            server.ok(method, asked, body, headers={"If-Match": etag})
            server.ok(method, asked, body, headers={"If-Match": "*"})


def test_elsewhere(server):
    """The rule applies only to objects with versions, and only in that project."""
    server.ok("POST", T + "/records", {"values": {"name": "More"}})
    server.ok(
        "POST",
        M + "/layers/finds/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": 1},
    )
    server.ok("PUT", "/me/models/sheet/view", {"layers": []})
    server.ok("POST", "/projects", {"name": "Villa"})
    server.ok("PATCH", "/projects/villa", {"description": "Frescoes"})
    for asked in (
        "/models/none",
        "/comments/999999",
        "/tables/none/records/1",
        "/projects/none",
        "/comments/x",
    ):
        assert server.request("DELETE", asked).status == 404, asked
    assert (
        server.request("DELETE", M + "/layers/none").status == 428
    ), "what the address leads into demands it, before anything is looked up there"


def test_roles(server):
    """Curators of the project can change this setting but not the name. Other users can change
    neither."""
    server.ok("PATCH", P, {"require_if_match": False}, headers={"If-Match": "*"})
    ann, cleo = server.add_person("ann", "annotator"), server.add_person("cleo", "curator")
    assert server.request("PATCH", P, {"require_if_match": True}, token=ann).status == 403
    changed = server.ok("PATCH", P, {"require_if_match": True}, token=cleo)
    assert changed.json()["require_if_match"] is True and changed.headers["ETag"], changed
    for body, field in (
        ({"name": "Mine"}, "name"),
        ({"description": "Mine", "require_if_match": False}, "description"),
    ):
        answer = server.request("PATCH", P, body, token=cleo, headers={"If-Match": "*"})
        assert answer.status == 403 and answer.json()["field"] == field, answer
    assert server.get(P).json()["require_if_match"] is True
    for wrong in ({"require_if_match": "yes"}, {"require_if_match": None}, {"require_if_match": 1}):
        answer = server.request("PATCH", P, wrong, headers={"If-Match": "*"})
        assert answer.status == 422 and answer.json()["field"] == "require_if_match", answer
    # a user without the right to change an object gets 403, even if the version is missing
    assert server.request("PATCH", M, {"name": "x"}, token=ann).status == 403


def test_it_is_kept_over_a_restart(server):
    assert server.stop() == 0
    server.start()
    assert server.request("DELETE", M).status == 428
    gone = server.ok("DELETE", M, headers={"If-Match": server.get(M).headers["ETag"]})
    assert gone.status == 204


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
