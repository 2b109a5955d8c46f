"""Tours over HTTP, and the links of kiosks that show them. The file tests the rights to make tours
and links. It tests the content that a kiosk sees: the public part of its model, read only, in every
operation of the contract. It also tests a browser with the cookies of a kiosk and of a user, and
the end of links."""
import subprocess
import uuid

import pytest
from support.browsers import Browser, join
from support.kiosk_site import ALL, STOP, TOUR, M, make_kiosk, make_site, others_closed, sweep, told
from support.live_client import LiveClient, Refused
from support.strata_server import LONG_S, wait_for


@pytest.fixture(scope="module", autouse=True)
def site(server):
    """Returns the camera, files and thread of the site's model."""
    return make_site(server)


@pytest.fixture(scope="module")
def camera(site):
    return site[0]


@pytest.fixture(scope="module")
def tokens(server):
    return {
        name: server.add_person(name, role)
        for name, role in (("vera", "viewer"), ("ada", "annotator"), ("carl", "curator"))
    }


def test_tours(server, tokens, story):
    def ask(who, method, path, body=None, **more):
        return server.request(method, path, body, token=tokens[who], **more)

    told(ask("ada", "POST", ALL, TOUR), 403)
    key = {"Idempotency-Key": str(uuid.uuid4())}
    made = ask("carl", "POST", ALL, TOUR, headers=key)
    assert (
        made.status == 201
        and made.headers["ETag"] == '"v1"'
        and made.headers["Location"] == f"/api/v1{ALL}/once-around"
    ), made
    tour = made.json()
    assert ask("carl", "POST", ALL, TOUR, headers=key).json() == tour
    full = {
        **TOUR,
        "stops": [
            STOP,
            {
                **TOUR["stops"][1],
                "text": {},
                "attract_s": 10,
                "transition": "move",
                "transition_s": 2,
                "layers": [],
                "records": [],
            },
        ],
    }
    assert {member: tour[member] for member in full} == full and tour["user"] == "carl", tour
    path = f"{ALL}/{tour['slug']}"
    assert (
        ask("carl", "GET", path).json() == ask("carl", "GET", f"{ALL}/{tour['id']}").json() == tour
    )
    # content that a user cannot see is omitted
    seen = ask("vera", "GET", path).json()
    assert seen["stops"][0]["layers"] == ["cracks"] and [
        column["column"] for column in seen["stops"][0]["records"][0]["columns"]
    ] == ["name"], seen
    listed = ask("vera", "GET", ALL).json()
    assert (
        listed["total"] == 1
        and listed["tours"][0]["stop_count"] == 2
        and "stops" not in listed["tours"][0]
    ), listed
    assert (
        ask(
            "vera", "GET", path, headers={"If-None-Match": ask("vera", "GET", path).headers["ETag"]}
        ).status
        == 304
    )
    # the client can send the response back, and versions protect the tour
    again = ask(
        "carl", "PATCH", path, {"stops": tour["stops"]}, headers={"If-Match": '"v1"'}
    ).json()
    assert again == {**tour, "version": 2}, again
    told(ask("carl", "PATCH", path, {"name": "Stale"}, headers={"If-Match": '"v1"'}), 412)
    told(ask("ada", "PATCH", path, {"name": "Hers"}), 403)
    assert ask("carl", "PATCH", path, {"name": "Around", "idle_s": 30}).json() == {
        **tour,
        "name": "Around",
        "idle_s": 30,
        "version": 3,
    }

    # The refusal contains the name of the invalid field.
    def stop(**more):
        return {"stops": [{**TOUR["stops"][1], **more}]}

    def of(**more):
        return stop(records=[{"table": "finds", "keys": [1], "columns": [], **more}])

    for body, field in (
        (stop(view="nowhere"), "stops[0].view"),
        (stop(view="other-view"), "stops[0].view"),
        (stop(layers=["cracks", "ghost"]), "stops[0].layers[1]"),
        (stop(layers=["cracks", "cracks"]), "stops[0].layers[1]"),
        (of(table="ghost"), "stops[0].records[0].table"),
        (of(table="elsewhere"), "stops[0].records[0].table"),
        (of(keys=[1, 99]), "stops[0].records[0].keys[1]"),
        (of(columns=[{"column": "ghost"}]), "stops[0].records[0].columns[0].column"),
        (
            of(columns=[{"column": "name"}, {"column": "name"}]),
            "stops[0].records[0].columns[1].column",
        ),
        (
            of(columns=[{"column": "name", "labels": {"fr": "Nom"}}]),
            "stops[0].records[0].columns[0].labels.fr",
        ),
        (stop(title={"es": "Sin"}), "stops[0].title"),
        (stop(title={"en": "A", "fr": "B"}), "stops[0].title.fr"),
        (stop(text={"fr": "B"}), "stops[0].text.fr"),
        ({"languages": ["en", "en"]}, "languages[1]"),
        ({"languages": ["es", "en"]}, "languages"),
        ({"languages": ["en"]}, "languages"),
        ({"languages": ["English"]}, "languages[0]"),
        ({"stops": []}, "stops"),
        (stop(attract_s=0), "stops[0].attract_s"),
        (stop(transition="fade"), "stops[0].transition"),
        ({"idle_s": 29}, "idle_s"),
        ({"name": ""}, "name"),
        ({"stops": [TOUR["stops"][1]] * 101}, "stops"),
        ({}, None),
    ):
        told(ask("carl", "PATCH", path, body), 422, field)
        if "stops" in body:
            told(ask("carl", "POST", ALL, {**TOUR, **body}), 422, field)
    told(ask("carl", "POST", ALL, {**TOUR, "nothing": 1}), 422)
    # deleting a view or a layer does not change the tour
    spare = ask(
        "carl", "POST", ALL, {**TOUR, "name": "Spare", "stops": [{**STOP, "view": "east"}]}
    ).json()
    camera = server.get(M + "/views/east").json()["camera"]
    gone = server.ok("POST", M + "/views", {"name": "Gone", "camera": camera}).json()
    server.ok("POST", M + "/layers", {"name": "Passing", "type": "u8"})
    server.ok(
        "PATCH",
        f"{ALL}/spare",
        {"stops": [{**STOP, "view": "gone", "layers": ["passing", "cracks"]}]},
    )
    server.ok("DELETE", f"{M}/views/{gone['slug']}")
    server.ok("DELETE", M + "/layers/passing")
    left = server.get(f"{ALL}/spare").json()["stops"][0]
    assert (
        "view" not in left and left["layers"] == ["cracks"] and left["title"] == STOP["title"]
    ), left
    server.ok("PATCH", f"{ALL}/spare", {"name": "Renamed"})
    told(server.request("PATCH", f"{ALL}/spare", {"stops": [left]}), 422, "stops[0].view")
    assert server.request("DELETE", f"{ALL}/{spare['id']}").status == 204
    told(server.get(f"{ALL}/spare"), 404)
    told(server.get("/models/nothing/tours"), 404)
    story.tour = path


