"""Accounts over HTTP and from the command line: signing in, the rights of each role, the end of
links and sessions, and the limit on guesses."""
import re
import socket
import subprocess

import pytest
from support.browsers import PASSWORD, Browser, join, secret_of, uncoloured
from support.live_client import LiveClient, Refused
from support.meshes import folded_grid
from support.strata_server import LONG_S, StrataServer, wait_for

M, L = "/models/sheet", "/models/sheet/layers/marks"
OTHER = "no herons any more, a pity"
FILL = {"op": "fill", "mode": "where", "where": "true", "value": 1}


@pytest.fixture(scope="module")
def fresh_server():
    with StrataServer() as server:
        yield server


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    server.ok("POST", M + "/layers", {"name": "Marks", "type": "u8", "resolution": 2048})
    return server


def test_each_start_prints_a_link_until_the_owner_has_a_password(fresh_server):
    """Until the owner has a password, only the newest link is valid."""
    server = fresh_server
    earlier = server.link
    assert server.stop() == 0
    server.start()
    later = server.link
    assert "/login?link=" in earlier and "/login?link=" in later and earlier != later, (
        earlier,
        later,
    )

    def opened(link):
        browser = Browser(server)
        return browser, browser.request("GET", "/" + link[link.index("/login") :])

    browser, answer = opened(later)
    assert answer.status == 303 and answer.headers["Location"] == "/", answer
    assert uncoloured(browser.ok("GET", "/me").json()) == {
        "user": "owner",
        "full_name": "",
        "role": "owner",
        "has_password": False,
    }
    for link in (earlier, later + "x"):
        assert opened(link)[1].status == 401, link
    other, answer = opened(later)
    assert answer.status == 303, "a link is good for a day"
    browser.ok("POST", "/me/password", {"password": PASSWORD})
    assert other.request("GET", "/me").status == 401, "the password ends other sessions"
    assert opened(later)[1].status == 401
    assert server.stop() == 0
    server.start()
    assert server.link == server.url + "/", server.link
    assert Browser(server).sign_in("owner", PASSWORD).status == 200
    server.sign_in_owner({"user": "owner", "password": PASSWORD})
    server.assert_clean_log()


def test_invitations(server, story):
    """A link works once, for one person, within a week. It is not a token."""
    made = server.ok("POST", "/users", {"user": "Ada", "full_name": "Ada L.", "role": "annotator"})
    invitation, secret = made.json(), secret_of(made.json())
    assert (
        made.headers["Location"] == "/api/v1/users/Ada"
        and made.headers["Cache-Control"] == "no-store"
    )
    assert invitation["user"] == {
        **invitation["user"],
        "user": "Ada",
        "role": "annotator",
        "state": "invited",
        "full_name": "Ada L.",
    }, invitation
    for name, status in (
        ("ada", 409),
        ("ADA", 409),
        ("", 422),
        ("a b", 422),
        ("<b>", 422),
        ("x" * 65, 422),
        ("owner", 409),
    ):
        assert server.post("/users", {"user": name}).status == status, name
    refused = server.post("/users", {"user": "boss", "role": "owner"})
    assert refused.status == 422 and refused.json()["field"] == "role", refused
    assert server.get("/me", token=secret).status == 401, "an invitation is no token"
    assert Browser(server).request("POST", "/login", {"token": secret}).status == 401
    shown = Browser(server).ok("POST", "/invitations/show", {"invitation": secret}).json()
    assert shown["user"] == "Ada", shown
    for password, title in (
        ("short", "Password too short"),
        ("ünßé", "Password too short"),
        ("ada ada 1", "Password too short"),
        ("xxAda123456", "Password too simple"),
    ):
        refused = Browser(server).request(
            "POST", "/invitations/accept", {"invitation": secret, "password": password}
        )
        assert (
            refused.status == 422
            and refused.json()["field"] == "password"
            and refused.json()["title"] == title
        ), (password, refused)
    ada = join(server, invitation, full_name="Ada Lovelace")
    me = ada.ok("GET", "/me").json()
    assert uncoloured(me) == {
        "user": "Ada",
        "full_name": "Ada Lovelace",
        "role": "annotator",
        "has_password": True,
    }, me
    for path in ("show", "accept"):
        body = {"invitation": secret, **({"password": PASSWORD} if path == "accept" else {})}
        assert Browser(server).request("POST", "/invitations/" + path, body).status == 401, "used"
    # A new link revokes the earlier one. The password stays valid until the user sets another one.
    first = server.ok("POST", "/users/ada/invite").json()
    second = server.ok("POST", "/users/Ada/invite").json()
    assert (
        Browser(server)
        .request("POST", "/invitations/show", {"invitation": secret_of(first)})
        .status
        == 401
    )
    assert Browser(server).sign_in("ada", PASSWORD).status == 200
    other = join(server, second, OTHER)
    assert ada.request("GET", "/me").status == 401, "a new password ends the sessions of before"
    assert (
        Browser(server).sign_in("ada", PASSWORD).status == 401
        and Browser(server).sign_in("ADA", OTHER).status == 200
    )
    story.ada = other


