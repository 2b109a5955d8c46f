"""The data of one user, over HTTP and live: the user's own view of a model's layers, the name and
the color. The file also tests computed layers, which are locked until a curator unlocks them for
edits by hand."""
import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid
from support.pictures import pixels
from support.strata_server import wait_for
from support.workbook import Workbook

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
V = "/me/models/sheet/view"
CSV = {"Content-Type": "text/csv"}


def fill(server, layer, value=1, where="true", **more):
    return server.request(
        "POST",
        f"{M}/layers/{layer}/edits",
        {"op": "fill", "mode": "where", "where": where, "value": value},
        **more,
    )


def shown(server, token, path=V):
    return server.ok("GET", path, token=token).json()["layers"]


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    return server


def test_personal_views(server):
    ada, vera, carl = (
        server.add_person(*each)
        for each in (("ada", "annotator"), ("vera", "viewer"), ("carl", "curator"))
    )
    ids = {}
    for name in ("cracks", "salts", "secret"):
        ids[name] = server.ok(
            "POST",
            M + "/layers",
            {
                "name": name.title(),
                "resolution": 2048,
                "visibility": "private" if name == "secret" else "public",
            },
        ).json()["id"]
    assert shown(server, ada) == []
    palette = {"mode": "categorical", "points": [{"at": 1, "color": "#112233"}]}
    kept = server.ok(
        "PUT",
        V,
        {
            "layers": [
                {"layer": "cracks", "visible": False, "order": 7},
                {"layer": ids["salts"], "opacity": 0.25, "palette": palette},
            ]
        },
        token=ada,
    ).json()
    assert kept["layers"][0] == {"layer": ids["cracks"], "visible": False, "order": 7}, kept
    assert kept["layers"][1]["opacity"] == 0.25 and kept["layers"][1]["palette"]["points"][0][
        "color"
    ].startswith("#112233"), kept
    # Ada has this view in every browser, and no other user has it.
    with LiveClient(server, model="sheet", token=ada) as live:
        assert live.hello()["personal_view"] == kept
    assert (
        shown(server, vera) == []
        and server.ok("GET", M + "/layers/cracks").json()["visible"] is True
    )
    assert server.ok("GET", M + "/layers/cracks").json()["order"] == 0
    with LiveClient(server, model="sheet", token=vera) as live:
        assert live.hello()["personal_view"] == {"layers": []}
    # Viewers also have a personal view. A request cannot name layers that the user cannot see.
    # Layers that become invisible are omitted.
    server.ok("PUT", V, {"layers": [{"layer": "salts", "visible": False}]}, token=vera)
    refused = server.request(
        "PUT", V, {"layers": [{"layer": "secret", "visible": True}]}, token=vera
    )
    assert refused.status in (404, 422) and refused.json()["field"] == "layers[0].layer", refused
    server.ok("PUT", V, {"layers": [{"layer": "secret", "visible": False}]}, token=carl)
    assert shown(server, carl) == [{"layer": ids["secret"], "visible": False}]
    server.ok("PATCH", M + "/layers/salts", {"visibility": "private"})
    assert shown(server, vera) == [] and [each["layer"] for each in shown(server, ada)] == [
        ids["cracks"]
    ]
    server.ok("PATCH", M + "/layers/salts", {"visibility": "public"})
    server.ok("DELETE", M + "/layers/salts")
    assert shown(server, vera) == [] and [each["layer"] for each in shown(server, ada)] == [
        ids["cracks"]
    ]
    # unknown members and values, and a request without content
    for body in (
        {"layers": [{"layer": "cracks", "highlight": {"keys": [1]}}]},
        {"layers": [{"layer": "none"}]},
        {"layers": [{"layer": "cracks", "opacity": 2}]},
        {},
        {"layers": [{"layer": "cracks", "order": 10**7}]},
    ):
        answer = server.request("PUT", V, body, token=ada)
        assert 400 <= answer.status < 500, (body, answer)
    many = [
        {
            "layer": "cracks",
            "palette": {
                "mode": "categorical",
                "points": [{"at": n, "color": "#112233", "label": "x" * 190} for n in range(250)],
            },
        }
        for _ in range(20)
    ]
    assert server.request("PUT", V, {"layers": many}, token=ada).status == 413
    assert (
        server.request("GET", V, token=False).status == 401
        and server.request("GET", "/me/models/none/view", token=ada).status == 404
    )
    server.ok("DELETE", V, token=ada)
    assert shown(server, ada) == []
    server.ok("PUT", V, {"layers": [{"layer": "cracks", "visible": False}]}, token=ada)
    before = int(server.sql("SELECT count(*) FROM personal_views"))
    server.ok("DELETE", "/users/ada")
    assert (
        int(server.sql("SELECT count(*) FROM personal_views")) == before - 1
    ), "what a person kept goes with them"
    print("personal views: ok", flush=True)


