"""Pages at one node receive the changes that other nodes make: tables, records, comments, tools and
rights. Each page receives only the content that its user may see."""
import time

import pytest
from support.live_client import Closed, LiveClient
from support.meshes import folded_grid
from support.nodes import FAULT_WORDS, Site
from support.pictures import png
from support.strata_server import LONG_S, wait_for

POLICY = 1008
TABLE = "/tables/finds"


@pytest.fixture(scope="module")
def site():
    # The nodes do not check connections at intervals, so only messages can end a connection.
    with Site(2, options=("--recheck-every", "3600")) as started:
        yield started


@pytest.fixture(scope="module")
def model(site):
    return site.import_model(folded_grid(fold=0.001), "grid.ply", unit="mm", name="Grid")


@pytest.fixture(scope="module")
def nodes(site, model):
    """The owner of the model, where the pages are, and the other node."""
    with LiveClient(site.nodes[0], model["id"]) as live:
        live.hello()
    owner = wait_for(lambda: site.owner(model["id"]), "a node that owns the model")
    return owner, next(node for node in site.nodes if node is not owner)


@pytest.fixture(scope="module")
def page(nodes, model):
    with LiveClient(nodes[0], model["id"]) as live:
        live.hello()
        yield live


@pytest.fixture(scope="module")
def ada(nodes):
    return nodes[1].add_person("ada", "annotator")


def next_event(live, op, event):
    """Returns the next message of this kind, which must report this event."""
    message = live.receive_until(op)
    assert message["event"] == event, message
    return message


def closing_code(live):
    end = time.monotonic() + LONG_S
    with pytest.raises(Closed) as closed:
        while True:
            live.receive(end)
    return closed.value.code


def test_tables_and_records(nodes, model, page, ada):
    owner, other = nodes
    with LiveClient(owner, model["id"], token=ada) as hers:
        hers.hello()
        other.ok(
            "POST", "/projects/default/tables", {"name": "Finds", "columns": [{"name": "Name"}]}
        )
        made = next_event(page, "table", "created")
        assert made["table"]["slug"] == "finds" and made["user"] == "owner", made
        next_event(hers, "table", "created")
        other.ok("POST", TABLE + "/columns", {"name": "Hoard", "visibility": "private"})
        for live, columns in ((page, ["name", "hoard"]), (hers, ["name"])):
            changed = next_event(live, "table", "changed")
            assert [column["slug"] for column in changed["table"]["columns"]] == columns, changed

        values = {"name": "bowl", "hoard": "gold"}
        here, there = (
            node.ok("POST", TABLE + "/records", {"records": [{"values": values}]}).json()
            for node in (owner, other)
        )
        keys = [answer["records"][0]["key"] for answer in (here, there)]
        for live, seen in ((page, values), (hers, {"name": "bowl"})):
            created = [next_event(live, "record", "created") for _ in keys]
            assert [message["key"] for message in created] == keys, "each change arrives once"
            for message in created:
                assert message["record"]["values"] == seen, message

        other.ok("PATCH", f"{TABLE}/records/{keys[1]}", {"values": {"name": "cup"}})
        assert next_event(page, "record", "changed")["record"]["values"]["name"] == "cup"
        other.ok("DELETE", f"{TABLE}/records/{keys[1]}")
        assert next_event(page, "record", "deleted")["key"] == keys[1]
        # a change of a column's visibility is not in the journal of the table
        other.ok("PATCH", TABLE + "/columns/name", {"visibility": "team"})
        next_event(page, "table", "changed")
    assert owner.metric("strata_node_messages_received_total") >= 6
    assert other.metric("strata_node_messages_missed_total") == 0


def test_comments_and_tools(site, nodes, model, page):
    _, other = nodes
    thread = site.ok(
        "POST", f"/models/{model['id']}/comments", {"text": "A crack?", "position": [50, 50, 0]}
    ).json()["id"]
    assert next_event(page, "comment", "created")["comment_id"] == thread
    reply = other.ok("POST", f"/comments/{thread}/replies", {"text": "Yes"}).json()["id"]
    message = next_event(page, "comment", "created")
    assert (message["comment_id"], message["comment"]["text"]) == (reply, "Yes"), message
    other.ok("PATCH", f"/comments/{thread}", {"state": "resolved"})
    assert next_event(page, "comment", "changed")["comment"]["state"] == "resolved"
    other.ok("DELETE", f"/comments/{reply}")
    assert next_event(page, "comment", "deleted")["comment_id"] == reply

    shape = png(16, 16, lambda x, y: (255, 255, 255))
    tool = other.ok(
        "POST", "/tools?name=Square+stamp", shape, headers={"Content-Type": "image/png"}
    ).json()
    assert next_event(page, "tool", "created")["tool"]["slug"] == tool["slug"]
    other.ok("DELETE", f"/tools/{tool['id']}")
    assert next_event(page, "tool", "deleted")["tool_id"] == tool["id"]


def test_roles_and_sessions(nodes, model, page, ada):
    owner, other = nodes
    with LiveClient(owner, model["id"], token=ada) as hers:
        assert hers.hello()["role"] == "annotator"
        # A change that does not concern the role leaves the connection open.
        other.ok("PATCH", "/users/ada", {"full_name": "Ada"})
        other.ok("PATCH", "/users/ada", {"role": "viewer"})
        assert closing_code(hers) == POLICY
    with LiveClient(owner, model["id"], token=ada) as hers:
        assert hers.hello()["role"] == "viewer", "the cached role is no longer used"
        other.ok("PATCH", "/users/ada", {"disabled": True})
        assert closing_code(hers) == POLICY
    assert owner.get("/me", token=ada).status == 401
    # The connection of another user is still open.
    other.ok("POST", TABLE + "/records", {"records": [{"values": {"name": "jug"}}]})
    next_event(page, "record", "created")


def test_the_nodes_end_with_clean_logs(site):
    for node in site.nodes:
        assert node.stop() == 0, "SIGTERM did not end the node well"
        node.assert_clean_log(FAULT_WORDS)