def test_roles(server, story):
    """Each role has its rights. A change takes effect immediately, also for open connections."""
    ada = story.ada
    vera = join(server, server.ok("POST", "/users", {"user": "vera"}).json())
    assert vera.ok("GET", "/me").json()["role"] == "viewer"
    carl = join(server, server.ok("POST", "/users", {"user": "carl", "role": "curator"}).json())
    anne = join(
        server, server.ok("POST", "/users", {"user": "anne", "role": "administrator"}).json()
    )
    calls = {
        "look": ("GET", M, None, 200),
        "paint": ("POST", L + "/edits", FILL, 200),
        "layer": ("POST", M + "/layers", {"name": "New"}, 201),
        "people": ("GET", "/users", None, 200),
        "project": ("POST", "/projects", {"name": "P"}, 201),
    }
    may = {
        "viewer": {"look"},
        "annotator": {"look", "paint"},
        "curator": {"look", "paint", "layer"},
        "administrator": set(calls),
    }
    for browser, role in (
        (vera, "viewer"),
        (ada, "annotator"),
        (carl, "curator"),
        (anne, "administrator"),
    ):
        for what, (method, path, body, good) in calls.items():
            status = browser.request(method, path, body).status
            assert status == (good if what in may[role] else 403), (role, what, status)
    history = server.ok("GET", L + "/edits").json()["edits"]
    assert {edit["user"] for edit in history} == {"Ada", "carl", "anne"}, history
    # Administrators can change neither themselves nor the owner, and cannot give a higher role than
    # their own.
    for path in ("/users/anne", "/users/owner"):
        for method, body in (
            ("PATCH", {"role": "viewer"}),
            ("PATCH", {"disabled": True}),
            ("DELETE", None),
        ):
            assert anne.request(method, path, body).status == 409, (method, path)
    assert anne.request("PATCH", "/users/ada", {"role": "owner"}).status == 422
    server.ok("POST", "/users", {"user": "amos", "role": "administrator"})
    for method, path, body in (
        ("PATCH", "/users/amos", {"disabled": True}),
        ("DELETE", "/users/amos", None),
        ("POST", "/users/amos/invite", None),
    ):
        assert (
            anne.request(method, path, body).status == 403
        ), "one administrator does not let themselves in as another"
    server.ok("DELETE", "/users/amos")
    assert anne.request("PATCH", "/users/nobody", {"role": "viewer"}).status == 404
    assert anne.request("PATCH", "/users/ada", {}).status == 422
    # A cookie is valid only for requests from this server's own page.
    for origin in ("https://elsewhere.example", "null"):
        assert anne.request("PATCH", "/users/ada", {"role": "viewer"}, Origin=origin).status == 403
    live = LiveClient(server, "sheet", token="", cookie=ada.cookie, origin=server.url)
    assert live.hello(dpr=1, accept=["jpeg"])["role"] == "annotator"
    anne.ok("PATCH", "/users/ada", {"role": "viewer"})
    live.until_closed()
    assert ada.request("POST", L + "/edits", FILL).status == 403
    with LiveClient(server, "sheet", token="", cookie=ada.cookie, origin=server.url) as live:
        assert live.hello(dpr=1, accept=["jpeg"])["role"] == "viewer"
        anne.ok("PATCH", "/users/Ada", {"role": "annotator", "disabled": True})
        live.until_closed()
    assert ada.request("GET", M).status == 401 and ada.sign_in("ada", OTHER).status == 401
    try:
        LiveClient(server, "sheet", token="", cookie=ada.cookie, origin=server.url)
        raise AssertionError("a disabled person came in")
    except Refused as refused:
        assert refused.status == 401, refused
    assert server.ok("GET", "/users/ada").json()["state"] == "disabled"
    anne.ok("PATCH", "/users/ada", {"disabled": False})
    assert ada.request("GET", "/me").status == 401, "the sessions of before stay ended"
    assert ada.sign_in("Ada", OTHER).status == 200
    story.vera, story.anne = vera, anne


