"""Painters send edits through all nodes while the owner of the model is killed and started again
many times. Every edit that was reported as saved is in the journal once and completely, and the
sequences have no gaps (support/painted_model.py)."""
import os

import pytest
from support.nodes import FAULT_WORDS, NodeHttpPainter, Site
from support.painted_model import LAYERS, PaintedModel
from support.painters import LivePainter
from support.strata_server import wait_for

SEED = int(os.environ.get("STRATA_SEED", "1"))
KILLS = int(os.environ.get("STRATA_NODE_KILLS", "5"))


@pytest.fixture(scope="module")
def site():
    print(f"STRATA_SEED={SEED}")
    with Site(2, SEED) as started:
        yield started


@pytest.fixture(scope="module")
def painted(site):
    return PaintedModel(site, SEED)


@pytest.fixture(scope="module", autouse=True)
def painters(painted):
    """They paint until a case stops them."""
    working = painted.painters([NodeHttpPainter, NodeHttpPainter, LivePainter])
    for painter in working:
        painter.start()
    yield working
    painted.book.stopping.set()


def test_painting_goes_on_while_owners_are_killed(site, painted):
    epochs = []
    for _ in range(KILLS):
        painted.book.wait_for_more(site.random.randint(5, 20))
        owner = wait_for(lambda: site.owner(painted.model["id"]), "a node that owns the model")
        epochs.append(site.epoch(painted.model["id"]))
        owner.kill()
        painted.book.wait_for_more(1)
        owner.start()
    assert epochs == sorted(set(epochs)), f"an epoch did not grow: {epochs}"


def test_every_painter_has_an_answer(painted, painters):
    painted.end_painting(painters)


def test_every_saved_edit_is_in_the_history_once_and_no_other(painted, story):
    story.found = painted.check_saved_once()
    print(f"{len(story.found)} edits survived {KILLS} kills")


def test_saved_edits_that_are_sent_again_get_their_first_answer(site, painted, story):
    for path, edit, key, first in painted.book.repeats[:: max(1, len(painted.book.repeats) // 5)]:
        for node in site.running():
            answer = site.request("POST", path, edit, headers={"Idempotency-Key": key})
            assert (answer.status, answer.json()) == (200, first), (node.node_url, answer, first)
    assert painted.check_history().keys() == story.found.keys()


def test_the_texels_are_those_of_a_replay_at_one_node(painted, story):
    newest = {name: painted.texels(name) for name, *_ in LAYERS}
    for name, raster in newest.items():
        assert (
            raster.digest == painted.texels(name, max(story.found)).digest
        ), f"{name}: now is not the newest sequence"
    painted.server = wait_for(
        lambda: painted.server.owner(painted.model["id"]), "a node that owns the model"
    )
    painted.compare_with_replay(newest)


def test_the_nodes_end_with_clean_logs(site):
    for node in site.running():
        assert node.stop() == 0, "SIGTERM did not end the node well"
        node.assert_clean_log(FAULT_WORDS)
