"""Events of a model for scripts: the server sends an event once an edit is durable, and each reader
receives only visible content. A disconnected reader loses no event."""
import json

from support.event_reader import EventReader
from support.meshes import folded_grid
from support.strata_server import LONG_S

M = "/models/sheet"


def reader_of(server, token=True, after=None):
    return EventReader(server, M, token, after)


def painted(layer):
    return lambda event: event["data"].get("layer") == layer and event["data"]["kind"] == "edit"


def paint(server, name, where):
    server.ok(
        "POST",
        f"{M}/layers/{name}/edits",
        {"op": "fill", "mode": "where", "where": where, "value": 1},
    )


def test_what_is_done_is_told_once_it_is_durable(server, story):
    server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
    story.viewer = server.add_person("vera", "viewer")
    story.early = server.ok(
        "POST", M + "/layers", {"name": "Early", "type": "u8", "resolution": 2048}
    ).json()["id"]
    story.reader = reader_of(server).listening()
    story.of_viewer = reader_of(server, story.viewer).listening()
    story.ids = {}
    for name, more in (
        ("Cracks", {}),
        ("Secret", {"visibility": "private"}),
        ("Units", {"kind": "database", "columns": [{"name": "Label"}]}),
    ):
        story.ids[name] = server.ok(
            "POST", M + "/layers", {"name": name, "type": "u8", "resolution": 2048, **more}
        ).json()["id"]
        if name == "Units":
            server.ok("POST", "/tables/units/records", {"key": 1, "values": {"label": "Wall"}})
        paint(server, name.lower(), "x < 20")
    server.ok("POST", M + "/comments", {"text": "Since when?", "position": [50, 50, 0]})
    server.ok("PATCH", M, {"name": "The sheet"})
    heard = story.reader.until(lambda event: event["data"]["kind"] == "model")
    told = [
        (event["data"]["kind"], event["data"]["op"], event["data"].get("layer")) for event in heard
    ]
    assert ("layer", "created", story.early) not in told, "what was before is not told"
    for each in (
        ("layer", "created", story.ids["Cracks"]),
        ("edit", "fill", story.ids["Cracks"]),
        ("layer", "created", story.ids["Secret"]),
        ("edit", "fill", story.ids["Secret"]),
    ):
        assert each in told, (each, told)
    assert told.index(("layer", "created", story.ids["Cracks"])) < told.index(
        ("edit", "fill", story.ids["Cracks"])
    )
    kinds = [kind for kind, *_ in told]
    assert {"records", "comment", "model", "edit", "layer"} <= set(kinds), kinds
    assert len({event["id"] for event in heard}) >= len(heard) - 1, "each has its own place"
    fills = story.fills = [
        event["data"]
        for event in heard
        if event["data"].get("layer") == story.ids["Cracks"] and event["data"]["kind"] == "edit"
    ]
    assert fills[0]["user"] and fills[0]["count"] == 1 and fills[0]["area_m2"] > 0, fills


def test_a_viewer_hears_nothing_of_a_private_layer(story):
    seen = story.of_viewer.until(lambda event: event["data"]["kind"] == "model")
    assert all(
        event["data"].get("layer") != story.ids["Secret"] and "Secret" not in json.dumps(event)
        for event in seen
    ), seen
    assert any(painted(story.ids["Cracks"])(event) for event in seen)


def test_a_line_that_goes_on_is_told_again_with_what_it_is_now(server, story):
    paint(server, "cracks", "y < 20")
    again = story.reader.until(painted(story.ids["Cracks"]))[-1]["data"]
    assert again["id"] == story.fills[0]["id"] and again["count"] == 2, again


def test_who_was_cut_off_misses_nothing(server, story):
    """A reader that reconnects with the last id gets no event twice, even after a restart of the
    server."""
    after = story.reader.last
    story.reader.close()
    paint(server, "units", "y > 80")
    server.kill()
    server.start()
    back = story.back = reader_of(server, after=after)
    missed = back.until(painted(story.ids["Units"]))
    assert missed[-1]["data"]["count"] == 2, missed
    paint(server, "early", "x < 20")
    assert back.until(painted(story.early))[-1]["data"]["count"] == 1


def test_who_may_no_longer_listen_is_sent_away(server, story):
    out = reader_of(server, story.viewer).listening()
    server.ok("PATCH", "/users/vera", {"disabled": True})
    assert out.ended.wait(LONG_S)


def test_wrong_questions_are_refused(server):
    for path, headers, status in (
        (M + "/events", {"Last-Event-ID": "yesterday"}, 400),
        ("/models/nothing/events", {}, 404),
    ):
        answer = server.request("GET", path, headers=headers)
        assert answer.status == status and answer.json()["detail"], answer
    assert server.request("GET", M + "/events", token=None).status == 401


def test_everybody_is_sent_away_when_the_model_goes(server, story):
    server.ok("DELETE", M)
    assert story.back.ended.wait(LONG_S)


def test_a_server_that_stops_does_not_wait_for_listeners(server):
    server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
    last = reader_of(server).listening()
    assert server.stop() == 0 and last.ended.wait(LONG_S)
    server.assert_clean_log()
