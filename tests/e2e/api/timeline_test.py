"""The history of a model: the timeline, its steps, the difference between two states, restoring a
part, and live views of the past."""
import time
import uuid

import pytest
from support.cameras import camera_from
from support.live_client import LAST_RECTANGLE, LiveClient
from support.meshes import folded_grid

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
L = M + "/layers/cracks"
EDITS = 100_000


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    for name in ("Cracks", "Salts", "Secret"):
        server.ok("POST", M + "/layers", {"name": name, "type": "u8"})
    server.ok("PATCH", M + "/layers/secret", {"visibility": "private"})
    return server


@pytest.fixture(scope="module")
def people(server):
    return {
        name: server.add_person(name, role)
        for name, role in (("ada", "annotator"), ("ben", "annotator"), ("vera", "viewer"))
    }


@pytest.fixture(scope="module")
def camera(server):
    return camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))


@pytest.fixture(scope="module")
def painted(server, people, camera):
    """Returns the responses to two strokes by Ada, one by Ben, one on a private layer, and one
    fill."""

    def stroke(layer, x, value, token):
        body = {
            "op": "stroke",
            "value": value,
            "camera": camera,
            "radius_px": 20,
            "path": [[x, 240]],
        }
        return server.ok("POST", f"{M}/layers/{layer}/edits", body, token=token).json()

    return [
        stroke("cracks", 250, 1, people["ada"]),
        stroke("cracks", 280, 2, people["ada"]),
        stroke("salts", 300, 3, people["ben"]),
        stroke("secret", 300, 4, True),
        stroke("cracks", 260, 5, people["ben"]),
    ]


def steps(server, query="", token=True):
    return server.ok("GET", f"{M}/timeline/steps{query}", token=token).json()


def lasts(answer):
    return [step["last"] for step in answer["steps"]]


def test_the_timeline_counts_what_the_caller_sees(server, people, painted):
    sequences = [answer["sequence"] for answer in painted]
    for token, seen in ((True, 5), (people["vera"], 4)):
        timeline = server.ok("GET", M + "/timeline?intervals=500", token=token).json()
        assert timeline["newest"] == sequences[-1] and timeline["edits"] == seen, timeline
        intervals = timeline["intervals"]
        assert sum(each["edits"] for each in intervals) == seen
        assert intervals[0]["first"] == sequences[0] and intervals[-1]["last"] == sequences[-1]
        assert [each["number"] for each in intervals] == sorted(
            {each["number"] for each in intervals}
        )
        assert all(timeline["from"] <= each["begun"] <= timeline["to"] for each in intervals)
    whole = server.ok("GET", M + "/timeline?intervals=1", token=people["vera"]).json()
    (one,) = whole["intervals"]
    assert one["number"] == 0 and one["edits"] == 4 and one["others"] == 0, one
    assert {(each["user"], each["edits"]) for each in one["people"]} == {("ada", 2), ("ben", 2)}
    assert all(each["color"].startswith("#") for each in one["people"])
    cracks, salts = (server.get(f"{M}/layers/{slug}").json()["id"] for slug in ("cracks", "salts"))
    assert one["layers"] == [cracks, salts]

    # The interval ends with the second stroke. The page finds the state of a time in the same way.
    second = steps(server)["steps"][1]
    until = server.ok("GET", f"{M}/timeline?intervals=1&to={second['time']}").json()
    assert until["intervals"][-1]["last"] >= second["last"], until
    before = server.ok("GET", M + "/timeline?to=2001-01-01T00:00:00Z").json()
    assert before["edits"] == 0 and before["intervals"] == [], before

    for query, field in (
        ("intervals=0", "intervals"),
        ("intervals=501", "intervals"),
        ("intervals=x", "intervals"),
        ("from=yesterday", "from"),
        ("from=2026-05-05T00:00:00Z&to=2026-05-04T00:00:00Z", "to"),
    ):
        refused = server.request("GET", f"{M}/timeline?{query}")
        assert refused.status == 422, refused
        assert refused.json()["field"] == field, refused


def test_steps_are_listed_around_a_sequence(server, people, painted):
    sequences = [answer["sequence"] for answer in painted]
    assert lasts(steps(server)) == sequences
    seen = [sequences[i] for i in (0, 1, 2, 4)]  # without the stroke on the private layer
    assert lasts(steps(server, token=people["vera"])) == seen
    assert lasts(steps(server, f"?before={seen[2]}&limit=2", people["vera"])) == seen[1:3]
    after = steps(server, f"?after={seen[0]}&limit=2", people["vera"])
    assert lasts(after) == seen[1:3] and after["more"] is True
    end = steps(server, f"?after={seen[1]}&limit=2", people["vera"])
    assert lasts(end) == seen[2:] and end["more"] is False
    first = steps(server)["steps"][0]
    assert first["user"] == "ada" and first["op"] == "stroke", first
    assert first["texels_changed"] == painted[0]["texels_changed"]
    both = server.request("GET", f"{M}/timeline/steps?before=1&after=1")
    assert both.status == 422 and both.json()["field"] == "after", both


