"""A model that painters paint while something fails, and the checks at the end.

The reference is the server itself without faults. All edits are painted again in their order on new
layers, and every texel must be equal."""
import threading

from support.cameras import camera_from
from support.meshes import folded_grid
from support.npy import Raster
from support.painters import Book
from support.strata_server import wait_for

LAYERS = [
    ("marks", "u8", 2048, [1, 2, 3, 255]),
    ("depth", "f32", 2048, [0.0, 1.5, -2.25, 3e7]),
    ("shift", "i16", 2048, [-32768, -5, 12, 32767]),
]


class PaintedModel:
    def __init__(self, server, seed):
        self.server, self.seed = server, seed
        self.model = server.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
        self.path = f"/models/{self.model['id']}"
        self.make_layers("")
        self.book = Book()

    def make_layers(self, suffix):
        for name, kind, resolution, _ in LAYERS:
            self.server.ok(
                "POST",
                self.path + "/layers",
                {"name": name + suffix, "type": kind, "resolution": resolution},
            )

    def texels(self, layer, at=None):
        query = "" if at is None else f"?at={at}"
        answer = wait_for(
            lambda: (lambda a: a if a.status != 503 else None)(
                self.server.get(f"{self.path}/layers/{layer}/texels.npy{query}")
            ),
            "texels",
        )
        assert answer.status == 200, answer
        return Raster(answer.body)

    def painters(self, kinds, server=None):
        """Returns a painter of each kind, in the order of `kinds`."""
        cameras = [
            camera_from(self.model, direction)
            for direction in ([0, -0.2, 1], [0.8, 0.3, 0.6], [-0.7, -0.9, 0.5])
        ]
        layers = [(name, values) for name, _, _, values in LAYERS]
        return [
            kind(server or self.server, self.model["id"], layers, cameras, self.book, seed)
            for seed, kind in enumerate(kinds, 100 * self.seed)
        ]

    def end_painting(self, painters):
        """Waits until every painter has its last response, and checks that no painter found a
        fault."""
        self.book.stopping.set()
        for painter in painters:
            painter.join(180)
            assert not painter.is_alive(), f"{painter.name} still waits for an answer"
        assert not self.book.faults, self.book.faults[:5]

    def history(self):
        found = {}
        for name, *_ in LAYERS:
            offset = 0
            while True:
                page = self.server.ok(
                    "GET", f"{self.path}/layers/{name}/edits?limit=1000&offset={offset}"
                ).json()
                for row in page["edits"]:
                    assert (
                        row["sequence"] not in found
                    ), f"sequence {row['sequence']} is in the history twice"
                    found[row["sequence"]] = (name, row)
                offset += len(page["edits"])
                if not page["edits"] or offset >= page["total"]:
                    break
        return found

    def check_history(self):
        found = self.history()
        with self.book.lock:
            acknowledged = dict(self.book.edits)
        for sequence, (layer, _, answer) in acknowledged.items():
            assert sequence in found, f"edit {sequence} was reported saved and is gone"
            name, row = found[sequence]
            assert name == layer and row["texels_changed"] == answer["texels_changed"], (
                row,
                answer,
            )
        assert sorted(found) == list(range(1, len(found) + 1)), "the sequences have gaps"
        return found

    def check_saved_once(self):
        """Checks that the history contains the edits that were reported as saved, each once, and no
        others. Returns it. Call after `end_painting`."""
        found = self.check_history()
        ids = [row["id"] for _, row in found.values()]
        assert len(set(ids)) == len(ids), "an edit is in the history twice"
        assert sorted(found) == sorted(self.book.edits), "the history has an edit that nobody sent"
        return found

    def compare_with_replay(self, newest):
        """Paints all edits again in order, on new layers and without faults. Checks that the texels
        are equal."""
        self.make_layers(" replayed")
        edits = [self.book.edits[sequence][:2] for sequence in sorted(self.book.edits)]

        def replay(layer):
            connection = self.server.connect()
            for name, edit in edits:
                if name == layer:
                    self.server.ok(
                        "POST",
                        f"{self.path}/layers/{name}-replayed/edits",
                        edit,
                        connection=connection,
                    )

        failures = []

        def work(layer):
            try:
                replay(layer)
                wrong = newest[layer].differences(self.texels(layer + "-replayed"))
                assert (
                    not wrong
                ), f"{layer}: {len(wrong)} texels differ from the replay, for example {wrong[:3]}"
            except BaseException as error:  # pylint: disable=broad-except
                failures.append(error)

        workers = [threading.Thread(target=work, args=(name,)) for name, *_ in LAYERS]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        if failures:
            raise failures[0]
