"""ETags of all reads that have one in the contract. The server returns 304 while the response is
the same, and never after a change."""
import urllib.parse

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import png

M, T = "/models/sheet", "/tables/finds"
OF_PATH = {
    "project": "default",
    "model": "sheet",
    "layer": "finds",
    "table": "finds",
    "column": "place",
    "key": "1",
    "view": "west",
    "tour": "round",
    "snapshot": "first",
    "selection": "sunny",
    "look": "plain",
    "tool": "left",
    "user": "ada",
    "format": "npy",
    "name": "sheet.ply",
}
OF_QUERY = {
    "/models/{model}/position": "?coords=POINT(30 30 0)",
    "/tables/{table}/columns/{column}/classes": "?method=unique",
    "/projects/{project}/objects/{object}/statistics": "?layer=finds",
}
LISTS_OF_TERMS = "/tables/{table}/terms"
# This read needs a kiosk's cookie, and the time of the last use changes with each request.
LEFT_OUT = {"/api/v1/kiosk"}
TEXT = "a text that makes the answer as long as those that are compressed. " * 30


def plain(side):
    return png(side, side, lambda x, y: (200, 200, 180))


def make_site(server):
    model = server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    camera = camera_from(model, (0, 0, 1), up=(0, 1, 0))
    server.ok(
        "POST",
        "/projects/default/terms?name=Damage",
        b"code,label\nloss,Loss\n",
        headers={"Content-Type": "text/csv"},
    )
    columns = [
        {"name": "Name"},
        {"name": "Place", "kind": "relation"},
        {"name": "Photo", "kind": "picture"},
    ]
    columns[1]["target"] = "damage"
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Finds", "kind": "database", "type": "u16", "columns": [columns[0], columns[2]]},
    )
    table = server.ok("GET", T).json()
    server.ok("POST", T + "/columns", {**columns[1], "target": table["id"]})
    server.ok(
        "POST", T + "/records", {"records": [{"values": {"name": f"Find {n}"}} for n in (1, 2)]}
    )
    fill(server, 1)
    file = server.ok(
        "POST", T + "/records/1/attachments?name=x.png&column=photo", plain(64)
    ).json()["attachments"][0]["id"]
    server.ok("POST", M + "/looks?name=Plain", plain(64), headers={"Content-Type": "image/png"})
    server.ok(
        "POST",
        "/tools?name=Left",
        png(64, 64, lambda x, y: (255,) * 3 if x < 32 else (0,) * 3),
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
    picture = server.ok("POST", M + "/tours/round/files?name=west.png", plain(64)).json()["id"]
    poses = b"#name,x,y,alt,heading,pitch,roll,f\nwest.png,50,50,300,0,0,0,35\n"
    server.ok("POST", M + "/photograph-poses?filename=poses.csv", poses)
    photograph = server.ok("POST", M + "/photographs?filename=west.png", plain(64)).json()["id"]
    comment = server.ok("POST", M + "/comments", {"text": "Look.", "position": [30, 30, 0]}).json()[
        "id"
    ]
    server.ok("POST", f"/comments/{comment}/replies", {"text": "I did."})
    group = server.ok("POST", "/groups", {"name": "Students", "members": []}).json()["id"]
    thing = server.ok("POST", "/projects/default/objects", {"name": "Sheet"}).json()["id"]
    server.ok("PATCH", M, {"object": thing, "survey_date": "2019"})
    bill = server.ok("POST", "/projects/default/bills", {"name": "Facade"}).json()["id"]
    job = server.ok(
        "POST", M + "/figures", {"format": "png", "dpi": 100}, headers={"Prefer": "respond-async"}
    ).json()["id"]
    server.wait_for_job(job)
    OF_PATH.update(
        {
            "attachment": str(file),
            "file": str(picture),
            "photograph": str(photograph),
            "comment": str(comment),
            "group": str(group),
            "object": str(thing),
            "bill": str(bill),
            "job": str(job),
        }
    )
    server.add_person("ada", "annotator")
    return camera


def fill(server, value):
    server.ok(
        "POST",
        M + "/layers/finds/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": value},
    )