def test_order_in_pictures(server):
    """Frames use the user's own order. If the user's order swaps two opaque layers, the other one
    is visible."""
    for name, color in (("under", "#ff0000"), ("over", "#0000ff")):
        server.ok(
            "POST",
            M + "/layers",
            {
                "name": name,
                "resolution": 2048,
                "palette": {"mode": "categorical", "points": [{"at": 1, "color": color}]},
            },
        )
        assert fill(server, name).status == 200

    camera = camera_from(server.ok("GET", M).json(), (0, 0, -1), 64, 64, up=(0, 1, 0))

    def middle(name, layers):
        view = {"name": name, "camera": camera, "layers": layers, "light": {"mode": "unlit"}}
        slug = server.ok("POST", M + "/views", view).json()["slug"]
        return pixels(server.ok("GET", f"{M}/views/{slug}/picture?format=png").body)[32][32]

    assert middle("As it is", []) == (0, 0, 255)
    assert middle("Turned round", [{"layer": "under", "order": 1000}]) == (255, 0, 0)
    with LiveClient(server, model="sheet") as live:
        live.hello()
        live.send({"op": "layers", "view_id": 0, "layers": [{"layer": "under", "order": 1000}]})
        live.send({"op": "camera", "view_id": 0, "seq": 1, **camera, "moving": False})
        live.receive_until("frame")
    for name in ("under", "over"):
        server.ok("DELETE", f"{M}/layers/{name}")
    print("order: ok", flush=True)


