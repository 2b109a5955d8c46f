"""The server and then its PostgreSQL are killed while people paint and the server merges strokes.
Every edit that was reported as saved stays complete, and keeps its response."""
import os
import signal

import pytest
from support.merged_model import OPTIONS, MergedModel
from support.painted_model import LAYERS
from support.painters import HttpPainter, LivePainter
from support.strata_server import StrataServer, wait_for

SEED = int(os.environ.get("STRATA_SEED", "1"))
KILLS = int(os.environ.get("STRATA_MERGE_KILLS", "2"))  # the number of kills of each kind
# Messages that the log may contain while PostgreSQL is killed.
FAULT_WORDS = [
    "PostgreSQL stopped",
    "unexpected postmaster exit",
    "a commit failed and is tried again",
    "undid",
    "could not be loaded again",
    "could not be kept for repeats",
    "strokes could not be merged, trying again",
]


@pytest.fixture(scope="module")
def server():
    with StrataServer(options=OPTIONS) as started:
        yield started


@pytest.fixture(scope="module")
def painted(server):
    print(f"STRATA_SEED={SEED}")
    return MergedModel(server, SEED, server.sql)


@pytest.fixture(scope="module", autouse=True)
def painters(painted):
    """They paint until a case stops them."""
    working = painted.painters([HttpPainter, LivePainter, LivePainter])
    for painter in working:
        painter.start()
    yield working
    painted.book.stopping.set()


def kill_server(server):
    server.kill()
    server.start()


def kill_database(server):
    pid = wait_for(server.postmaster, "a postmaster")
    os.kill(pid, signal.SIGKILL)
    wait_for(lambda: server.postmaster() not in (None, pid), "PostgreSQL to be started again")


def test_strokes_that_are_merged_survive_kills(server, painted):
    for kill in [kill_server] * KILLS + [kill_database] * KILLS:
        painted.book.wait_for_more(5)
        painted.remember()
        painted.wait_for_merge()
        kill(server)
        painted.book.wait_for_more(1)


def test_every_painter_has_an_answer(painted, painters):
    painted.end_painting(painters)


def test_every_saved_edit_is_in_the_history_as_a_part_of_its_stroke(painted):
    found = painted.check_history()
    assert len(found) < len(painted.book.edits)
    print(f"{len(painted.book.edits)} edits survived in {len(found)} rows")


def test_batches_that_are_sent_again_get_their_first_response(painted):
    painted.check_repeats(5)
    painted.check_history()


def test_the_texels_are_those_of_a_replay_without_faults(painted):
    painted.check_states()
    painted.compare_with_replay({name: painted.texels(name) for name, *_ in LAYERS})


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0, "SIGTERM did not end the server well"
    server.assert_clean_log(FAULT_WORDS)
