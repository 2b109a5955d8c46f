"""The owner of a model is killed while people paint through all nodes and the nodes merge strokes.
Every edit that was reported as saved stays complete, and keeps its response."""
import os

import pytest
from support.merged_model import OPTIONS, MergedModel
from support.nodes import FAULT_WORDS, NodeHttpPainter, Site
from support.painted_model import LAYERS
from support.painters import LivePainter
from support.strata_server import wait_for

SEED = int(os.environ.get("STRATA_SEED", "1"))
KILLS = int(os.environ.get("STRATA_MERGE_KILLS", "2"))


@pytest.fixture(scope="module")
def site():
    print(f"STRATA_SEED={SEED}")
    with Site(2, SEED, options=OPTIONS) as started:
        yield started


@pytest.fixture(scope="module")
def painted(site):
    return MergedModel(site, SEED, site.postgres.sql)


@pytest.fixture(scope="module", autouse=True)
def painters(painted):
    """They paint until a case stops them."""
    working = painted.painters([NodeHttpPainter, LivePainter, LivePainter])
    for painter in working:
        painter.start()
    yield working
    painted.book.stopping.set()


def test_strokes_that_are_merged_survive_kills_of_owners(site, painted):
    for _ in range(KILLS):
        painted.book.wait_for_more(5)
        painted.remember()
        painted.wait_for_merge()
        owner = wait_for(lambda: site.owner(painted.model["id"]), "a node that owns the model")
        owner.kill()
        painted.book.wait_for_more(1)
        owner.start()


def test_every_painter_has_an_answer(painted, painters):
    painted.end_painting(painters)


def test_every_saved_edit_is_in_the_history_as_a_part_of_its_stroke(painted):
    found = painted.check_history()
    assert len(found) < len(painted.book.edits)
    print(f"{len(painted.book.edits)} edits survived in {len(found)} rows")


def test_batches_that_are_sent_again_get_their_first_response(painted):
    painted.check_repeats(5)
    painted.check_history()


def test_the_texels_are_those_of_a_replay_at_one_node(site, painted):
    painted.check_states()
    newest = {name: painted.texels(name) for name, *_ in LAYERS}
    painted.server = wait_for(lambda: site.owner(painted.model["id"]), "a node that owns the model")
    painted.compare_with_replay(newest)


def test_the_nodes_end_with_clean_logs(site):
    for node in site.running():
        assert node.stop() == 0, "SIGTERM did not end the node well"
        node.assert_clean_log([*FAULT_WORDS, "strokes could not be merged, trying again"])