def test_computed(server):
    ada, carl = server.add_person("adam", "annotator"), server.add_person("cleo", "curator")
    server.ok("POST", M + "/layers", {"name": "Wet", "type": "f32", "resolution": 2048})
    lowest = min(each["order"] for each in server.get(M + "/layers").json()["layers"])
    assert fill(server, "wet", 0.75, "x < 50").status == 200
    made = server.ok(
        "POST",
        M + "/layers",
        {"name": "Twice", "expression": "wet * 2", "resolution": 2048},
        token=carl,
    ).json()
    assert (made["computed"], made["edited_by_hand"], made["locked"], made["visible"]) == (
        "expression",
        False,
        True,
        False,
    ), made
    assert made["order"] == lowest - 1, made
    assert shown(server, carl)[-1] == {
        "layer": made["id"],
        "visible": True,
    }, "whoever made it sees it"
    job = server.wait_for_job(
        server.ok(
            "POST",
            M + "/layers",
            {"name": "Height", "compute": {"kind": "height"}, "resolution": 2048},
        ).json()["id"]
    )
    height = server.ok("GET", f"{M}/layers/{job['layers'][0]}").json()
    assert (height["computed"], height["locked"], height["visible"], height["order"]) == (
        "shape",
        True,
        False,
        lowest - 2,
    ), height

    # users with any role cannot edit the layers by hand
    for layer, name in (("twice", "Twice"), ("height", "Height")):
        for token in (True, carl, ada):
            for answer in (
                fill(server, layer, 5, token=token),
                server.request("POST", f"{M}/layers/{layer}/undo", token=token),
            ):
                assert answer.status == 403 and (
                    answer.json()["title"],
                    answer.json()["field"],
                ) == ("Layer is locked", "layer"), answer
                assert "its values were computed" in answer.json()["detail"], answer
    # the computation still changes the layer
    assert fill(server, "wet", 0.5, "x < 50").status == 200
    assert server.ok("POST", M + "/layers/twice/compute", token=carl).json()["locked"] is True
    assert server.get(M + "/layers/twice/statistics").json()["max"] == 1
    refused = server.request(
        "POST", M + "/layers", {"name": "Open", "expression": "wet", "locked": False}
    )
    assert refused.status == 422 and refused.json()["field"] == "locked", refused
    assert server.request("PATCH", M + "/layers/twice", {"locked": False}, token=ada).status == 403

    # an unlocked layer can be edited by hand; it records the edit and is not computed again
    server.ok("PATCH", M + "/layers/twice", {"recompute": "automatic"}, token=carl)
    open_ = server.ok("PATCH", M + "/layers/twice", {"locked": False}, token=carl).json()
    assert (open_["locked"], open_["edited_by_hand"], open_["computed"]) == (
        False,
        True,
        "expression",
    ), open_
    assert fill(server, "twice", 9, "y < 50", token=ada).status == 200
    assert fill(server, "wet", 0.25, "x < 50").status == 200
    answer = server.request("POST", M + "/layers/twice/compute", token=carl)
    assert answer.status == 409 and "overwrite" in answer.json()["detail"], answer
    assert (
        server.request("POST", M + "/layers/twice/compute?overwrite=true", token=ada).status == 403
    )
    # another automatic layer is computed later, which shows that the server skipped this one
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Thrice", "expression": "wet * 3", "recompute": "automatic", "resolution": 2048},
    )
    assert fill(server, "wet", 0.125, "x < 50").status == 200
    wait_for(
        lambda: server.get(M + "/layers/thrice/statistics").json()["max"] == 0.375,
        "another layer to follow by itself",
    )
    assert server.get(M + "/layers/twice/statistics").json()["max"] == 9
    assert (
        server.ok("PATCH", M + "/layers/twice", {"locked": True}, token=carl).json()[
            "edited_by_hand"
        ]
        is True
    )
    again = server.ok("POST", M + "/layers/twice/compute?overwrite=true", token=carl).json()
    assert (again["locked"], again["edited_by_hand"]) == (True, False), again
    assert server.get(M + "/layers/twice/statistics").json()["max"] == 0.25
    hand = server.ok("PATCH", M + "/layers/height", {"locked": False}).json()
    assert hand["edited_by_hand"] is True and fill(server, "height", 1).status == 200
    plain = server.ok("PATCH", M + "/layers/twice", {"expression": ""}).json()
    assert (plain["computed"], plain["edited_by_hand"], plain["locked"]) == (
        "expression",
        True,
        False,
    ) and "expression" not in plain, plain
    assert fill(server, "twice", 3, token=ada).status == 200

    # A condition is painted where it is true, and nowhere else.
    risk = server.ok(
        "POST",
        M + "/layers",
        {"name": "Risk", "expression": "wet > 0.1 and y > 50", "resolution": 2048},
    ).json()
    assert risk["type"] == "u8" and [
        (each["at"], each["label"]) for each in risk["palette"]["points"]
    ] == [(1, "Risk")], risk
    statistics = server.get(M + "/layers/risk/statistics").json()
    assert (statistics["min"], statistics["max"]) == (1, 1) and abs(
        statistics["area_m2"] / 2500e-6 - 1
    ) < 0.02, statistics
    print("computed layers: ok", flush=True)