def test_who_is_shut_out_meanwhile_does_nothing(server):
    """A user who loses access during a request cannot complete it."""
    boss = join(
        server, server.ok("POST", "/users", {"user": "boss", "role": "administrator"}).json()
    )
    body = b'{"user": "mole", "role": "administrator"}'
    with socket.create_connection((server.host, server.port), timeout=LONG_S) as link:
        link.sendall(
            f"POST /api/v1/users HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nOrigin: {server.url}\r\nCookie: {boss.cookie}\r\nConnection: close\r\n"
            f"Content-Type: application/json\r\nExpect: 100-continue\r\nContent-Length: {len(body)}\r\n\r\n".encode()
        )
        assert link.recv(100).startswith(b"HTTP/1.1 100"), "it was let in"
        server.ok("DELETE", "/users/boss")
        link.sendall(body)
        assert link.recv(1000).startswith(b"HTTP/1.1 401")
    assert server.get("/users/mole").status == 404


def test_sessions(server, story):
    ada = story.ada
    phone = Browser(server, "Mozilla/5.0 (Android 15) Chrome/130")
    assert phone.sign_in("ada", OTHER).status == 200
    listed = phone.ok("GET", "/me/sessions").json()["sessions"]
    assert (
        len(listed) == 2
        and [each["current"] for each in listed] == [True, False]
        and "Android" in listed[0]["agent"]
    ), listed
    ada.ok("DELETE", f"/me/sessions/{listed[0]['id']}")
    assert phone.request("GET", "/me").status == 401
    assert ada.request("DELETE", f"/me/sessions/{listed[0]['id']}").status == 404
    of_owner = server.ok("GET", "/me/sessions").json()["sessions"]
    assert not set(each["id"] for each in of_owner) & set(each["id"] for each in listed)
    phone.sign_in("ada", OTHER)
    ada.ok("DELETE", "/me/sessions")
    assert (
        phone.request("GET", "/me").status == 401
        and ada.ok("GET", "/me/sessions").json()["total"] == 1
    )
    phone.sign_in("ada", OTHER)
    for body, field in (
        ({"password": PASSWORD}, "current"),
        ({"current": "wrong", "password": PASSWORD}, "current"),
        ({"current": OTHER, "password": "short"}, "password"),
    ):
        refused = ada.request("POST", "/me/password", body)
        assert refused.status == 422 and refused.json()["field"] == field, refused
    ada.ok("POST", "/me/password", {"current": OTHER, "password": PASSWORD})
    assert phone.request("GET", "/me").status == 401 and ada.request("GET", "/me").status == 200
    ada.ok("PATCH", "/me", {"full_name": "Ada, Countess"})
    assert ada.ok("GET", "/me").json()["full_name"] == "Ada, Countess"
    signed_out = ada.cookie
    assert ada.ok("POST", "/logout").status == 204
    ada.cookie = signed_out
    assert ada.request("GET", "/me").status == 401
    assert ada.sign_in("ada", PASSWORD).status == 200


