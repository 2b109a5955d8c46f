"""A PaintedModel whose server merges strokes while it is killed. The edits of HTTP painters stay as
they are. The batches of a stroke may be in fewer edits, with the same sums."""
import random

from support.live_client import AWAY, LiveClient, Refused
from support.merges import MARKED_LONG_AGO
from support.painted_model import PaintedModel
from support.strata_server import wait_for

OPTIONS = ["--merge-after", "1"]


def is_batch(answer):
    return "n" in answer


class MergedModel(PaintedModel):
    def __init__(self, server, seed, sql):
        """`sql` runs SQL in the database of the server."""
        super().__init__(server, seed)
        self.sql, self.random = sql, random.Random(seed)
        self.states = {}  # (layer, sequence) -> digest, of states that merges keep
        sql(MARKED_LONG_AGO)

    def batches_of(self, stroke):
        """Returns the saved batches of a stroke by sequence. Call with the lock of the book."""
        return {at: edit for at, edit in self.book.edits.items() if edit[2].get("stroke") == stroke}

    def merged_batches(self):
        return int(self.sql("SELECT count(*) FROM edit_batches"))

    def wait_for_merge(self):
        """Painters go on, so more strokes are merged when the caller kills something."""
        before = self.merged_batches()
        wait_for(lambda: self.merged_batches() > before, "another stroke to be merged")

    def remember(self):
        """Records the texels at the end of a stroke and of another edit."""
        with self.book.lock:
            ends = [at for at, edit in self.book.edits.items() if not is_batch(edit[2])][-1:]
            for stroke in list(self.book.strokes)[-1:]:
                ends.append(max(self.batches_of(stroke)))
            ends = [(self.book.edits[at][0], at) for at in ends]
        for layer, at in ends:
            self.states[layer, at] = self.texels(layer, at).digest

    def check_states(self):
        for layer, at in self.states:
            assert self.texels(layer, at).digest == self.states[layer, at], f"{layer} at {at}"

    def check_history(self):
        found = self.history()
        with self.book.lock:
            assert sorted(self.book.edits) == list(range(1, len(self.book.edits) + 1)), "gaps"
            assert found.keys() <= self.book.edits.keys(), "an edit that nobody sent"
            for sequence, (layer, _, answer) in self.book.edits.items():
                if is_batch(answer):
                    continue
                assert sequence in found, f"edit {sequence} was reported saved and is gone"
                name, row = found[sequence]
                wanted = (layer, answer["texels_changed"])
                assert (name, row["texels_changed"]) == wanted, (row, answer)
            for stroke in self.book.strokes:
                self.check_stroke(self.batches_of(stroke), found, stroke)
        return found

    def check_stroke(self, batches, found, stroke):
        rows = {at: row for at, (_, row) in found.items() if row["stroke"] == stroke}
        assert rows.keys() <= batches.keys() and max(rows) == max(batches), (rows, batches)
        changed = sum(row["texels_changed"] for row in rows.values())
        assert changed == sum(answer["texels_changed"] for _, _, answer in batches.values())

    def check_repeats(self, count):
        """Sends complete strokes again. Each batch gets its first response."""
        with self.book.lock:
            whole = sorted(self.book.strokes.keys() - self.book.continued)
        assert whole, "no stroke was painted through one connection"
        strokes = self.random.sample(whole, min(count, len(whole)))
        for stroke in strokes:
            again = wait_for(lambda: self.send_again(self.book.strokes[stroke]), "a repeat")
            with self.book.lock:
                first = {answer["n"]: answer for _, _, answer in self.batches_of(stroke).values()}
            assert len(again) == len(first)
            for n, answer in again.items():
                for member in ("sequence", "texels_changed", "area_m2"):
                    assert answer[member] == first[n][member], (answer, first[n])

    def send_again(self, messages):
        """Returns the responses by number, or None if the server cannot respond now."""
        try:
            with LiveClient(self.server, self.model["id"]) as live:
                live.hello()
                for message in messages:
                    live.send(message)
                answers = {}
                while len(answers) < len(messages) - 1:
                    answer = live.receive_until("saved", "unsaved", "problem")
                    if answer["op"] == "problem":
                        assert answer["status"] in (404, 429, 503), answer
                    if answer["op"] != "saved":
                        return None
                    if answer.get("stroke") == messages[0]["stroke"]:
                        answers[answer["n"]] = answer
                return answers
        except (*AWAY, Refused):
            return None