def test_people(server):
    """A user has the same color and name in every response."""
    ida, rob = server.add_person("ida", "curator"), server.add_person("rob", "annotator")
    server.ok("PATCH", "/users/ida", {"full_name": "Ida Roe"})
    me = server.ok("GET", "/me", token=ida).json()
    assert me["color"] != server.ok("GET", "/me", token=rob).json()["color"]
    seen = {("Ida Roe", me["color"])}
    named = lambda each: (each.get("full_name"), each["color"])
    people = {
        each["user"]: each for each in server.ok("GET", "/projects/default/people").json()["people"]
    }
    assert (
        named(people["ida"]) in seen
        and named(
            {
                **next(
                    each
                    for each in server.ok("GET", "/users").json()["users"]
                    if each["user"] == "ida"
                )
            }
        )
        in seen
    )
    with LiveClient(server, model="sheet", token=ida) as first, LiveClient(
        server, model="sheet", token=ida
    ) as second, LiveClient(server, model="sheet", token=rob) as other:
        for live in (first, second, other):
            live.hello()
        message = other.receive_until("presence")
        while len(message["users"]) < 3:
            message = other.receive_until("presence")
        assert {named(each) for each in message["users"] if each["name"] == "ida"} == seen, message
        comment = server.ok(
            "POST", M + "/comments", {"position": [50, 50, 0], "text": "Is this fresh?"}, token=ida
        ).json()
        assert named(comment) in seen, comment
        told = other.receive_until("comment")
        assert named(told["comment"]) in seen, told
    server.ok("POST", f"/comments/{comment['id']}/replies", {"text": "No."}, token=rob)
    solved = server.ok(
        "PATCH", f"/comments/{comment['id']}", {"state": "resolved"}, token=ida
    ).json()
    assert named(solved["resolved"]) in seen, solved
    listed = {
        each["user"]: named(each) for each in server.ok("GET", M + "/comments").json()["comments"]
    }
    assert listed["ida"] in seen and listed["rob"][0] is None, listed
    assert all(
        named(each) in seen
        for each in server.ok("GET", "/projects/default/activity").json()["activity"]
        if each.get("user") == "ida"
    )
    server.ok("POST", M + "/layers", {"name": "Checked", "review": True, "resolution": 2048})
    assert fill(server, "checked", token=rob).status == 200
    server.ok("PATCH", "/users/rob", {"full_name": "Rob Ost"})
    queue = server.ok("GET", M + "/layers/checked/review", token=ida).json()
    color = server.ok("GET", "/me", token=rob).json()["color"]
    assert {named(each) for each in queue["strokes"] + queue["people"]} == {
        ("Rob Ost", color)
    }, queue
    server.ok("DELETE", f"{M}/layers/checked", token=ida)
    assert named(server.ok("GET", "/projects/default/bin").json()["entries"][0]) in seen
    print("people: ok", flush=True)


STONE = """code,parent,label,label-de
z-loss,,Loss,Verlust
a-worn,z-loss,Worn,Abrieb
b-other,z-loss,Other,Anderes
y-deposit,,Deposit,Auflage
a-salt,y-deposit,=Salts,Salze
c-other,y-deposit,Other,Sonstiges
"""


