"""Viewers and kiosks at a node that does not own a model: the node follows the journal and draws for
them, and never becomes the owner. People who can paint are sent to the owner. People at both nodes
see each other."""
import time
import uuid

import pytest
from support.cameras import camera_from
from support.live_client import LAST_RECTANGLE, Closed, LiveClient
from support.meshes import folded_grid
from support.nodes import FAULT_WORDS, Site
from support.strata_server import LONG_S, wait_for

MOVED, POLICY = 4307, 1008


@pytest.fixture(scope="module")
def site():
    with Site(2) as started:
        yield started


@pytest.fixture(scope="module")
def model(site):
    made = site.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
    site.ok("POST", f"/models/{made['id']}/layers", {"name": "marks", "type": "u8"})
    return made


@pytest.fixture(scope="module")
def nodes(site, model):
    """The owner of the model, and the other node."""
    site.ok("GET", f"/models/{model['id']}/layers/marks/texels.npy")
    owner = wait_for(lambda: site.owner(model["id"]), "a node that owns the model")
    return owner, next(node for node in site.nodes if node is not owner)


@pytest.fixture(scope="module")
def vera(nodes):
    return nodes[0].add_person("vera", "viewer")


@pytest.fixture
def stays(site, model, nodes):
    """The model has the same owner and the same claim at the end."""
    epoch = site.epoch(model["id"])
    yield
    assert site.owner(model["id"]) is nodes[0]
    assert site.epoch(model["id"]) == epoch


def view(model):
    return camera_from(model, (0, -0.2, 1))


def paint(owner, model, value):
    """Returns the sequence of the edit, which is saved."""
    edit = {
        "op": "stroke",
        "camera": view(model),
        "radius_px": 8,
        "path": [[320, 200], [350, 240]],
        "value": value,
    }
    path = f"/models/{model['id']}/layers/marks/edits"
    key = {"Idempotency-Key": str(uuid.uuid4())}
    return owner.ok("POST", path, edit, headers=key).json()["sequence"]


def watch(live, model):
    """Begins a view."""
    live.send({"op": "camera", "seq": 1, "moving": False, **view(model)})
    while True:
        frame = live.receive_until("frame")
        if frame["flags"] & LAST_RECTANGLE:
            return


def until_shown(live, sequence):
    """Returns when a frame shows this edit. Prints the time that this took."""
    begun = time.monotonic()
    while live.receive_until("frame")["scene_sequence"] < sequence:
        pass
    print(f"edit {sequence} was shown after {1000 * (time.monotonic() - begun):.0f} ms")


def value_at(live, model):
    """Returns the value of the layer in the middle of the stroke, at the node of the connection."""
    live.send({"op": "pick", "id": "middle", "camera": view(model), "x": 335, "y": 220})
    picked = live.receive_until("picked")
    assert picked["hit"], picked
    value = picked["values"]["marks"]
    return value["value"] if value["valid"] else None


def person_when(live, name, is_expected):
    """Returns the person with this name when the person is as expected. `is_expected` gets None
    while the person is not present. A person can be present twice: a connection that was just closed
    is listed for a moment."""
    while True:
        users = live.receive_until("presence")["users"]
        for person in [user for user in users if user["name"] == name] or [None]:
            if is_expected(person):
                return person


def next_event(live, event):
    message = live.receive_until("layer")
    assert message["event"] == event, message
    return message


def test_a_viewer_sees_what_is_painted_at_the_owner(model, nodes, vera, stays):
    owner, other = nodes
    with LiveClient(other, model["id"], token=vera) as live:
        assert live.hello()["role"] == "viewer"
        watch(live, model)
        assert other.metric("strata_followed_models") == 1
        assert owner.metric("strata_followed_models") == 0
        assert value_at(live, model) is None
        for value in (7, 8):
            sequence = paint(owner, model, value)
            edited = next_event(live, "edited")
            assert (edited["sequence"], edited["user"]) == (sequence, "owner"), edited
            until_shown(live, sequence)
            assert value_at(live, model) == value
        undone = owner.ok(
            "POST",
            f"/models/{model['id']}/layers/marks/undo",
            headers={"Idempotency-Key": str(uuid.uuid4())},
        ).json()["sequence"]
        assert next_event(live, "edited")["sequence"] == undone
        until_shown(live, undone)
        assert value_at(live, model) == 7

        layers = f"/models/{model['id']}/layers"
        owner.ok("POST", layers, {"name": "late", "type": "u16"})
        assert next_event(live, "created")["layer"]["slug"] == "late"
        owner.ok("PATCH", layers + "/late", {"opacity": 0.5})
        assert next_event(live, "changed")["layer"]["opacity"] == 0.5
        owner.ok("DELETE", layers + "/late")
        next_event(live, "deleted")

        # what a viewer may not do is refused as at the owner
        live.send({"op": "undo", "id": str(uuid.uuid4()), "layer": "marks"})
        assert live.receive_until("problem")["status"] == 403
        assert 0 < other.metric("strata_follower_lag_seconds") < LONG_S