def address(path):
    asked = path.removeprefix("/api/v1")
    query = OF_QUERY.get(asked, "")
    named = {
        **OF_PATH,
        **({"table": "damage"} if asked == LISTS_OF_TERMS else {}),
        **({"column": "name"} if asked.endswith("/classes") else {}),
    }
    for name, value in named.items():
        asked = asked.replace("{" + name + "}", value)
    return asked + urllib.parse.quote(query, safe="?=&")


def reads_with_tags(server):
    """Returns the addresses of all reads in the contract that list 304, below /api/v1."""
    paths = [
        path
        for path, item in server.contract.document["paths"].items()
        if path.startswith("/api/")
        and "304" in item.get("get", {}).get("responses", {})
        and path not in LEFT_OUT
    ]
    found = {path.removeprefix("/api/v1"): address(path) for path in paths}
    assert len(found) > 50 and not any("{" in each for each in found.values()), found
    return found


def once_more(server, asked, tag, **more):
    return server.get(asked, headers={"If-None-Match": tag, **more})


def check_all(server, reads):
    """Checks that a second request returns 304 with the same tag, for each form of the header."""
    known = {}
    for path, asked in reads.items():
        first = server.get(asked)
        assert first.status == 200 and first.headers["ETag"], (path, first)
        if path.startswith("/me/sessions"):  # the response contains the time of its own last use
            continue
        known[asked] = (first.headers["ETag"], first.body)
        tag = first.headers["ETag"]
        for named in (tag, "W/" + tag, f'"x", {tag}', "*"):
            again = once_more(server, asked, named)
            assert again.status == 304 and again.body == b"" and again.headers["ETag"] == tag, (
                path,
                named,
                again,
                again.headers.items(),
            )
        head = server.request("HEAD", asked, headers={"If-None-Match": tag})
        assert head.status == 304 and head.headers["ETag"] == tag, (path, head)
        for other in ('"x"', "x", "", '"x", "y"', tag[:-1]):
            assert once_more(server, asked, other).status == 200, (path, other)
    return known


def check_change(server, known, what, must_change):
    """Checks that a 304 is correct, and that a changed response is sent completely."""
    anew = set()
    for asked, (tag, body) in known.items():
        again = once_more(server, asked, tag)
        if again.status == 304:
            assert server.get(asked).body == body, f"{what}: {asked} is told to be as it was"
        elif again.status == 200:
            anew.add(asked)
            known[asked] = (again.headers["ETag"], again.body)
        else:
            raise AssertionError((what, asked, again))
    missing = {each for each in must_change if each not in anew}
    assert not missing, f"{what} changes {missing}"
    return anew


@pytest.fixture(scope="module")
def camera(server):
    return make_site(server)


@pytest.fixture(scope="module")
def known(server, camera):
    """Returns the tag of each read in the contract. A second read returns 304."""
    return check_all(server, reads_with_tags(server))


def test_each_read_has_a_tag_that_is_good_once_more(known):
    assert known