def test_tokens(server, story):
    """A script's token has only the rights that both the token and its user have. It cannot
    open a session."""
    ada = story.ada
    anne = story.anne
    made = ada.ok("POST", "/me/tokens", {"name": "nightly", "role": "viewer", "days": 3}).json()
    secret = made["secret"]
    assert (
        made["token"]["role"] == "viewer" and made["token"]["expires"] > made["token"]["created"]
    ), made
    assert (
        server.get(M, token=secret).status == 200
        and server.post(L + "/edits", FILL, token=secret).status == 403
    )
    assert ada.request("POST", "/me/tokens", {"name": "more", "role": "curator"}).status == 403
    assert (
        server.post("/me/tokens", {"name": "more", "role": "annotator"}, token=secret).status == 403
    ), "a token makes no stronger one"
    refused = Browser(server).request("POST", "/login", {"token": secret})
    assert refused.status == 403 and "script" in refused.json()["detail"], refused
    for method, path, body in (
        ("POST", "/me/password", {"current": PASSWORD, "password": OTHER}),
        ("GET", "/me/sessions", None),
        ("DELETE", "/me/sessions", None),
        ("GET", "/me/tokens", None),
        ("PATCH", "/me", {"full_name": "x"}),
        ("DELETE", f"/me/tokens/{made['token']['id']}", None),
    ):
        assert server.request(method, path, body, token=secret).status == 403, (method, path)
    assert server.get("/me", token=secret).json()["role"] == "viewer"
    painting = ada.ok("POST", "/me/tokens", {"name": "painter"}).json()
    assert server.post(L + "/edits", FILL, token=painting["secret"]).status == 200
    anne.ok("PATCH", "/users/ada", {"role": "viewer"})
    assert (
        server.post(L + "/edits", FILL, token=painting["secret"]).status == 403
    ), "no more than its person"
    anne.ok("PATCH", "/users/ada", {"role": "annotator"})
    listed = ada.ok("GET", "/me/tokens").json()
    assert [each["name"] for each in listed["tokens"]] == ["painter", "nightly"] and all(
        "last_used" in each for each in listed["tokens"]
    ), listed
    assert secret not in str(listed)
    # A token for one project can have the role curator at most, for every user.
    server.ok("POST", "/projects", {"name": "Tower"})
    refused = ada.request("POST", "/me/tokens", {"name": "t", "project": "nowhere"})
    assert refused.status == 404 and refused.json()["field"] == "project", refused
    for who, role, status in (
        (ada, "curator", 403),
        (anne, "administrator", 422),
        (anne, "guest", 422),
    ):
        refused = who.request("POST", "/me/tokens", {"name": "t", "project": "tower", "role": role})
        assert refused.status == status and refused.json()["field"] == "role", refused
    tower = anne.ok("POST", "/me/tokens", {"name": "of the tower", "project": "tower"}).json()
    only, default = (
        tower["secret"],
        anne.ok(
            "POST",
            "/me/tokens",
            {"name": "of the first", "project": "default", "role": "annotator"},
        ).json()["secret"],
    )
    assert tower["token"]["role"] == "curator" and tower["token"]["project"] == "tower", tower
    assert [
        project["slug"] for project in server.get("/projects", token=only).json()["projects"]
    ] == ["tower"]
    assert (
        server.get(M, token=only).status == 404 and server.get("/users", token=only).status == 403
    )
    table = server.post(
        "/projects/tower/tables", {"name": "Finds", "columns": [{"name": "Code"}]}, token=only
    )
    assert (
        table.status == 201
        and server.request("DELETE", f"/tables/{table.json()['slug']}", token=only).status == 204
    ), table
    assert (
        server.post(L + "/edits", FILL, token=default).status == 200
        and server.get("/projects/tower", token=default).status == 404
    )
    server.ok("DELETE", "/projects/tower")
    assert [each["name"] for each in anne.ok("GET", "/me/tokens").json()["tokens"]] == [
        "of the first"
    ]
    # the server caches the token for some seconds
    wait_for(
        lambda: server.get("/me", token=only).status == 401, "the token to be gone with its project"
    )
    anne.ok("DELETE", f"/me/tokens/{anne.ok('GET', '/me/tokens').json()['tokens'][0]['id']}")
    managing = anne.ok("POST", "/me/tokens", {"name": "manager"}).json()["secret"]
    assert (
        server.get("/users", token=managing).status == 200
        and server.post("/users/ada/invite", token=managing).status == 403
    )
    assert (
        anne.request("DELETE", f"/me/tokens/{made['token']['id']}").status == 404
    ), "somebody else's"
    ada.ok("DELETE", f"/me/tokens/{made['token']['id']}")
    assert server.get(M, token=secret).status == 401
    assert server.post(L + "/edits", FILL, token=painting["secret"]).status == 200