def test_people_at_both_nodes_see_each_other(model, nodes, vera, stays):
    owner, other = nodes
    with LiveClient(other, model["id"], token=vera) as viewer:
        viewing = viewer.hello()["session"]
        watch(viewer, model)
        with LiveClient(owner, model["id"]) as painter:
            painting = painter.hello()["session"]
            person_when(painter, "vera", lambda person: person and person["session"] == viewing)
            person_when(viewer, "owner", lambda person: person and person["session"] == painting)
            watch(painter, model)

            painter.send({"op": "presence", "pointer": [335, 220], "radius": 2, "leading": True})
            seen = person_when(viewer, "owner", lambda person: person and "pointer" in person)
            assert seen["pointer"]["radius"] == 2 and seen["leading"], seen
            assert "camera" not in seen, "only followers receive a camera"
            viewer.send({"op": "presence", "pointer": [335, 220], "follow": painting})
            seen = person_when(painter, "vera", lambda person: person and "pointer" in person)
            assert seen["following"] == painting, seen

            turned = camera_from(model, (0.3, -0.2, 1))
            painter.send({"op": "camera", "seq": 2, "moving": False, **turned})
            person_when(
                viewer,
                "owner",
                lambda person: person and person.get("camera", {}).get("view") == turned["view"],
            )
            painter.send({"op": "presence", "follow": viewing})
            assert painter.receive_until("problem")["status"] == 409
        person_when(viewer, "owner", lambda person: person is None)
        viewer.send({"op": "presence", "follow": painting})
        assert viewer.receive_until("problem")["status"] == 404


def test_people_who_can_paint_are_sent_to_the_owner(model, nodes, stays):
    owner, other = nodes
    with LiveClient(other, model["id"]) as live:
        assert live.receive_until("moved")["url"] == owner.node_url
        with pytest.raises(Closed) as closed:
            live.receive()
        assert closed.value.code == MOVED


def test_a_viewer_who_becomes_an_annotator_is_sent_to_the_owner(model, nodes, stays):
    owner, other = nodes
    token = owner.add_person("ada", "annotator")  # so that the token may annotate later
    owner.ok("PATCH", "/users/ada", {"role": "viewer"})
    with LiveClient(other, model["id"], token=token) as live:
        assert live.hello()["role"] == "viewer"
        owner.ok("PATCH", "/users/ada", {"role": "annotator"})
        with pytest.raises(Closed) as closed:
            while True:
                live.receive(time.monotonic() + LONG_S)
        assert closed.value.code == POLICY
    with LiveClient(other, model["id"], token=token) as live:
        live.receive_until("moved")


def test_a_kiosk_is_shown_the_model(model, nodes, stays):
    owner, other = nodes
    path = f"/models/{model['id']}"
    owner.ok("POST", path + "/views", {"name": "Front", "camera": view(model), "layers": []})
    tour = owner.ok(
        "POST",
        path + "/tours",
        {
            "name": "Round",
            "text": "For all.",
            "languages": ["en"],
            "idle_s": 90,
            "stops": [{"view": "front", "title": {"en": "Front"}}],
        },
    ).json()["slug"]
    made = owner.ok("POST", f"{path}/tours/{tour}/kiosks", {"name": "Hall"}).json()
    secret = made["path"].rpartition("/")[2]
    with LiveClient(other, model["id"], token=secret) as live:
        live.hello(dpr=1, accept=["jpeg"])
        watch(live, model)
        until_shown(live, paint(owner, model, 9))


def test_viewers_stay_when_the_owner_ends_and_move_when_their_node_owns_the_model(
    site, model, nodes, vera
):
    owner, other = nodes
    with LiveClient(other, model["id"], token=vera) as live:
        live.hello()
        watch(live, model)
        assert owner.stop() == 0
        assert value_at(live, model) == 9
        sequence = paint(other, model, 10)  # so the follower's node claims the model
        live.receive_until("moved")
    assert site.owner(model["id"]) is other
    with LiveClient(other, model["id"], token=vera) as live:
        live.hello()
        assert value_at(live, model) == 10
    last = site.postgres.sql(f"SELECT sequence FROM models WHERE id = {model['id']}")
    assert last == str(sequence), "only owners have written to the journal"


def test_the_nodes_end_with_clean_logs(site, nodes):
    owner, other = nodes
    assert other.stop() == 0
    for node in (owner, other):
        node.assert_clean_log(FAULT_WORDS)