def test_the_batches_of_a_stroke_are_one_step(server, people, camera):
    before = server.get(M).json()["sequence"]
    with LiveClient(server, "sheet", token=people["ada"]) as live:
        live.hello()
        stroke = str(uuid.uuid4())
        live.send(
            {
                "op": "stroke.begin",
                "id": str(uuid.uuid4()),
                "stroke": stroke,
                "layer": "salts",
                "value": 1,
                "camera": camera,
                "radius_px": 5,
            }
        )
        for n in range(3):
            live.send(
                {
                    "op": "stroke.extend",
                    "id": str(uuid.uuid4()),
                    "stroke": stroke,
                    "n": n,
                    "path": [[300 + 10 * n, 200]],
                }
            )
        for _ in range(3):
            live.receive_until("saved")
    (step,) = steps(server, f"?after={before}")["steps"]
    assert (step["first"], step["last"]) == (before + 1, before + 3), step
    assert step["stroke"] == stroke
    counted = server.ok("GET", M + "/timeline?intervals=1").json()["edits"]
    assert counted == len(steps(server)["steps"]), "the timeline counts a stroke once"


def test_the_own_steps_are_what_undo_and_redo_change(server, people, painted):
    def listed(query="", token=people["ada"]):
        return server.ok("GET", M + "/undo" + query, token=token).json()

    def lasts_of(steps):
        return [step["last"] for step in steps]

    sequences = [answer["sequence"] for answer in painted]
    before = listed()
    assert lasts_of(before["done"])[-2:] == [sequences[1], sequences[0]], before
    newest = before["done"][-2]
    assert newest["op"] == "stroke" and newest["value"] == 2 and newest["area_m2"] > 0, newest
    assert newest["texels_changed"] == painted[1]["texels_changed"]
    assert before["undone"] == [] and before["more"] is False
    assert listed(token=people["vera"])["done"] == []
    one = listed("?limit=1")
    assert len(one["done"]) == 1 and one["more"] is True
    # goes back over two steps of this layer, in the order of the list
    cracks = server.get(L).json()["id"]
    of_layer = [step for step in before["done"] if step["layer"] == cracks]
    for _ in of_layer[:2]:
        server.ok("POST", L + "/undo", token=people["ada"])
    after = listed()
    assert lasts_of(after["undone"]) == lasts_of(of_layer[1::-1]), after
    assert lasts_of(after["done"]) == [
        last for last in lasts_of(before["done"]) if last not in lasts_of(of_layer[:2])
    ]
    for _ in of_layer[:2]:
        server.ok("POST", L + "/redo", token=people["ada"])
    assert listed() == before
    assert server.request("GET", M + "/undo?limit=0").status == 422


def test_a_restore_of_a_part_changes_what_the_difference_counts(server, people, painted, camera):
    then = painted[1]["sequence"]
    left = {"camera": camera, "path": [[0, 0], [258, 0], [258, 480], [0, 480]]}
    whole = server.ok("POST", L + "/difference", {"from": then}, token=people["vera"]).json()
    part = server.ok("POST", L + "/difference", {"from": then, "within": left}).json()
    assert 0 < part["texels"] < whole["texels"] and part["from"] == then, (part, whole)
    assert whole["to"] == server.get(M).json()["sequence"]
    restore = {"sequence": then, "within": left}
    assert server.request("POST", L + "/restore", restore, token=people["vera"]).status == 403
    done = server.ok("POST", L + "/restore", restore, token=people["ada"]).json()
    assert done["texels_changed"] == part["texels"], (done, part)
    rest = server.ok("POST", L + "/difference", {"from": then}).json()
    assert rest["texels"] == whole["texels"] - part["texels"], rest
    server.ok("POST", L + "/undo", token=people["ada"])
    assert server.ok("POST", L + "/difference", {"from": then}).json()["texels"] == whole["texels"]

    for body, field in (
        ({"from": 10**9}, "from"),
        ({"from": then, "to": 10**9}, "to"),
        ({"from": "yesterday"}, "from"),
        ({"to": then}, "from"),
        ({"from": then, "within": {"camera": camera, "path": [[0, 0], [1, 1]]}}, "within.path"),
    ):
        refused = server.request("POST", L + "/difference", body)
        assert refused.status == 422 and refused.json()["field"] == field, refused
    hidden = server.request(
        "POST", M + "/layers/secret/difference", {"from": 0}, token=people["vera"]
    )
    assert hidden.status == 404, hidden