def test_deletion(server, story):
    """The history no longer contains the name of a deleted user. Other users cannot take that
    name."""
    anne = story.anne
    before = server.ok("GET", L + "/edits").json()["edits"]
    mine = [edit["sequence"] for edit in before if edit["user"] == "Ada"]
    number = server.ok("GET", "/users/ada").json()["id"]
    anne.ok("DELETE", "/users/ada")
    after = server.ok("GET", L + "/edits").json()["edits"]
    assert (
        mine and [edit["sequence"] for edit in after if edit["user"] == f"former-{number}"] == mine
    ), after
    assert (
        server.get("/users/ada").status == 404
        and "ada" not in str(server.ok("GET", "/users").json()).lower()
    )
    assert Browser(server).sign_in("ada", PASSWORD).status == 401
    assert Browser(server).sign_in(f"former-{number}", PASSWORD).status == 401
    assert server.post("/users", {"user": f"former-{number}"}).status == 409


def test_commands(server):
    """The command line can change accounts too, on the server's own machine and while the server
    runs."""

    def strata(*words, entered=None, code=0):
        done = subprocess.run(
            [server.binary, *words, "--data", server.data],
            capture_output=True,
            text=True,
            check=False,
            timeout=LONG_S,
            input=entered,
        )
        assert done.returncode == code, (words, done)
        return done.stdout + done.stderr

    link = re.search(
        r"http://here/join#(\S+)", strata("user", "add", "Max", "--url", "http://here")
    )
    assert (
        Browser(server).ok("POST", "/invitations/show", {"invitation": link[1]}).json()["role"]
        == "annotator"
    )
    assert "too short" in strata(
        "user", "password", "max", "--password-stdin", entered="short\n", code=1
    )
    strata("user", "password", "max", "--password-stdin", entered="a horse, a kingdom\n")
    assert server.get("/users/max").json()["state"] == "active"
    strata("user", "role", "max", "guest")
    assert re.search(r"Max +guest +active", strata("user", "list"))
    project = server.ok("POST", "/projects", {"name": "Villa"}).json()["slug"]
    strata("user", "role", "max", "annotator", "--project", project)
    assert re.search(r"Max +annotator", strata("user", "list", "--project", project)) and re.search(
        r"Max +guest", strata("user", "list")
    )
    for role, place in (
        ("administrator", project),
        ("guest", project),
        ("viewer", "nowhere"),
        ("none", "nowhere"),
    ):
        assert "strata: " in strata("user", "role", "max", role, "--project", place, code=1), (
            role,
            place,
        )
    assert "annotator" in strata(
        "user", "list", "--project", project
    ), "what was refused changed nothing"
    strata("user", "role", "max", "none", "--project", project)
    assert strata("user", "list", "--project", project) == ""
    for words in (
        ("user", "role", "max", "none", "--project", project),
        ("user", "role", "max", "none"),
        ("user", "list", "--project", "nowhere"),
    ):
        assert "strata: " in strata(*words, code=1), words
    strata("user", "role", "max", "curator")
    listed = strata("user", "list")
    assert re.search(r"Max +curator +active", listed) and "owner" in listed, listed
    secret = strata("token", "add", "report", "--user", "max", "--role", "viewer").strip()
    assert server.get("/me", token=secret).json()["role"] == "viewer"
    assert re.search(
        r"curator +until .*nightly \(only default\)",
        strata("token", "add", "nightly", "--user", "max", "--project", "default")
        and strata("token", "list", "--user", "max"),
    )
    strata("user", "role", "max", "viewer")
    assert re.search(
        r"viewer +until .*watch \(only default\)",
        strata("token", "add", "watch", "--user", "max", "--project", "default")
        and strata("token", "list", "--user", "max"),
    )
    strata("user", "role", "max", "annotator", "--project", "default")
    assert re.search(
        r"annotator +until .*brush \(only default\)",
        strata("token", "add", "brush", "--user", "max", "--project", "default")
        and strata("token", "list", "--user", "max"),
    )
    for words in (
        ("--project", "nowhere"),
        ("--project", "default", "--role", "administrator"),
        ("--project", "default", "--role", "curator"),
    ):
        assert "strata: " in strata("token", "add", "x", "--user", "max", *words, code=1), words
    number = re.search(r"(\d+) +viewer .*report", strata("token", "list", "--user", "max"))[1]
    strata("token", "revoke", number, "--user", "max")
    assert "report" not in strata("token", "list", "--user", "max")
    for words in (
        ("user", "role", "owner", "viewer"),
        ("user", "disable", "owner"),
        ("user", "remove", "owner"),
        ("user", "remove", "nobody"),
        ("user", "add", "max"),
        ("user", "add", "a b"),
        ("token", "add", "x", "--user", "max", "--role", "administrator"),
        ("token", "revoke", number, "--user", "max"),
    ):
        assert "strata: " in strata(*words, code=1), words
    strata("user", "role", "max", "king", code=2)
    strata("user", "add", "nobody", "--password-stdin", entered="short", code=1)
    assert (
        server.get("/users/nobody").status == 404
    ), "without a password that will do there is no account"
    strata("user", "remove", "max")
    assert server.get("/users/max").status == 404


