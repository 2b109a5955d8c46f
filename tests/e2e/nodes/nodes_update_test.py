"""The nodes of a site are updated one after the other while people paint.

The newer version is the same program with other files: a copy of the migrations with one more,
which is readable for the older version. So these cases cover the update of the database, the drain
of the nodes, and nodes of both versions at one database. They do not cover changes of the program
itself.
"""
import os
import shutil
import tempfile

import pytest
from support.meshes import folded_grid
from support.nginx import ROOT
from support.nodes import FAULT_WORDS, NodeHttpPainter, Site
from support.painted_model import PaintedModel
from support.painters import LivePainter
from support.strata_server import wait_for

SEED = int(os.environ.get("STRATA_SEED", "1"))

# Programs of the older version still insert into `edits`, without a value for the new column.
MIGRATION = """-- migrate:up
-- readable-from: {newest}
ALTER TABLE edits ADD COLUMN of_next_version text;
CREATE TABLE next_version (n int);
"""


class NextVersion:
    """A folder for STRATA_SHARE."""

    def __init__(self, folder):
        self.folder = folder
        files = os.environ.get("STRATA_SHARE", ROOT)
        for name in ("shaders", "web-client", "protocol", "templates"):
            os.symlink(os.path.join(files, name), os.path.join(folder, name))
        migrations = os.path.join(folder, "db", "migrations")
        shutil.copytree(os.path.join(files, "db", "migrations"), migrations)
        newest = max(int(name.split("_")[0]) for name in os.listdir(migrations))
        self.schema = f"{newest + 1:06}"
        added = os.path.join(migrations, f"{self.schema}_next_version.sql")
        with open(added, "w", encoding="ascii") as file:
            file.write(MIGRATION.format(newest=newest))

    def runs_at(self, node):
        with open(f"/proc/{node.process.pid}/environ", "rb") as file:
            return f"STRATA_SHARE={self.folder}".encode() in file.read().split(b"\0")


@pytest.fixture(scope="module")
def newer():
    with tempfile.TemporaryDirectory(prefix="strata-next-", dir="/tmp") as folder:
        yield NextVersion(folder)


@pytest.fixture(scope="module")
def site():
    print(f"STRATA_SEED={SEED}")
    with Site(3, SEED) as started:
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


def older_nodes(site, newer):
    return [node for node in site.nodes if not newer.runs_at(node)]


def update(node, painted, newer):
    """Replaces the node while people paint."""
    painted.book.wait_for_more(10)
    assert node.stop() == 0, "SIGTERM did not end the node well"
    node.share = newer.folder
    node.start()
    wait_for(node.is_ready, "the new node to be ready")
    painted.book.wait_for_more(10)


def newest_schema(site):
    return site.postgres.sql("SELECT max(version) FROM schema_migrations")


def test_the_first_new_node_updates_the_database_while_the_others_work(site, painted, newer):
    assert newest_schema(site) < newer.schema
    # the owner, so an older node takes the model over before the database is updated
    owner = wait_for(lambda: site.owner(painted.model["id"]), "a node that owns the model")
    update(owner, painted, newer)
    assert newest_schema(site) == newer.schema
    assert len(older_nodes(site, newer)) == 2


def test_an_older_node_starts_again_with_the_newer_database(site, painted, newer):
    node = older_nodes(site, newer)[0]
    node.kill()
    del node.log[:]
    painted.book.wait_for_more(1)
    node.start()
    wait_for(node.is_ready, "the older node to be ready")
    assert any("newer than this program" in line for line in node.log), node.log
    painted.book.wait_for_more(10)


def test_older_nodes_save_edits_in_the_newer_database(site, newer):
    for number, node in enumerate(older_nodes(site, newer)):
        own = node.import_model(folded_grid(9), "own.ply", unit="mm", name=f"Own {number}")
        layers = f"/models/{own['id']}/layers"
        node.ok("POST", layers, {"name": "marks", "type": "u8"})
        edit = {"op": "fill", "mode": "where", "where": "true", "value": 7}
        node.ok("POST", f"{layers}/marks/edits", edit)
        assert site.owner(own["id"]) is node


def test_painting_goes_on_while_the_other_nodes_are_updated(site, painted, newer):
    while older := older_nodes(site, newer):
        owner = wait_for(lambda: site.owner(painted.model["id"]), "a node that owns the model")
        update(owner if owner in older else older[0], painted, newer)
    assert all(newer.runs_at(node) for node in site.running()) and len(site.running()) == 3


def test_every_saved_edit_is_in_the_history_once_and_no_other(painted, painters):
    painted.end_painting(painters)
    found = painted.check_saved_once()
    print(f"{len(found)} edits survived the update")


def test_the_nodes_end_with_clean_logs(site):
    for node in site.running():
        assert node.stop() == 0, "SIGTERM did not end the node well"
        # While a node drains, another one may claim a model before the room has closed.
        node.assert_clean_log(FAULT_WORDS)
