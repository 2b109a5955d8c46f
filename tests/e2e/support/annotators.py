"""Simulated users who paint. Each user has a separate account, view and connection. The test cuts
off the connection at random.

A user sends each message with the same id until the server reports that it is durable."""
import math
import random
import threading
import time
import uuid

from support.ledger import Change
from support.live_client import AWAY, LiveClient, Refused
from support.live_line import WAYS, Line

MOST_WAITING = 16  # messages that one user has sent and that are not durable
MOST_ATTEMPTS = 1000  # to send a message while the server has no space for it
TURNS_EVERY_S = 0.1
VALUES = [1, 2, 3, 4, 5, 6, 255]


def new_id():
    return str(uuid.uuid4())


class Annotator(threading.Thread):
    """Paints until `site.stopping` is set, waits until all edits are durable (`drained`), and
    watches until `site.leaving` is set."""

    def __init__(self, site, number, browser, seed):
        super().__init__(daemon=True, name=f"painter{number}")
        self.site, self.ledger, self.browser = site, site.ledger, browser
        self.random = random.Random(seed)
        self.turning = number < site.turning
        self.angle = 2 * math.pi * number / site.people
        self.line, self.lines, self.hanging = None, [], []
        self.waiting, self.done = {}, []  # messages by id, in order; those in `done` are durable
        self.again = False  # whether the server refused a message temporarily
        self.cuts = dict.fromkeys(WAYS, 0)
        self.camera_seq, self.next_turn, self.cut_at, self.cut_way = 0, 0.0, 0.0, WAYS[0]
        self.drained = threading.Event()

    def run(self):
        try:
            self.open_line()
            while not self.site.stopping.is_set():
                self.act()
                self.pause(self.random.uniform(0.2, 1.5))
            self.cut_at = math.inf
            while not self.site.leaving.is_set():
                if not self.waiting:
                    self.drained.set()
                self.pause(0.02)
            self.line.give_up("close")
        except BaseException as error:  # pylint: disable=broad-except
            self.ledger.fault(f"{self.name}: {error!r}")
            raise

    # --- the connection

    def open_line(self):
        number = len(self.lines)
        live = LiveClient(
            self.site.server,
            self.site.model["id"],
            token="",
            cookie=self.browser.cookie,
            origin=self.site.server.url,
        )
        welcome = live.hello(accept=["jpeg"])
        self.line = Line(live, self.hears, self.ledger.fault, number)
        self.lines.append(self.line)
        self.line.reader.start()
        self.look(moving=self.turning)
        low, high = self.site.cut_every
        self.cut_way = self.random.choice(WAYS)
        self.cut_at = (
            math.inf
            if self.site.stopping.is_set()
            else time.monotonic() + self.random.uniform(low, high)
        )
        return welcome

    def camera(self):
        return self.site.camera(self.angle)

    def look(self, moving):
        self.camera_seq += 1
        self.line.send({"op": "camera", "seq": self.camera_seq, "moving": moving, **self.camera()})

    def cut_off(self, way):
        self.cuts[way] += 1
        self.line.give_up(way)
        if way == "hang":
            self.hanging.append(self.line)
            if len(self.hanging) > 1:
                self.hanging.pop(0).live.socket.close()
        self.come_back()

    def come_back(self):
        """Opens a new connection, and repeats all messages that are not known to be durable."""
        while True:
            if not self.line.given_up:
                self.ledger.dropped.append(self.line.code)
                self.line.give_up("close")
            time.sleep(self.random.uniform(0, 1.0))
            try:
                self.take_up(self.open_line())
                return
            except Refused as refused:
                if refused.status not in (429, 503):
                    raise
            except AWAY:
                pass

    def take_up(self, welcome):
        """Like a page, omits messages that the server has. Sometimes sends some of them again."""
        saved_through = {stroke["stroke"]: stroke["n"] for stroke in welcome["strokes"]}
        with self.ledger.lock:
            self.ledger.claims += list(saved_through.items())
            if self.random.random() < 0.5:
                for change in list(self.waiting.values()):
                    if change.begin and change.message["n"] <= saved_through.get(
                        change.message["stroke"], -1
                    ):
                        change.promised = True
                        del self.waiting[change.id]
        if self.done and self.random.random() < 0.4:  # simulates that their responses were lost
            for change in self.random.sample(self.done[-50:], min(3, len(self.done[-50:]))):
                self.transmit_all([change])
        self.transmit_waiting()

    def transmit_waiting(self):
        with self.ledger.lock:
            waiting = [change for change in self.waiting.values() if not change.by_http]
        self.transmit_all(waiting)

    def transmit_all(self, changes):
        begun = set()
        for change in changes:
            if change.begin and change.begin["stroke"] not in begun:
                begun.add(change.begin["stroke"])
                self.line.send(change.begin)
            self.transmit(change)

    def transmit(self, change):
        change.lines.append(self.line.number)
        change.first_sent = change.first_sent or time.monotonic()
        self.line.send(change.message)

    def hears(self, line, message):
        now, op = time.monotonic(), message["op"]
        if op in ("applied", "saved"):
            change = self.ledger.named(message)
            if change is None:
                return self.ledger.fault(f"{self.name} was told of what nobody sent: {message}")
            if self.ledger.told(change, message, now, op == "saved"):
                self.settle(change)
        elif op == "unsaved":
            with self.ledger.lock:
                self.ledger.unsaved += len(message["ids"])
                for each in message["ids"]:
                    if not self.ledger.changes[each].saved_at:
                        self.ledger.changes[each].answer = None
            self.again = True
        elif op == "problem":
            self.hears_problem(message)
        return None

    def settle(self, change):
        with self.ledger.lock:
            if self.waiting.pop(change.id, None) and not change.by_http:
                self.done.append(change)

    def hears_problem(self, message):
        change = self.ledger.changes.get(message.get("ref"))
        if (
            change
            and not change.saved_at
            and (
                message["status"] in (429, 503)
                or (change.begin and message["status"] in (404, 409))
            )
        ):
            self.put_off(change)  # also for a batch after a refused batch
        elif change and not change.answer and not change.begin and message["status"] in (409, 422):
            change.refused = message["title"]  # nothing to undo, or a fill outside the model
            with self.ledger.lock:
                self.waiting.pop(change.id, None)
        else:
            self.ledger.fault(f"{self.name} got {message} for {change and change.message}")

    def put_off(self, change):
        self.ledger.put_off += 1
        self.again = True
        if len(change.lines) > MOST_ATTEMPTS:
            raise AssertionError(f"{change.kind} {change.id} was put off {len(change.lines)} times")

    # --- actions of a user

    def pause(self, seconds):
        """Waits while the camera turns. May cut off the connection."""
        end = time.monotonic() + seconds
        while True:
            now = time.monotonic()
            try:
                if now >= self.cut_at and self.cut_way != "half a message":
                    self.cut_off(self.cut_way)
                elif self.line.ended:
                    self.come_back()
                if self.again:
                    self.again = False
                    self.transmit_waiting()
                if self.turning and now >= self.next_turn and not self.site.leaving.is_set():
                    self.angle += 0.03
                    self.next_turn = now + TURNS_EVERY_S
                    self.look(moving=True)
            except AWAY:
                self.come_back()
            left = end - time.monotonic()
            if left <= 0:
                return
            time.sleep(min(left, 0.01))

    def deliver(self, change):
        while len(self.waiting) >= MOST_WAITING and not self.ledger.faults:
            self.pause(0.01)
        with self.ledger.lock:
            self.ledger.add(change)
            self.waiting[change.id] = change
        if change.by_http:
            return self.post(change)
        try:
            if time.monotonic() >= self.cut_at:  # no pause has cut off the connection yet
                self.line.send_half(change.message)
                return self.cut_off(self.cut_way)
            self.transmit(change)
            if self.random.random() < 0.03:
                self.transmit(change)  # sends the message twice
        except AWAY:
            self.come_back()
        return None

    def post(self, change):
        """Sends over HTTP until a response arrives. Sometimes ignores the response and sends
        everything again."""
        path = f"/models/{self.site.model['id']}/layers/{self.site.layer}/"
        path, body = (
            (path + "edits", change.message["edit"])
            if "edit" in change.message
            else (path + change.message["op"], None)
        )
        change.first_sent = time.monotonic()
        for _ in range(MOST_ATTEMPTS):
            change.lines.append(None)
            try:
                # an undo is not repeated, because its effect depends on its order
                if body and self.random.random() < 0.2:
                    self.site.ask_and_go(self.browser, path, body, change.id)
                answer = self.browser.request("POST", path, body, **{"Idempotency-Key": change.id})
            except AWAY:
                answer = None
            if answer and answer.status == 200:
                self.ledger.told(change, answer.json(), time.monotonic(), saved=True)
                self.settle(change)
                if self.random.random() < 0.8:
                    return None
                continue  # repeats the request in spite of a response
            if answer and answer.status not in (429, 503):
                if change.saved_at:
                    self.ledger.fault(f"{change.message} was saved, and then got {answer}")
                change.refused = answer.json()["title"]
                with self.ledger.lock:
                    self.waiting.pop(change.id, None)
                if answer.status not in (409, 422):
                    self.ledger.fault(f"{change.message} got {answer}")
                return None
            self.ledger.put_off += 1
            self.pause(0.05)
        raise AssertionError(f"{change.message} was put off again and again")

    def act(self):
        kind = self.random.choices(
            ("stroke", "dab", "polygon", "recolour", "bucket", "undo", "redo"),
            (70, 6, 6, 2, 1, 9, 5),
        )[0]
        if kind == "stroke":
            return self.stroke()
        self.change(
            kind,
            {"op": kind}
            if kind in ("undo", "redo")
            else {"op": "edit", "edit": getattr(self, kind)()},
        )
        if kind == "undo" and self.random.random() < 0.4:
            self.change("redo", {"op": "redo"})  # a new stroke would remove the redo
        return None

    def change(self, kind, message):
        by_http = self.random.random() < 0.5
        self.deliver(
            Change(
                self, kind, {**message, "id": new_id(), "layer": self.site.layer}, by_http=by_http
            )
        )

    def value(self):
        return (
            {"erase": True}
            if self.random.random() < 0.15
            else {"value": self.random.choice(VALUES)}
        )

    def brush(self):
        return {
            **self.value(),
            "camera": self.camera(),
            "radius_px": self.random.randint(3, 40),
            **({"shape": "square"} if self.random.random() < 0.1 else {}),
        }

    def points(self, count, start=None):
        width, height = self.site.window
        x, y = start or (
            self.random.uniform(0.3, 0.7) * width,
            self.random.uniform(0.25, 0.75) * height,
        )
        path = []
        for _ in range(count):
            x, y = (
                x + self.random.uniform(-0.04, 0.04) * width,
                y + self.random.uniform(-0.05, 0.05) * height,
            )
            path.append([round(x, 2), round(y, 2)])
        return path

    def dab(self):
        return {"op": "stroke", **self.brush(), "path": self.points(3)}

    def polygon(self):
        return {
            "op": "polygon",
            **self.value(),
            "camera": self.camera(),
            "path": self.points(self.random.randint(3, 6)),
        }

    def recolour(self):
        """The effect of this edit depends on all edits before it."""
        return {
            "op": "fill",
            "mode": "where",
            "where": f"{self.site.layer} == {self.random.choice(VALUES)}",
            **self.value(),
        }

    def bucket(self):
        x, y = self.points(1)[0]
        return {
            "op": "fill",
            "mode": "connected",
            "at": {"camera": self.camera(), "x": x, "y": y},
            **self.value(),
        }

    def stroke(self):
        begin = {
            "op": "stroke.begin",
            "id": new_id(),
            "stroke": new_id(),
            "layer": self.site.layer,
            **self.brush(),
        }
        try:
            self.line.send(begin)
        except AWAY:
            self.come_back()
        last = None
        for n in range(self.random.randint(1, 10)):
            path = self.points(self.random.randint(1, 3), last)
            last = path[-1]
            message = {
                "op": "stroke.extend",
                "id": new_id(),
                "stroke": begin["stroke"],
                "n": n,
                "path": path,
            }
            self.deliver(Change(self, "stroke", message, begin=begin))
            self.show_pointer(last)
            self.pause(self.random.uniform(0.5, 1.5) / self.site.pace)
        try:
            self.line.send({"op": "stroke.end", "id": new_id(), "stroke": begin["stroke"]})
        except AWAY:
            self.come_back()

    def show_pointer(self, pixel):
        try:
            self.line.send({"op": "presence", "pointer": pixel})
        except AWAY:
            self.come_back()
