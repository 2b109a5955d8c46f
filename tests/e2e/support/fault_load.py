"""Painters of one model while faults happen to a site of nodes, and the comparison of their
acknowledgements with the journal and with a serial replay."""
import collections
import http.client
import random
import threading
import time
import uuid

from support.cameras import camera_from
from support.live_client import AWAY
from support.meshes import folded_grid
from support.npy import Raster
from support.strata_server import LONG_S, wait_for

ANSWER_S = 1.0  # a painter then sends the stroke to another node
SPARE_STROKES = 5  # of each painter, before the fault
PAUSE_S = 0.05  # between two strokes of a painter
TRY_AGAIN = (429, 503, 507)
LAYER = {"type": "u8", "resolution": 2048}


class Stroke:
    """An acknowledged stroke. `sent` and `at` are the times of the attempt that succeeded."""

    def __init__(self, sequence, edit, node, sent):
        self.sequence, self.edit, self.node = sequence, edit, node
        self.sent, self.at = sent, time.monotonic()


class Painter(threading.Thread):
    """Paints until `stopping` is set. At the end, every stroke that it sent is acknowledged."""

    def __init__(self, site, model, first, seed):
        super().__init__(daemon=True)
        self.site, self.model, self.node = site, model, first
        self.random = random.Random(seed)
        self.camera = camera_from(model, (0, -0.2, 1))
        self.strokes = []
        self.refusals = collections.Counter()  # by status
        self.failure = None
        self.stopping = threading.Event()
        self.links = {}

    def run(self):
        try:
            while not self.stopping.is_set():
                self.strokes.append(self.paint())
                time.sleep(PAUSE_S)
        except Exception as error:  # pylint: disable=broad-except
            self.failure = error

    def paint(self):
        x, y = self.random.uniform(200, 400), self.random.uniform(150, 330)
        edit = {
            "op": "stroke",
            "camera": self.camera,
            "radius_px": 8,
            "path": [[x, y], [x + 30, y + 20]],
            "value": self.random.randint(1, 6),
        }
        headers = {"Idempotency-Key": str(uuid.uuid4())}
        end = time.monotonic() + LONG_S
        while time.monotonic() < end:
            node, sent = self.node, time.monotonic()
            answer = self.send(node, edit, headers)
            if answer is not None and answer.status == 200:
                return Stroke(answer.json()["sequence"], edit, node, sent)
            if answer is not None and answer.status == 307:
                self.node = self.site.node_at(answer.headers["Location"])
                continue
            if answer is not None:
                if answer.status not in TRY_AGAIN:
                    raise AssertionError(f"{edit} got {answer}")
                self.refusals[answer.status] += 1
            nodes = self.site.nodes
            self.node = nodes[(nodes.index(node) + 1) % len(nodes)]
            time.sleep(0.02)
        raise AssertionError(f"a stroke got no answer in {LONG_S} s")

    def send(self, node, edit, headers):
        """Returns the response, or None if there is none in time."""
        link = self.links.get(node) or http.client.HTTPConnection(
            node.host, node.client_port, timeout=ANSWER_S
        )
        self.links[node] = link
        path = f"/models/{self.model['id']}/layers/marks/edits"
        try:
            return node.post(path, edit, headers=headers, connection=link)
        except AWAY:
            self.links.pop(node).close()
            return None


class Load:
    """Painters of one round."""

    def __init__(self, site, model, seed, painters):
        nodes = site.nodes
        self.painters = [
            Painter(site, model, nodes[number % len(nodes)], f"{seed} {number}")
            for number in range(painters)
        ]
        for painter in self.painters:
            painter.start()
        self.wait(lambda painter: len(painter.strokes) >= SPARE_STROKES, "the first strokes")

    def check(self):
        for painter in self.painters:
            if painter.failure:
                raise painter.failure

    def wait(self, condition, what):
        def reached():
            self.check()
            return all(condition(painter) for painter in self.painters)

        wait_for(reached, what)

    def went_on(self, since, without=None):
        """Waits until each painter has an acknowledgement, from a node other than `without`, of a
        stroke that it sent after `since`. Returns the longest of these times."""

        def first(painter):
            for stroke in list(painter.strokes):
                if stroke.sent >= since and stroke.node is not without:
                    return stroke
            return None

        self.wait(first, "painting to go on")
        return max(first(painter).at for painter in self.painters) - since

    def acknowledged_by(self, node, begin, end):
        return sum(
            stroke.node is node and begin <= stroke.at < end
            for painter in self.painters
            for stroke in list(painter.strokes)
        )

    def refused(self, status):
        return sum(painter.refusals[status] for painter in self.painters)

    def end(self):
        """Returns the strokes of all painters."""
        for painter in self.painters:
            painter.stopping.set()
        for painter in self.painters:
            painter.join(LONG_S)
            assert not painter.is_alive(), "a painter still waits for an answer"
        self.check()
        return [stroke for painter in self.painters for stroke in painter.strokes]


class Journal:
    """A new model, and all strokes that were acknowledged on it."""

    def __init__(self, site):
        self.site = site
        self.model = site.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
        self.path = f"/models/{self.model['id']}/layers"
        site.ok("POST", self.path, {"name": "marks", **LAYER})
        self.strokes = []
        self.rounds = 0
        self.lost = self.doubled = 0  # in all rounds

    def check(self, strokes):
        """Adds the strokes of a round. Returns the numbers of lost and doubled strokes in it."""
        self.rounds += 1
        self.strokes += strokes
        found = self.site.postgres.sql(
            f"SELECT coalesce(string_agg(sequence::text, ' '), '') FROM edits WHERE model_id = {self.model['id']}"
        )
        journal = set(map(int, found.split()))
        known = {stroke.sequence for stroke in self.strokes}
        # if two acknowledgements have the same sequence, one of the strokes is lost
        lost = len(known - journal) + len(self.strokes) - len(known)
        doubled = len(journal - known)
        in_round = {"lost": lost - self.lost, "doubled": doubled - self.doubled}
        self.lost, self.doubled = lost, doubled
        return in_round

    def texels(self, layer):
        answer = self.site.ok("GET", f"{self.path}/{layer}/texels.npy")
        return Raster(answer.body)

    def wrong_texels(self):
        """Paints all strokes again in their order, without faults. Returns the number of texels that
        differ."""
        painted = self.texels("marks")
        self.site.ok("POST", self.path, {"name": "replayed", **LAYER})
        # A node can still lose its lease for a moment after the last fault, so this tries again.
        for stroke in sorted(self.strokes, key=lambda stroke: stroke.sequence):
            path, key = self.path + "/replayed/edits", f"replay {stroke.sequence}"
            self.site.ok("POST", path, stroke.edit, headers={"Idempotency-Key": key})
        replayed = self.texels("replayed")
        assert self.strokes and any(painted.content), "nothing was painted"
        return 0 if painted.digest == replayed.digest else len(painted.differences(replayed))