def test_changes(server, known, camera):
    layer = M + "/layers/finds"
    texels = {
        layer + "/" + part
        for part in ("statistics", "quantities", "texels.csv", "texels.npy", "records", "edits")
    }
    texels |= {M + "/vertices.ply", M + "/views/west/picture", T + "/areas", T + "/quantities"}
    texels.add(f"/projects/default/objects/{OF_PATH['object']}/statistics?layer=finds")
    fill(server, 2)
    anew = check_change(server, known, "painting", texels)
    assert (
        not {T, M + "/looks", M + "/looks/plain/picture", "/tools", T + "/records", T + "/columns"}
        & anew
    ), anew
    server.ok("PATCH", T + "/records/2", {"values": {"name": TEXT}})
    anew = check_change(
        server,
        known,
        "a record",
        {
            T + "/records",
            layer + "/records",
            T + "/edits",
            layer + "/quantities",
            T + "/quantities",
        },
    )
    assert not {M + "/looks/plain/picture", M + "/comments", M + "/views"} & anew, anew
    server.ok(
        "PATCH",
        layer,
        {
            "palette": {
                "mode": "step",
                "points": [{"at": 0, "color": "#000000ff"}, {"at": 2, "color": "#ff0000ff"}],
            },
            "name": "Things",
        },
    )
    check_change(server, known, "a palette", {layer, M + "/layers", M + "/views/west/picture"})
    server.ok("PATCH", M + "/views/west", {"camera": {**camera, "width": camera["width"] // 2}})
    check_change(
        server, known, "a view", {M + "/views/west/picture", M + "/views", M + "/views/west"}
    )
    server.ok("POST", "/tables/damage/records", {"values": {"code": "crack", "label": "Crack"}})
    check_change(server, known, "a term", {"/tables/damage/terms"})
    server.ok("PATCH", M + "/looks/plain", {"name": "Plain colour"})
    check_change(server, known, "a look", {M + "/looks"})
    server.ok("POST", M + "/comments", {"text": "More.", "position": [30, 30, 0]})
    check_change(server, known, "a comment", {M + "/comments"})
    server.ok("PATCH", M, {"unit": "cm"})
    check_change(
        server, known, "the unit", {M, M + "/layers/finds/statistics", M + "/vertices.ply"}
    )
    server.ok("POST", layer + "/undo")
    check_change(server, known, "undo", texels)


def test_past(server):
    """Earlier states do not change while others paint."""
    layer = M + "/layers/finds"
    now = int(server.get(layer + "/statistics").headers["Strata-Sequence"])
    past, present = (server.get(f"{layer}/statistics?at={at}") for at in (now - 1, now))
    fill(server, 1)
    for answer, at in ((past, now - 1), (present, now)):
        again = once_more(server, f"{layer}/statistics?at={at}", answer.headers["ETag"])
        assert again.status == 304, (at, again)
    assert (
        once_more(server, layer + "/statistics", present.headers["ETag"]).status == 200
    ), "another question has another tag"


def test_who_asks(server):
    """A tag is valid for one user only. Visibility is part of the tag."""
    ada = server.add_person("eve", "viewer")
    asked = M + "/layers/finds/quantities"
    tag = server.get(asked).headers["ETag"]
    own = server.get(asked, token=ada)
    assert own.headers["ETag"] != tag and once_more(server, asked, tag).status == 304
    server.ok("PATCH", M + "/layers/finds", {"visibility": "private"})
    again = server.get(asked, token=ada, headers={"If-None-Match": own.headers["ETag"]})
    assert again.status == 404, again
    server.ok("PATCH", M + "/layers/finds", {"visibility": "public"})


def test_formats_and_codings(server):
    """A sheet and the JSON have different tags. Each encoding is a separate representation, and 304
    contains its tag."""
    asked = T + "/records"
    tags = {
        accept: server.get(asked, headers={"Accept": accept}).headers["ETag"]
        for accept in ("application/json", "text/csv")
    }
    assert len(set(tags.values())) == 2, tags
    answer = once_more(server, asked, tags["application/json"], Accept="text/csv")
    assert answer.status == 200 and answer.headers["Content-Type"].startswith("text/csv"), answer
    for coding in ("gzip", "br"):
        for each in (asked, M + "/layers/finds/statistics", "/openapi.json"):
            first = server.get(each, headers={"Accept-Encoding": coding})
            again = once_more(server, each, first.headers["ETag"], **{"Accept-Encoding": coding})
            assert again.status == 304 and again.headers["ETag"] == first.headers["ETag"], (
                each,
                coding,
                first.headers.items(),
                again.headers.items(),
            )
            assert "Accept-Encoding" in ", ".join(
                again.headers.get_all("Vary")
            ), again.headers.items()
    assert first.headers["Content-Encoding"] == "br" and first.headers["ETag"].endswith(
        '-br"'
    ), first.headers.items()


def test_left_alone(server):
    """Responses with the server's health or with secrets must not be cached."""
    for path in ("//livez", "//readyz", "//metrics"):
        answer = server.get(path, token=False)
        assert (
            answer.status == 200
            and answer.headers["ETag"] is None
            and answer.headers["Cache-Control"] == "no-store"
        ), answer.headers.items()
    view = server.get("/me/models/sheet/view")
    assert (
        view.headers["ETag"] is None and view.headers["Cache-Control"] == "no-store"
    ), view.headers.items()
    refused = server.get("/models/none", headers={"If-None-Match": "*"})
    assert refused.status == 404 and refused.headers["ETag"] is None, refused


def test_a_tag_is_good_until_a_restart(server):
    """After a restart the server may use another database, so earlier tags are not valid."""
    asked = M + "/layers/finds/statistics"
    tag = server.get(asked).headers["ETag"]
    assert server.stop() == 0
    server.start()
    assert once_more(server, asked, tag).status == 200


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