def test_a_selection_finds_what_changed_between_two_states(server, people, painted, camera):
    then = painted[1]["sequence"]
    one = {"changed": {"from": then, "layers": ["cracks"]}}

    def select(body, token=people["vera"]):
        return server.ok("POST", M + "/select", body, token=token).json()

    found = select(one)
    counted = server.ok("POST", L + "/difference", {"from": then}).json()
    assert 0 < found["texels"] == counted["texels"], (found, counted)
    assert found["area_m2"] == pytest.approx(counted["area_m2"])
    # the difference has the same texels in either direction, and no texels between equal states
    newest = server.get(M).json()["sequence"]
    back = {"changed": {"from": newest, "to": then, "layers": ["cracks"]}}
    assert select(back)["texels"] == found["texels"]
    assert select({"changed": {"from": newest}})["texels"] == 0
    # an area and a condition limit the difference to their inside
    left = {"camera": camera, "path": [[0, 0], [258, 0], [258, 480], [0, 480]]}
    part = server.ok("POST", L + "/difference", {"from": then, "within": left}).json()
    assert select({**one, "within": left})["texels"] == part["texels"] < found["texels"]
    assert select({**one, "where": "false"})["texels"] == 0
    # all layers that the caller can see
    everything = {"changed": {"from": 0}}
    assert select(everything)["texels"] > found["texels"]
    picture = {"camera": camera, "width": 64, "height": 48}
    assert select({**one, "picture": picture})["picture"].startswith("iVBOR")
    # another resolution gives approximately the same surface area
    server.ok("POST", M + "/layers", {"name": "Fine", "type": "u8", "resolution": 4096})
    fine = select({"changed": {"from": then, "layers": ["cracks", "fine"]}})
    assert fine["resolution"] == 4096 and fine["area_m2"] == pytest.approx(
        found["area_m2"], rel=0.02
    ), fine
    server.ok("DELETE", M + "/layers/fine")

    for changed, field in (
        ({"from": 10**9}, "changed.from"),
        ({"from": then, "to": "yesterday"}, "changed.to"),
        ({"to": then}, "changed.from"),
        ({"from": then, "layers": ["nothing"]}, "changed.layers"),
        ({"from": then, "layers": []}, "changed.layers"),
    ):
        answer = server.request("POST", M + "/select", {"changed": changed})
        assert answer.status in (404, 422) and answer.json()["field"] == field, answer
    secret = {"changed": {"from": 0, "layers": ["secret"]}}
    assert select(secret, True)["texels"] > 0
    assert server.request("POST", M + "/select", secret, token=people["vera"]).status in (404, 422)
    into = {**one, "where": "true", "into": {"layer": "cracks", "value": 2}}
    assert server.request("POST", M + "/select", into).json()["field"] == "into"


def test_a_live_view_shows_the_past_and_refuses_paint(server, people, painted, camera):
    then = painted[0]["sequence"]

    def wait_for_frame(live, sequence):
        while True:
            frame = live.receive_until("frame")
            if frame["flags"] & LAST_RECTANGLE:
                live.send({"op": "ack", "view_id": frame["view_id"], "frame": frame["frame"]})
                if frame["scene_sequence"] == sequence:
                    return

    fill = {"op": "fill", "value": 1, "mode": "where", "where": "valid(cracks)"}
    with LiveClient(server, "sheet", token=people["ada"]) as live:
        live.hello()
        live.send({"op": "camera", "seq": 1, **camera})
        live.send({"op": "layers", "layers": [], "at": then})
        wait_for_frame(live, then)
        edit = {"op": "edit", "id": str(uuid.uuid4()), "layer": "cracks", "edit": fill}
        live.send(edit)
        refused = live.receive_until("problem")
        assert refused["status"] == 409 and refused["ref"] == edit["id"], refused
        live.send({"op": "layers", "layers": [], "at": 10**9})
        refused = live.receive_until("problem")
        assert refused["status"] == 422 and refused["field"] == "at", refused
        live.send({"op": "layers", "layers": []})
        wait_for_frame(live, server.get(M).json()["sequence"])
        live.send(edit)
        assert live.receive_until("saved")["id"] == edit["id"]


def test_a_long_history_is_counted_in_the_index(server, painted):
    """With many edits, the timeline reads no row of the journal."""
    model = server.get(M).json()["id"]
    layer = server.get(L).json()["id"]
    newest = server.get(M).json()["sequence"]
    server.sql(
        "INSERT INTO edits (model_id, sequence, id, layer_id, stroke, user_name, op, record, answer, time) "
        f"SELECT {model}, {newest} + n, gen_random_uuid(), {layer}, gen_random_uuid(), 'ada', 'stroke', "
        "jsonb_build_object('path', repeat('x', 1000)), '{}', now() - interval '300 days' + n * interval '4 minutes' "
        f"FROM generate_series(1, {EDITS}) n"
    )
    server.sql("VACUUM ANALYZE edits")
    begun = time.monotonic()
    timeline = server.ok("GET", M + "/timeline?intervals=240").json()
    took = time.monotonic() - begun
    assert timeline["edits"] >= EDITS and len(timeline["intervals"]) <= 240
    print(f"timeline of {EDITS} edits: {took * 1000:.0f} ms")
    plan = server.sql(
        "EXPLAIN SELECT time, sequence, layer_id, user_name, stroke FROM edits "
        f"WHERE model_id = {model} AND layer_id = any('{{{layer}}}') AND time >= '-infinity'"
    )
    assert "Index Only Scan using edits_timeline" in str(plan), plan
    server.sql(f"DELETE FROM edits WHERE model_id = {model} AND sequence > {newest}")
