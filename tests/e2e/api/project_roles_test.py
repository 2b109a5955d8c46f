"""Roles in one project. A guest sees nothing of other projects, in every operation of the contract.
In the guest's own projects, each role has its rights."""
import pytest
from support.browsers import uncoloured
from support.live_client import LiveClient, Refused
from support.meshes import folded_grid
from support.project_sites import Someone, make_sites, nothing_is_seen

FILL = {"op": "fill", "mode": "where", "where": "true", "value": 1}


@pytest.fixture(scope="module")
def sites(server):
    return make_sites(server)


@pytest.fixture(scope="module")
def villa(sites):
    return sites["villa"]


@pytest.fixture(scope="module")
def forum(sites):
    return sites["forum"]


@pytest.fixture(scope="module")
def guest(server, sites):
    return Someone(server, "Gus", "guest")


def test_nothing_is_seen_without_a_role(server, guest, villa):
    nothing_is_seen(server, guest, villa)


def test_ladder(server, guest, villa, forum):
    """A guest in the villa, from no role to curator and back."""
    model, table = "/models/" + villa["model"]["slug"], f"/tables/{villa['table']['id']}"
    tries = (
        ("GET", model, None),
        ("POST", model + "/layers/marks/edits", FILL),
        ("PATCH", model, {"credit": "x"}),
        ("GET", "/projects/villa/members", None),
        ("PUT", f"/projects/villa/members/{guest.user}", {"role": "curator"}),
        ("PATCH", "/projects/villa", {"description": "mine"}),
        ("GET", "/users", None),
    )
    for role, good in ((None, 0), ("viewer", 1), ("annotator", 2), ("curator", 4), ("viewer", 1)):
        if role:
            guest.now("villa", role)
        for i, (method, path, body) in enumerate(tries):
            status = guest.status(method, path, body)
            assert status == (200 if i < good else 403 if role or path == "/users" else 404), (
                role,
                method,
                path,
                status,
            )
        listed = {
            project["slug"]: project["role"]
            for project in guest.ok("GET", "/projects").json()["projects"]
        }
        assert listed == ({"villa": role} if role else {}), listed
    guest.now("villa", "curator")
    assert guest.ok("GET", "/me").json()["role"] == "guest"
    for path in (
        "/tools",
        "/templates",
        "/me/sessions",
        table + "/records",
        f"/attachments/{villa['attachment']['id']}",
        f"/jobs/{villa['job']['id']}",
    ):
        guest.ok("GET", path)
    assert [model["slug"] for model in guest.ok("GET", "/models").json()["models"]] == [
        villa["model"]["slug"]
    ]
    assert [job["id"] for job in guest.ok("GET", "/jobs").json()["jobs"]] == [villa["job"]["id"]]
    listed = guest.ok("GET", "/projects/villa/members").json()
    listed["members"] = [uncoloured(person) for person in listed["members"]]
    assert listed == {
        "members": [{"user": guest.user, "full_name": "", "role": "curator"}],
        "groups": [],
        "total": 1,
    }, listed
    imported = server.wait_for_job(
        guest.ok(
            "POST",
            "/models?filename=y.ply&name=Second&unit=mm&project=villa",
            folded_grid(fold=0.002),
        ).json()["id"]
    )
    assert imported["state"] == "done", imported
    # a model of another project is refused like one that does not exist
    other = forum["model"]["slug"]
    for path, body in (
        ("/transfer", lambda name: {"from": name}),
        (
            "/layers",
            lambda name: {"name": "d", "compute": {"kind": "model_distance", "model": name}},
        ),
        ("/layers", lambda name: {"name": "c", "compute": {"kind": "change", "model": name}}),
    ):
        refused = [
            guest.request("POST", "/models/second" + path, body(name)) for name in (other, "ghost")
        ]
        assert [answer.status for answer in refused] == [422, 422], refused
        hidden, absent = (answer.json() for answer in refused)
        assert hidden["detail"].replace(other, "ghost") == absent["detail"], (hidden, absent)
        assert hidden["field"] == absent["field"], (hidden, absent)


def test_nothing_is_seen_of_another_project(server, guest, forum):
    nothing_is_seen(server, guest, forum)


def test_scripts(server, guest, villa):
    """A token has at most the rights of its own role, in every project."""

    def token(**asked):
        made = guest.ok("POST", "/me/tokens", {"name": "t", "days": 1, **asked}).json()
        return made["secret"]

    model = "/models/" + villa["model"]["slug"]
    weak, full = token(role="viewer"), token()
    assert (
        server.get(model, token=weak).status == 200
        and server.request("PATCH", model, {"credit": "x"}, token=weak).status == 403
    )
    assert server.request("PATCH", model, {"credit": "y"}, token=full).status == 200
    assert (
        guest.status("POST", "/me/tokens", {"name": "t", "days": 1, "role": "administrator"}) == 403
    )
    root = server.ok("POST", "/me/tokens", {"name": "t", "days": 1}).json()["secret"]
    assert (
        server.request(
            "PUT", f"/projects/villa/members/{guest.user}", {"role": "viewer"}, token=root
        ).status
        == 403
    ), "scripts change nobody's role"


def test_both(server, villa, forum):
    """A user who can view all projects has more rights in a project in which the user has a role,
    and the usual rights in other projects."""
    vera = Someone(server, "Vera", "viewer")
    vera.now("villa", "curator")
    vera.ok("PATCH", "/models/" + villa["model"]["slug"], {"credit": "Vera"})
    vera.ok("GET", "/models/" + forum["model"]["slug"])
    assert vera.status("PATCH", "/models/" + forum["model"]["slug"], {"credit": "Vera"}) == 403
    vera.now("forum", "annotator")
    vera.ok("POST", f"/models/{forum['model']['slug']}/layers/marks/edits", FILL)
    assert {
        project["slug"]: project["role"]
        for project in vera.ok("GET", "/projects").json()["projects"]
    } == {"default": "viewer", "villa": "curator", "forum": "annotator"}
    anne = Someone(server, "Anne", "curator")
    anne.now("villa", "viewer")
    anne.ok("PATCH", "/models/" + villa["model"]["slug"], {"credit": "Anne"})
    # invalid requests get an error
    for body, status in (
        ({"role": "administrator"}, 422),
        ({"role": "guest"}, 422),
        ({}, 422),
        ({"role": "viewer", "x": 1}, 422),
    ):
        assert server.request("PUT", "/projects/villa/members/Anne", body).status == status, body
    for path in ("/projects/villa/members/nobody", "/projects/ghost/members/Anne"):
        assert server.request("PUT", path, {"role": "viewer"}).status == 404, path
    anne.now("villa", None)
    assert server.request("DELETE", "/projects/villa/members/Anne").status == 404
    server.ok("DELETE", "/users/Vera")
    assert "Vera" not in str(server.ok("GET", "/projects/villa/members").json())


def test_live(server, guest, villa):
    """An open connection ends with the role. A new connection has the new role."""

    def look():
        return LiveClient(
            server, villa["model"]["slug"], token="", cookie=guest.cookie, origin=server.url
        )

    for role, then in (("curator", "viewer"), ("viewer", None)):
        with look() as connection:
            assert connection.hello(dpr=1, accept=["jpeg"])["role"] == role
            guest.now("villa", then)
            connection.until_closed()
    try:
        look()
        raise AssertionError("they are no member any more")
    except Refused as refused:
        assert refused.status == 404, refused


def test_nothing_is_seen_afterwards(server, guest, villa):
    nothing_is_seen(server, guest, villa)


def test_the_log_is_clean(server):
    server.assert_clean_log()
