"""Painters that send each edit with the same id until the server reports that it is durable."""
import random
import threading
import time
import uuid

from support.live_client import AWAY, LiveClient, Refused
from support.strata_server import LONG_S


class Book:
    """The edits that were reported as saved: by sequence, the layer and the edit as an HTTP
    body."""

    def __init__(self):
        self.lock = threading.Condition()
        self.edits = {}  # sequence -> (layer slug, edit, response)
        self.repeats = []  # (method, path, body, key, response): HTTP edits to send again
        self.strokes = {}  # id -> messages of a complete live stroke, to send them again
        # Strokes that may have begun at a server that was lost. The next server has not seen their
        # first batches, so it refuses to repeat these (409, Batch too old).
        self.continued = set()
        self.faults = []
        self.stopping = threading.Event()

    def saved(self, sequence, layer, edit, answer):
        with self.lock:
            if sequence in self.edits:
                self.faults.append(
                    f"sequence {sequence} was given twice: {self.edits[sequence]} and {(layer, edit)}"
                )
            self.edits[sequence] = (layer, edit, answer)
            self.lock.notify_all()

    def fault(self, text):
        with self.lock:
            self.faults.append(text)
            self.lock.notify_all()

    def wait_for_more(self, count):
        with self.lock:
            wanted = len(self.edits) + count
            if not self.lock.wait_for(lambda: len(self.edits) >= wanted or self.faults, LONG_S):
                raise AssertionError(f"no {count} more edits were saved in {LONG_S} s")
            assert not self.faults, self.faults[:5]


class Painter(threading.Thread):
    def __init__(self, server, model, layers, cameras, book, seed):
        super().__init__(daemon=True, name=f"{type(self).__name__} {seed}")
        self.server, self.model, self.layers, self.cameras, self.book = (
            server,
            model,
            layers,
            cameras,
            book,
        )
        self.random = random.Random(seed)

    def path(self, points):
        x, y = self.random.uniform(200, 440), self.random.uniform(120, 360)
        path = [[round(x, 2), round(y, 2)]]
        for _ in range(points - 1):
            x, y = x + self.random.uniform(-40, 40), y + self.random.uniform(-40, 40)
            path.append([round(x, 2), round(y, 2)])
        return path

    def stroke(self, points):
        layer, values = self.random.choice(self.layers)
        edit = {
            "op": "stroke",
            "camera": self.random.choice(self.cameras),
            "radius_px": self.random.randint(3, 25),
            "path": self.path(points),
        }
        if self.random.random() < 0.15:
            edit["erase"] = True
        else:
            edit["value"] = self.random.choice(values)
        if self.random.random() < 0.1:
            edit["shape"] = "square"
        return layer, edit

    def run(self):
        try:
            while not self.book.stopping.is_set():
                self.paint()
        except Exception as error:  # pylint: disable=broad-except
            self.book.fault(f"{self.name}: {error!r}")


class HttpPainter(Painter):
    connection = None
    TRY_AGAIN = (429, 503)

    def send(self, path, edit, headers):
        """Returns the response to one attempt, or None if the server is unreachable."""
        try:
            if self.connection is None:
                self.connection = self.server.connect()
            return self.server.post(path, edit, headers=headers, connection=self.connection)
        except AWAY:
            self.connection = None
            return None

    def paint(self):
        layer, edit = self.stroke(3)
        path, key = f"/models/{self.model}/layers/{layer}/edits", str(uuid.uuid4())
        while True:
            answer = self.send(path, edit, {"Idempotency-Key": key})
            if answer is not None and answer.status == 200:
                break
            if answer is not None and answer.status not in self.TRY_AGAIN:
                raise AssertionError(f"{edit} got {answer}")
            time.sleep(0.02)
        result = answer.json()
        with self.book.lock:
            self.book.repeats.append((path, edit, key, result))
        self.book.saved(result["sequence"], layer, edit, result)


class LivePainter(Painter):
    """Paints a stroke of several batches. After a lost connection, begins the stroke again and
    sends the batches that were not saved."""

    TRY_AGAIN = (503,)

    def connect(self):
        return LiveClient(self.server, self.model)

    def paint(self):
        layer, edit = self.stroke(2)
        stroke, begin = str(uuid.uuid4()), str(uuid.uuid4())
        tool = {k: v for k, v in edit.items() if k not in ("op", "path")}
        batches = [edit["path"]] + [self.path(2) for _ in range(self.random.randint(1, 4))]
        ids = [str(uuid.uuid4()) for _ in batches]
        messages = [
            {"op": "stroke.begin", "id": begin, "stroke": stroke, "layer": layer, **tool},
            *(
                {"op": "stroke.extend", "id": ids[n], "stroke": stroke, "n": n, "path": path}
                for n, path in enumerate(batches)
            ),
        ]
        saved = set()
        continued = False
        while len(saved) < len(batches):
            continued = bool(saved)
            try:
                with self.connect() as live:
                    live.hello()
                    live.send(messages[0])
                    for n, message in enumerate(messages[1:]):
                        if n not in saved:
                            live.send(message)
                    self.collect(live, layer, edit, stroke, batches, ids, saved)
                    if len(saved) == len(batches):
                        live.send({"op": "stroke.end", "id": str(uuid.uuid4()), "stroke": stroke})
            except Refused as refused:
                if refused.status not in self.TRY_AGAIN:
                    raise
                time.sleep(0.02)
            except AWAY:
                time.sleep(0.02)
        with self.book.lock:
            self.book.strokes[stroke] = messages
            if continued:
                self.book.continued.add(stroke)

    def collect(self, live, layer, edit, stroke, batches, ids, saved):
        while len(saved) < len(batches):
            message = live.receive_until("saved", "unsaved", "problem")
            if message["op"] == "saved" and message.get("stroke") == stroke:
                n = message["n"]
                if n not in saved:
                    saved.add(n)
                    start = [batches[n - 1][-1]] if n else []
                    self.book.saved(
                        message["sequence"], layer, {**edit, "path": start + batches[n]}, message
                    )
            elif message["op"] == "unsaved":
                return  # the batch is sent again on a new connection
            elif message["op"] == "problem":
                if message.get("ref") in ids and message["status"] in (429, 503, 404, 409):
                    return
                raise AssertionError(f"the server refused: {message}")
