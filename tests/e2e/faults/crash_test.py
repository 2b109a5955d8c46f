"""The server is killed under load several times, and then its PostgreSQL is killed. Every edit that
was reported as saved is stored once and completely.

At the end the history and the texels are compared with a replay (support/painted_model.py). Before
and after each kill, the test reads states at earlier sequences."""
import os
import random
import signal

import pytest
from support.painted_model import LAYERS, PaintedModel
from support.painters import HttpPainter, LivePainter
from support.strata_server import wait_for

SEED = int(os.environ.get("STRATA_SEED", "1"))
KILLS = int(os.environ.get("STRATA_CRASH_KILLS", "8"))  # the number of kills of each kind
# Messages that the log may contain while PostgreSQL is killed.
FAULT_WORDS = [
    "PostgreSQL stopped",
    "unexpected postmaster exit",
    "a commit failed and is tried again",
    "undid",
    "could not be loaded again",
    "could not be kept for repeats",
]


class Crashes(PaintedModel):
    def __init__(self, server):
        super().__init__(server, SEED)
        self.random = random.Random(SEED)
        self.known = {}  # (layer, sequence) -> digest of the texels

    def remember(self):
        """Records digests of the texels at some acknowledged sequences, including the newest
        one."""
        with self.book.lock:
            sequences = sorted(self.book.edits)
        for at in {sequences[-1], self.random.choice(sequences)}:
            layer = self.book.edits[at][0]
            digest = self.texels(layer, at).digest
            assert self.known.setdefault((layer, at), digest) == digest, f"{layer} at {at} changed"

    def check_known(self):
        for layer, at in self.random.sample(sorted(self.known), min(2, len(self.known))):
            assert (
                self.texels(layer, at).digest == self.known[layer, at]
            ), f"{layer} at {at} is not what it was before the kill"

    def check_repeats(self):
        """Sends saved edits again. They get their first response, and the history does not
        change."""
        with self.book.lock:
            sample = self.random.sample(self.book.repeats, min(3, len(self.book.repeats)))
        for path, edit, key, first in sample:
            answer = wait_for(
                lambda: (lambda a: a if a.status != 503 else None)(
                    self.server.post(path, edit, headers={"Idempotency-Key": key})
                ),
                "a repeat",
            )
            assert (answer.status, answer.json()) == (200, first), (answer, first)

    def check_whole(self, sequence):
        """Checks that an edit is complete: the number of changed texels, and their value."""
        layer, edit, answer = self.book.edits[sequence]
        changes = self.texels(layer, sequence).differences(self.texels(layer, sequence - 1))
        # the raster also contains the gutter, which the count omits
        assert len(changes) >= answer["texels_changed"], (sequence, len(changes), answer)
        assert bool(changes) == (answer["texels_changed"] > 0), sequence
        wanted = (0, False) if edit.get("erase") else (edit["value"], True)
        wrong = [now for now, _ in changes if now != wanted]
        assert not wrong, f"edit {sequence} left {wrong[:3]} beside {wanted}"

    def kill_server(self):
        self.server.kill()
        self.server.start()

    def kill_database(self):
        pid = wait_for(self.server.postmaster, "a postmaster")
        os.kill(pid, signal.SIGKILL)
        wait_for(
            lambda: self.server.postmaster() not in (None, pid), "PostgreSQL to be started again"
        )

    def survive(self, kill):
        """Checks that each of many kills leaves all recorded states unchanged, while users
        paint."""
        for _ in range(KILLS):
            self.book.wait_for_more(self.random.randint(8, 40))
            self.remember()
            kill()
            self.book.wait_for_more(1)
            self.check_known()
            self.check_repeats()


@pytest.fixture(scope="module")
def crashes(server):
    print(f"STRATA_SEED={SEED}")
    return Crashes(server)


@pytest.fixture(scope="module", autouse=True)
def painters(crashes):
    """The painters of a case. They paint until their case stops them."""
    painters = crashes.painters([HttpPainter] * 4 + [LivePainter] * 2)
    for painter in painters:
        painter.start()
    yield painters
    crashes.book.stopping.set()


def test_what_was_saved_survives_kills_of_the_server(crashes):
    crashes.survive(crashes.kill_server)


def test_what_was_saved_survives_kills_of_the_database(crashes):
    crashes.survive(crashes.kill_database)


def test_every_painter_has_an_answer(crashes, painters):
    crashes.end_painting(painters)


def test_every_edit_is_in_the_history_once_and_no_other(crashes, story):
    story.found = crashes.check_history()
    assert sorted(story.found) == sorted(
        crashes.book.edits
    ), "an edit is in the history that nobody sent"
    print(f"{len(story.found)} edits survived; {len(crashes.known)} old states were compared")


def test_edits_are_in_their_layers_wholly(crashes):
    for sequence in crashes.random.sample(sorted(crashes.book.edits), 12):
        crashes.check_whole(sequence)


def test_the_texels_are_those_of_a_replay_without_faults(crashes, story):
    newest = {name: crashes.texels(name) for name, *_ in LAYERS}
    for name, raster in newest.items():
        assert (
            raster.digest == crashes.texels(name, max(story.found)).digest
        ), f"{name}: now is not the newest sequence"
    crashes.compare_with_replay(newest)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0, "SIGTERM did not end the server well"
    server.assert_clean_log(FAULT_WORDS)