def test_links(server, tokens, story):
    """Each role has its rights to make, list and revoke links."""
    tour = story.tour
    for who in ("vera", "ada"):
        told(server.post(tour + "/kiosks", {"name": "Hall"}, token=tokens[who]), 403)
        assert server.get("/kiosks", token=tokens[who]).json() == {"kiosks": [], "total": 0}
    # a link that a script makes would outlive the script's token
    told(server.post(tour + "/kiosks", {"name": "Hall"}, token=tokens["carl"]), 403)
    for body, field in (
        ({}, "name"),
        ({"name": ""}, "name"),
        ({"name": "x" * 201}, "name"),
        ({"name": "H", "days": 0}, "days"),
        ({"name": "H", "x": 1}, None),
    ):
        told(server.post(tour + "/kiosks", body), 422, field)
    told(server.post(ALL + "/ghost/kiosks", {"name": "Hall"}), 404)
    kiosk, secret = make_kiosk(server, tour, "Entrance hall", days=30)
    assert (
        kiosk["name"] == "Entrance hall"
        and kiosk["model"] == "sheet"
        and kiosk["tour"] == "once-around"
        and kiosk["expires"] > kiosk["created"]
        and not kiosk["wants_reload"]
    ), kiosk
    listed = server.get("/kiosks")
    assert (
        listed.json() == {"kiosks": [kiosk], "total": 1} and secret not in listed.body.decode()
    ), listed
    assert server.get("/kiosks", token=tokens["carl"]).json()["total"] == 1, "a curator everywhere"
    # a curator of one project sees the kiosks of that project
    gus = join(server, server.ok("POST", "/users", {"user": "gus", "role": "guest"}).json())
    server.ok("PUT", "/projects/villa/members/gus", {"role": "curator"})
    assert gus.request("GET", "/kiosks").json()["total"] == 0
    for method, path in (
        ("DELETE", f"/kiosks/{kiosk['id']}"),
        ("POST", f"/kiosks/{kiosk['id']}/reload"),
    ):
        told(gus.request(method, path), 404)
        told(server.request(method, path, token=tokens["ada"]), 403)
        told(server.request(method, path.replace(str(kiosk["id"]), "987654")), 404)
    server.ok("PUT", "/projects/default/members/gus", {"role": "curator"})
    assert gus.request("GET", "/kiosks").json()["total"] == 1
    assert gus.ok("POST", f"/kiosks/{kiosk['id']}/reload").json()["wants_reload"]
    gus.ok("DELETE", f"/kiosks/{kiosk['id']}")
    assert server.get("/kiosks").json()["kiosks"][0]["revoked"]
    told(server.post(f"/kiosks/{kiosk['id']}/reload"), 409)
    told(server.post("/auth/kiosk", {"link": secret}, token=False), 401, "link")