def test_words(server):
    server.ok("POST", "/projects/default/terms?name=Stone", STONE.encode(), headers=CSV)
    terms = {
        each["code"]: each["key"]
        for each in server.ok("GET", "/tables/stone/terms").json()["terms"]
    }
    columns = [
        {"name": "Note"},
        {"name": "Damage", "kind": "term", "target": "stone"},
        {"name": "Wet", "kind": "boolean"},
    ]
    table = server.ok(
        "POST", "/projects/default/tables", {"name": "Finds", "columns": columns}
    ).json()
    by_slug = {each["slug"]: each["id"] for each in table["columns"]}
    for note, code in (
        ("Zebra", "a-salt"),
        ("äther", "b-other"),
        ("Apfel", "z-loss"),
        ("banane", "c-other"),
        ("Öl", "a-worn"),
    ):
        server.ok(
            "POST", "/tables/finds/records", {"values": {"note": note, "damage": terms[code]}}
        )
    order = lambda query: [
        each["values"]["note"]
        for each in server.ok("GET", f"/tables/finds/records?{query}").json()["records"]
    ]
    # terms are sorted by the tree, and texts by the alphabet of a language
    assert order("sortby=damage") == ["Apfel", "Öl", "äther", "Zebra", "banane"], order(
        "sortby=damage"
    )
    assert order("sortby=-damage") == ["banane", "Zebra", "äther", "Öl", "Apfel"]
    assert order("sortby=note&lang=de") == ["Apfel", "äther", "banane", "Öl", "Zebra"], order(
        "sortby=note&lang=de"
    )
    assert order("sortby=note&lang=sv") == [
        "Apfel",
        "banane",
        "Zebra",
        "äther",
        "Öl",
    ], "in Swedish these letters follow z"
    assert (
        order("sortby=note&lang=xx-unknown")
        == order("sortby=note")
        == ["Apfel", "äther", "banane", "Öl", "Zebra"]
    )
    assert server.get("/tables/finds/records?sortby=note&lang=de%22%3B--").status == 200

    # Files contain labels. Terms with the same label appear with their codes. A second import of
    # the file changes nothing.
    for query in (
        "f=csv",
        "f=csv&lang=de",
        "f=csv&lang=xx&separator=semicolon",
        "f=csv&terms=keys",
    ):
        body = server.ok("GET", "/tables/finds/records?" + query).body
        report = server.ok("POST", "/tables/finds/records", body, headers=CSV).json()
        assert (report["unchanged"], report["changed"], report["created"]) == (5, 0, 0), (
            query,
            report,
            body,
        )
    rows = server.ok("GET", "/tables/finds/records?f=csv").body.decode("utf-8-sig").split("\r\n")
    assert (
        rows[1] == "1,Zebra,'=Salts,"
        and rows[2] == "2,äther,b-other,"
        and rows[3] == "3,Apfel,Loss,"
    ), rows
    assert ",Verlust," in server.ok("GET", "/tables/finds/records?f=csv&lang=de").body.decode()
    assert (
        server.ok("GET", "/tables/finds/records?f=csv&terms=keys")
        .body.decode("utf-8-sig")
        .split("\r\n")[3]
        == f"3,Apfel,{terms['z-loss']},"
    )
    assert server.get("/tables/finds/records?f=csv&terms=codes").status == 422
    assert Workbook(server.ok("GET", "/tables/finds/records?f=xlsx").body).rows[3][:3] == [
        3,
        "Apfel",
        "Loss",
    ]
    report = server.ok(
        "POST",
        "/tables/finds/records?dry_run=true",
        "key,damage\n1,Sonstiges\n2,Other\n3,Nothing\n4,y-deposit\n".encode(),
        headers=CSV,
    ).json()
    assert [(each["line"], each["title"]) for each in report["problems"]] == [
        (3, "Ambiguous name"),
        (4, "Record not found"),
    ], report

    # users choose the title column, which may contain terms
    assert "title_column" not in server.ok("GET", "/tables/finds").json()
    titled = server.ok("PATCH", "/tables/finds", {"title_column": "damage"}).json()
    assert (
        titled["title_column"]
        == by_slug["damage"]
        == server.ok("GET", "/tables/finds").json()["title_column"]
    )
    for wrong in ("wet", "none"):
        answer = server.request("PATCH", "/tables/finds", {"title_column": wrong})
        assert answer.status == 422 and answer.json()["field"] == "title_column", answer
    server.ok(
        "POST",
        "/projects/default/tables",
        {"name": "Boxes", "columns": [{"name": "Find", "kind": "term", "target": "finds"}]},
    )
    for key in (4, 1, 3):
        server.ok("POST", "/tables/boxes/records", {"values": {"find": key}})
    boxes = (
        server.ok("GET", "/tables/boxes/records?f=csv&sortby=find")
        .body.decode("utf-8-sig")
        .split("\r\n")
    )
    assert boxes[1:4] == ["3,Loss", "2,'=Salts", "1,4"], boxes
    server.ok("DELETE", "/tables/finds/columns/damage")
    assert "title_column" not in server.ok("GET", "/tables/finds").json()
    assert "title_column" not in server.ok("PATCH", "/tables/finds", {"title_column": ""}).json()
    print("words and titles: ok", flush=True)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
