"""Reads the server-sent events of a model as they arrive."""
import http.client
import json
import queue
import threading

from support.strata_server import LONG_S


class EventReader:
    """Reads server-sent events on a separate thread."""

    def __init__(self, server, model, token=True, after=None):
        secret = server.token if token is True else token
        self.connection = http.client.HTTPConnection(server.host, server.port, timeout=LONG_S)
        headers = {
            "Authorization": f"Bearer {secret}",
            **({"Last-Event-ID": after} if after else {}),
        }
        self.connection.request("GET", f"/api/v1{model}/events", headers=headers)
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
        """Waits until the server has confirmed the start."""
        assert self.events.get(timeout=LONG_S) is None
        return self

    def until(self, wanted):
        """Returns the events up to the first that fulfills the condition."""
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