def test_a_kiosk_opens_the_doors_of_its_tour_alone(server, site, story):
    _, files, thread = site
    _, story.sweep_secret = make_kiosk(server, story.tour, "Sweep")
    answered, refused = sweep(server, story.sweep_secret, story.tour, files, thread)
    others_closed(server, story.sweep_secret, files)
    print(f"{answered} doors open, {refused} closed")


class Screen(Browser):
    """The page of a kiosk. It marks all its requests as requests of a kiosk."""

    def request(self, method, path, body=None, **headers):
        return super().request(
            method, path + ("&" if "?" in path else "?") + "as=kiosk", body, **headers
        )


def test_cookies(server, story):
    """Marked requests use the kiosk's cookie, and all other requests use the user's cookie."""
    tour = story.tour
    kiosk, secret = make_kiosk(server, tour, "Cookie")
    page = server.get(f"//kiosk/{secret}", token=False)
    assert page.status in (200, 503) and page.headers["Referrer-Policy"] == "no-referrer", page
    screen = Screen(server)
    signed = screen.request("POST", "/auth/kiosk", {"link": secret})
    cookie = signed.headers["Set-Cookie"]
    assert (
        signed.status == 200
        and cookie.startswith("strata_kiosk=")
        and all(word in cookie for word in ("HttpOnly", "SameSite=Strict", "Path=/"))
    ), signed
    own = screen.ok("GET", "/kiosk").json()
    assert (
        own == signed.json()
        and own["id"] == kiosk["id"]
        and own["name"] == "Cookie"
        and own["tour"]["user"] == ""
        and own["model"] == "sheet"
        and own["project"] == "default"
    ), own
    assert own["tour"]["stops"][0]["layers"] == ["cracks"] and "expires" not in own, own
    assert screen.ok("GET", M).json()["slug"] == "sheet"
    picture = screen.ok("GET", "/tables/finds/records/1/attachments").json()["attachments"]
    assert [each["name"] for each in picture] == ["public.png"] and screen.ok(
        "GET", f"/attachments/{picture[0]['id']}?thumbnail=64"
    ).body, picture
    told(
        server.request(
            "PATCH",
            M + "?as=kiosk",
            {"name": "x"},
            token=False,
            headers={"Cookie": screen.cookie, "Origin": "https://elsewhere.example"},
        ),
        403,
    )
    # an unmarked request does not use the kiosk's cookie, and a marked one does not use a user's
    # session
    told(server.get("/kiosk", token=False, headers={"Cookie": screen.cookie}), 401)
    told(server.get(M, token=False, headers={"Cookie": screen.cookie}), 401)
    dora = join(server, server.ok("POST", "/users", {"user": "dora", "role": "curator"}).json())
    session = dora.cookie
    told(server.get(M + "?as=kiosk", token=False, headers={"Cookie": session}), 401)
    told(
        server.get(
            M + "?as=kiosk",
            token=False,
            headers={"Cookie": session.replace("strata_session", "strata_kiosk")},
        ),
        401,
    )
    told(server.get(M, token=False, headers={"Cookie": "strata_session=" + secret}), 401)
    told(server.get(M + "?as=kiosk"), 401)  # the owner's token is not valid for marked requests
    told(server.get(M + "?as=person"), 400, "as")
    # with both cookies, each is used for its own requests
    dora.cookie = session + "; " + screen.cookie
    assert (
        len(dora.ok("GET", M + "/layers").json()["layers"]) == 3
        and dora.ok("GET", "/me").json()["user"] == "dora"
    )
    screen.cookie = dora.cookie
    assert len(screen.ok("GET", M + "/layers").json()["layers"]) == 2
    assert (
        screen.request("GET", "/me").status == 403 and dora.request("GET", "/kiosk").status == 403
    )
    assert screen.request("PATCH", M, {"name": "Mine"}).status == 403
    assert screen.request("GET", M, Cookie="strata_kiosk=x; strata_session=" + secret).status in (
        200,
        401,
    )
    # the secret cannot be used to sign in, and guesses are counted
    for path, body in (
        ("/login", {"token": secret}),
        ("/invitations/accept", {"invitation": secret, "password": "seven blue herons at noon"}),
    ):
        assert server.post(path, body, token=False, headers={"Origin": server.url}).status in (
            401,
            403,
        ), path
    for body, status in (
        ({"link": ""}, 422),
        ({"link": "x" * 201}, 422),
        ({"link": "é\n"}, 401),
        ({}, 422),
        ({"link": 7}, 422),
        ({"link": secret, "x": 1}, 422),
    ):
        told(server.post("/auth/kiosk", body, token=False), status)
    told(
        server.post(
            "/auth/kiosk",
            {"link": secret},
            token=False,
            headers={"Origin": "https://elsewhere.example"},
        ),
        403,
    )
    away = {"X-Forwarded-For": "10.9.8.7"}
    wait_for(
        lambda: server.post("/auth/kiosk", {"link": "guess"}, token=False, headers=away).status
        == 429,
        "guesses to be held up",
    )
    story.kiosk, story.cookie_secret, story.screen = kiosk, secret, screen


