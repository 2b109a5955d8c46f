#!/usr/bin/env python3
"""Events of a model for scripts: what is done is told once it is durable, each reader hears what they see, and who was cut off misses nothing."""
import http.client
import json
import os
import queue
import sys
import threading

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support.meshes import folded_grid
from support.strata_server import LONG_S, StrataServer

M = "/models/sheet"


class Reader:
    """Reads server-sent events on a thread of its own."""

    def __init__(self, server, token=True, after=None, path=M + "/events"):
        secret = server.token if token is True else token
        self.connection = http.client.HTTPConnection(server.host, server.port, timeout=LONG_S)
        headers = {"Authorization": f"Bearer {secret}", **({"Last-Event-ID": after} if after else {})}
        self.connection.request("GET", "/api/v1" + path, headers=headers)
        self.answer = self.connection.getresponse()
        self.events, self.last, self.ended = queue.Queue(), after, threading.Event()
        if self.answer.status == 200:
            assert self.answer.headers["Content-Type"] == "text/event-stream", self.answer.headers
            threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        event = {}
        try:
            for raw in self.answer:
                line = raw.decode().rstrip("\n")
                if not line:
                    if "id" in event:
                        self.last = event["id"]
                        self.events.put(event if "data" in event else None)
                    event = {}
                elif not line.startswith(":"):
                    name, _, value = line.partition(": ")
                    event[name] = json.loads(value) if name == "data" else value
        except (OSError, http.client.HTTPException, ValueError, AttributeError):
            pass
        self.ended.set()

    def listening(self):
        """Who listens anew is told from where on."""
        assert self.events.get(timeout=LONG_S) is None
        return self

    def until(self, wanted):
        """The events up to the first that is as wanted."""
        heard = []
        while not heard or not wanted(heard[-1]):
            event = self.events.get(timeout=LONG_S)
            if event:
                assert event["event"] == event["data"]["kind"], event
                heard.append(event)
        return heard

    def close(self):
        self.connection.sock.close()
        self.connection.close()


def painted(layer):
    return lambda event: event["data"].get("layer") == layer and event["data"]["kind"] == "edit"


def main():
    with StrataServer() as server:
        server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
        viewer = server.add_person("vera", "viewer")
        early = server.ok("POST", M + "/layers", {"name": "Early", "type": "u8", "resolution": 2048}).json()["id"]
        reader, of_viewer = Reader(server).listening(), Reader(server, viewer).listening()

        ids, paint = {}, lambda name, where: server.ok("POST", f"{M}/layers/{name}/edits", {"op": "fill", "mode": "where", "where": where, "value": 1})
        for name, more in (("Cracks", {}), ("Secret", {"visibility": "private"}), ("Units", {"kind": "database", "columns": [{"name": "Label"}]})):
            ids[name] = server.ok("POST", M + "/layers", {"name": name, "type": "u8", "resolution": 2048, **more}).json()["id"]
            if name == "Units":
                server.ok("POST", "/tables/units/records", {"key": 1, "values": {"label": "Wall"}})
            paint(name.lower(), "x < 20")
        server.ok("POST", M + "/comments", {"text": "Since when?", "position": [50, 50, 0]})
        server.ok("PATCH", M, {"name": "The sheet"})
        heard = reader.until(lambda event: event["data"]["kind"] == "model")
        told = [(event["data"]["kind"], event["data"]["op"], event["data"].get("layer")) for event in heard]
        assert ("layer", "created", early) not in told, "what was before is not told"
        for each in (("layer", "created", ids["Cracks"]), ("edit", "fill", ids["Cracks"]), ("layer", "created", ids["Secret"]), ("edit", "fill", ids["Secret"])):
            assert each in told, (each, told)
        assert told.index(("layer", "created", ids["Cracks"])) < told.index(("edit", "fill", ids["Cracks"]))
        kinds = [kind for kind, *_ in told]
        assert {"records", "comment", "model", "edit", "layer"} <= set(kinds), kinds
        assert len({event["id"] for event in heard}) >= len(heard) - 1, "each has its own place"
        fills = [event["data"] for event in heard if event["data"].get("layer") == ids["Cracks"] and event["data"]["kind"] == "edit"]
        assert fills[0]["user"] and fills[0]["count"] == 1 and fills[0]["area_m2"] > 0, fills

        seen = of_viewer.until(lambda event: event["data"]["kind"] == "model")
        assert all(event["data"].get("layer") != ids["Secret"] and "Secret" not in json.dumps(event) for event in seen), seen
        assert any(painted(ids["Cracks"])(event) for event in seen)

        # A line that goes on is told again, with what it is now.
        paint("cracks", "y < 20")
        again = reader.until(painted(ids["Cracks"]))[-1]["data"]
        assert again["id"] == fills[0]["id"] and again["count"] == 2, again

        # Cut off, and while the server was away: whoever comes back with the last id misses nothing, and hears no line as it was told before.
        after = reader.last
        reader.close()
        paint("units", "y > 80")
        server.kill()
        server.start()
        back = Reader(server, after=after)
        missed = back.until(painted(ids["Units"]))
        assert missed[-1]["data"]["count"] == 2, missed
        paint("early", "x < 20")
        assert back.until(painted(early))[-1]["data"]["count"] == 1

        # Who may no longer listen is sent away; so is everybody when the model goes.
        out = Reader(server, viewer).listening()
        server.ok("PATCH", "/users/vera", {"disabled": True})
        assert out.ended.wait(LONG_S)
        for path, headers, status in ((M + "/events", {"Last-Event-ID": "yesterday"}, 400), ("/models/nothing/events", {}, 404)):
            answer = server.request("GET", path, headers=headers)
            assert answer.status == status and answer.json()["detail"], answer
        assert server.request("GET", M + "/events", token=None).status == 401
        server.ok("DELETE", M)
        assert back.ended.wait(LONG_S)

        # A server that stops does not wait for listeners.
        server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
        last = Reader(server).listening()
        assert server.stop() == 0 and last.ended.wait(LONG_S)
        server.assert_clean_log()
    print("events")


if __name__ == "__main__":
    main()
