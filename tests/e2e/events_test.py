#!/usr/bin/env python3
"""Events of a model for scripts: what is done is told once it is durable, each reader hears what they see, and who was cut off misses nothing."""
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support.event_reader import EventReader
from support.meshes import folded_grid
from support.strata_server import LONG_S, StrataServer

M = "/models/sheet"


def reader_of(server, token=True, after=None):
    return EventReader(server, M, token, after)


def painted(layer):
    return lambda event: event["data"].get("layer") == layer and event["data"]["kind"] == "edit"


def main():
    with StrataServer() as server:
        server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
        viewer = server.add_person("vera", "viewer")
        early = server.ok(
            "POST", M + "/layers", {"name": "Early", "type": "u8", "resolution": 2048}
        ).json()["id"]
        reader, of_viewer = reader_of(server).listening(), reader_of(server, viewer).listening()

        ids, paint = {}, lambda name, where: server.ok(
            "POST",
            f"{M}/layers/{name}/edits",
            {"op": "fill", "mode": "where", "where": where, "value": 1},
        )
        for name, more in (
            ("Cracks", {}),
            ("Secret", {"visibility": "private"}),
            ("Units", {"kind": "database", "columns": [{"name": "Label"}]}),
        ):
            ids[name] = server.ok(
                "POST", M + "/layers", {"name": name, "type": "u8", "resolution": 2048, **more}
            ).json()["id"]
            if name == "Units":
                server.ok("POST", "/tables/units/records", {"key": 1, "values": {"label": "Wall"}})
            paint(name.lower(), "x < 20")
        server.ok("POST", M + "/comments", {"text": "Since when?", "position": [50, 50, 0]})
        server.ok("PATCH", M, {"name": "The sheet"})
        heard = reader.until(lambda event: event["data"]["kind"] == "model")
        told = [
            (event["data"]["kind"], event["data"]["op"], event["data"].get("layer"))
            for event in heard
        ]
        assert ("layer", "created", early) not in told, "what was before is not told"
        for each in (
            ("layer", "created", ids["Cracks"]),
            ("edit", "fill", ids["Cracks"]),
            ("layer", "created", ids["Secret"]),
            ("edit", "fill", ids["Secret"]),
        ):
            assert each in told, (each, told)
        assert told.index(("layer", "created", ids["Cracks"])) < told.index(
            ("edit", "fill", ids["Cracks"])
        )
        kinds = [kind for kind, *_ in told]
        assert {"records", "comment", "model", "edit", "layer"} <= set(kinds), kinds
        assert len({event["id"] for event in heard}) >= len(heard) - 1, "each has its own place"
        fills = [
            event["data"]
            for event in heard
            if event["data"].get("layer") == ids["Cracks"] and event["data"]["kind"] == "edit"
        ]
        assert fills[0]["user"] and fills[0]["count"] == 1 and fills[0]["area_m2"] > 0, fills

        seen = of_viewer.until(lambda event: event["data"]["kind"] == "model")
        assert all(
            event["data"].get("layer") != ids["Secret"] and "Secret" not in json.dumps(event)
            for event in seen
        ), seen
        assert any(painted(ids["Cracks"])(event) for event in seen)

        # A line that goes on is told again, with what it is now.
        paint("cracks", "y < 20")
        again = reader.until(painted(ids["Cracks"]))[-1]["data"]
        assert again["id"] == fills[0]["id"] and again["count"] == 2, again

        # Cut off, and while the server was away: whoever comes back with the last id misses
        # nothing, and hears no line as it was told before.
        after = reader.last
        reader.close()
        paint("units", "y > 80")
        server.kill()
        server.start()
        back = reader_of(server, after=after)
        missed = back.until(painted(ids["Units"]))
        assert missed[-1]["data"]["count"] == 2, missed
        paint("early", "x < 20")
        assert back.until(painted(early))[-1]["data"]["count"] == 1

        # Who may no longer listen is sent away; so is everybody when the model goes.
        out = reader_of(server, viewer).listening()
        server.ok("PATCH", "/users/vera", {"disabled": True})
        assert out.ended.wait(LONG_S)
        for path, headers, status in (
            (M + "/events", {"Last-Event-ID": "yesterday"}, 400),
            ("/models/nothing/events", {}, 404),
        ):
            answer = server.request("GET", path, headers=headers)
            assert answer.status == status and answer.json()["detail"], answer
        assert server.request("GET", M + "/events", token=None).status == 401
        server.ok("DELETE", M)
        assert back.ended.wait(LONG_S)

        # A server that stops does not wait for listeners.
        server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
        last = reader_of(server).listening()
        assert server.stop() == 0 and last.ended.wait(LONG_S)
        server.assert_clean_log()
    print("events")


if __name__ == "__main__":
    main()