def test_heartbeat(server, story):
    """The list shows the last contact, and the request for a reload."""
    kiosk = story.kiosk
    secret = story.cookie_secret
    screen = story.screen

    def listed():
        return next(
            each for each in server.get("/kiosks").json()["kiosks"] if each["id"] == kiosk["id"]
        )

    assert listed()["last_seen"] and not listed()["wants_reload"]
    assert server.ok("POST", f"/kiosks/{kiosk['id']}/reload").json()["wants_reload"]
    assert (
        screen.ok("GET", "/kiosk").json()["wants_reload"]
        and screen.ok("GET", "/kiosk").json()["wants_reload"]
        and listed()["wants_reload"]
    )
    assert not screen.ok("POST", "/auth/kiosk", {"link": secret}).json()["wants_reload"]
    assert not screen.ok("GET", "/kiosk").json()["wants_reload"] and not listed()["wants_reload"]
    screen.ok("GET", "/kiosk")


def test_live(server, story, camera):
    """The live connection of a kiosk can only view, and receives no names of users."""
    tour = story.tour
    kiosk, secret = make_kiosk(server, tour, "Live")
    cookie = "strata_kiosk=" + secret
    for model, options, status in (
        ("other", {"token": secret}, 404),
        ("villa-wall", {"token": secret}, 404),
        ("sheet", {"token": "", "cookie": cookie, "origin": server.url}, 401),
        (
            "sheet",
            {
                "token": "",
                "cookie": cookie,
                "origin": "https://elsewhere.example",
                "query": "?as=kiosk",
            },
            403,
        ),
        ("sheet", {"query": "?as=kiosk"}, 401),
    ):
        try:
            LiveClient(server, model, **options)
            raise AssertionError(f"{model} {options} was let in")
        except Refused as refused:
            assert refused.status == status, (model, options, refused)
    with LiveClient(
        server, "sheet", token="", cookie=cookie, origin=server.url, query="?as=kiosk"
    ) as screen:
        assert screen.hello(dpr=1, accept=["jpeg"])["role"] == "viewer"
    with LiveClient(server, "sheet", token=secret) as screen, LiveClient(server, "sheet") as owner:
        owner.hello(dpr=1, accept=["jpeg"])
        welcome = screen.hello(dpr=1, accept=["jpeg"])
        assert (
            welcome["role"] == "viewer"
            and welcome["user"] == f"kiosk {kiosk['id']}"
            and {layer["slug"] for layer in welcome["layers"]} == {"cracks", "finds"}
        ), welcome
        screen.send({"op": "camera", "seq": 1, "moving": False, **camera})
        screen.send(
            {"op": "layers", "layers": [{"layer": "cracks", "visible": False}], "looks": []}
        )
        screen.receive_until("frame")
        one, two = str(uuid.uuid4()), str(uuid.uuid4())
        for message in (
            {
                "op": "edit",
                "id": one,
                "layer": "cracks",
                "edit": {"op": "fill", "mode": "where", "where": "true", "value": 1},
            },
            {
                "op": "stroke.begin",
                "id": one,
                "stroke": two,
                "layer": "cracks",
                "value": 1,
                "camera": camera,
                "radius_px": 8,
            },
            {"op": "stroke.extend", "id": one, "stroke": two, "n": 0, "path": [[1, 1]]},
            {"op": "stroke.end", "id": one, "stroke": two},
            {"op": "undo", "id": one, "layer": "cracks"},
            {"op": "redo", "id": one, "layer": "cracks"},
            {"op": "record.edit", "id": one, "table": 1, "key": 1, "editing": True},
            {"op": "presence", "pointer": [1, 1]},
        ):
            screen.send(message)
            problem = screen.receive_until("problem")
            assert problem["status"] == 403 and problem["title"] == "Not allowed for kiosks", (
                message,
                problem,
            )
        screen.send({"op": "pick", "id": one, "camera": camera, "x": 320, "y": 240})
        heard = [screen.receive_until("picked", "presence", "record.editors")]
        # changes by others arrive without their names, and changes outside the model do not arrive
        server.ok("PATCH", "/tables/finds/records/1", {"values": {"name": "Find one"}})
        server.ok("POST", M + "/comments", {"text": "Here.", "position": [10, 10, 0]})
        owner.send({"op": "presence", "pointer": [320, 240]})
        server.ok(
            "POST",
            M + "/layers/cracks/edits",
            {"op": "fill", "mode": "where", "where": "x < 5", "value": 1},
        )
        server.ok("POST", M + "/views", {"name": "Told", "camera": camera})
        ops = (
            "picked",
            "presence",
            "record",
            "record.editors",
            "table",
            "comment",
            "layer",
            "view",
            "problem",
        )
        while heard[-1]["op"] != "view":
            heard.append(screen.receive_until(*ops))
        assert {message["op"] for message in heard} == {"picked", "layer", "view"}, heard
        assert all("user" not in message for message in heard), heard
        # other users do not see the kiosk
        owner.send({"op": "presence", "pointer": [321, 240]})
        assert {user["name"] for user in owner.receive_until("presence")["users"]} == {"owner"}
        server.ok("DELETE", f"/kiosks/{kiosk['id']}")
        screen.until_closed()
    told(server.get("/kiosk", token=secret), 401)
    story.live_secret = secret