def test_guessing_is_slow(server, story):
    """The server limits the guesses for a name from all addresses together. Open sessions stay
    open."""
    vera = story.vera
    statuses = [Browser(server).sign_in("vera", f"guess number {i}").status for i in range(14)]
    assert set(statuses) == {401, 429} and statuses[0] == 401 and statuses[-1] == 429, statuses
    refused = Browser(server).sign_in("vera", PASSWORD)
    assert refused.status == 429 and refused.headers["Retry-After"], refused
    assert vera.request("GET", "/me").status == 200
    # Other users can sign in from another address during this time.
    anne = Browser(server)
    assert (
        anne.request(
            "POST",
            "/login",
            {"user": "anne", "password": PASSWORD},
            **{"X-Forwarded-For": "10.9.8.7"},
        ).status
        == 200
    )
    for body in (
        {"user": "vera"},
        {"password": "x"},
        {"user": "vera", "password": "x", "token": "y"},
        {},
        {"user": ["vera"], "password": {}},
    ):
        assert Browser(server).request("POST", "/login", body).status == 422, body


def test_the_log_is_clean(server):
    server.assert_clean_log()


def test_reach(server):
    """A server that other machines can reach needs a user who can give others access."""
    assert server.stop() == 0

    def serve():
        done = subprocess.Popen(
            [server.binary, "serve", "--data", server.data, "--listen", "0.0.0.0:0"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        first = done.stdout.readline()
        done.terminate()
        return first, done.communicate(timeout=LONG_S)[1]

    started, _ = serve()
    assert started.startswith("listening on http://0.0.0.0:"), started
    for name in ("anne",):
        subprocess.run(
            [server.binary, "user", "disable", name, "--data", server.data],
            check=True,
            timeout=LONG_S,
            capture_output=True,
        )
    started, said = serve()
    assert not started and "strata user add" in said, (started, said)