def test_commands(server):
    """The command line can manage links too, on the server's own machine."""

    def strata(*words, code=0):
        done = subprocess.run(
            [server.binary, "kiosk", *words, "--data", server.data],
            capture_output=True,
            text=True,
            check=False,
            timeout=LONG_S,
        )
        assert done.returncode == code, (words, done)
        return done.stdout if code == 0 else done.stderr

    link = strata(
        "create",
        "sheet/once-around",
        "--name",
        "Cellar",
        "--days",
        "3",
        "--url",
        "https://strata.example",
    ).splitlines()[-1]
    secret = link.removeprefix("https://strata.example/kiosk/")
    assert len(secret) == 43, link
    kiosk = server.get("/kiosk", token=secret).json()
    assert kiosk["name"] == "Cellar" and kiosk["expires"], kiosk
    line = next(line for line in strata("list").splitlines() if "Cellar" in line)
    assert (
        line.split()[0] == str(kiosk["id"]) and "sheet/once-around" in line and secret not in line
    ), line
    strata("reload", str(kiosk["id"]))
    assert server.get("/kiosk", token=secret).json()["wants_reload"]
    strata("revoke", str(kiosk["id"]))
    assert "revoked" in next(line for line in strata("list").splitlines() if "Cellar" in line)
    wait_for(lambda: server.get("/kiosk", token=secret).status == 401, "the server to hear of it")
    for words in (
        ("create", "sheet/ghost", "--name", "x"),
        ("create", "ghost/once-around", "--name", "x"),
        ("create", "once-around", "--name", "x"),
        ("create", "sheet/once-around", "--name", ""),
        ("revoke", "987654"),
        ("reload", str(kiosk["id"])),
    ):
        assert strata(*words, code=1), words
    for words in (
        ("create", "sheet/once-around"),
        ("create", "sheet/once-around", "--name", "x", "--days", "0"),
        ("revoke", "x"),
        (),
    ):
        strata(*words, code=2)


def test_a_link_is_good_over_a_restart(server, story):
    assert server.stop() == 0
    server.start()
    assert server.get("/kiosk", token=story.sweep_secret).status == 200
    story.screen.server = server


def test_ends(server, story):
    """Revocation takes effect everywhere immediately. A link is deleted with its tour."""
    kiosk = story.kiosk
    secret = story.cookie_secret
    screen = story.screen
    tour = story.tour
    screen.ok("GET", "/kiosk")
    server.ok("DELETE", f"/kiosks/{kiosk['id']}")
    told(screen.request("GET", "/kiosk"), 401)
    told(server.get(M, token=secret), 401)
    told(server.post("/auth/kiosk", {"link": secret}, token=False), 401, "link")
    server.ok("DELETE", f"/kiosks/{kiosk['id']}")  # a repeat of the revocation has no effect
    _, other = make_kiosk(server, tour, "Last")
    with LiveClient(server, "sheet", token=other) as connection:
        connection.hello(dpr=1, accept=["jpeg"])
        server.ok("DELETE", tour)
        connection.until_closed()
    told(server.get("/kiosk", token=other), 401)


def test_no_link_stands_in_the_log(server, story):
    secrets = (story.sweep_secret, story.cookie_secret, story.live_secret)
    assert not any(word in line for line in server.log for word in secrets)
    server.assert_clean_log()
