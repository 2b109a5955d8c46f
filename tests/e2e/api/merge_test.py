"""Some seconds after strokes have ended, the server merges their batches in the journal, and packs
the revisions of each tile. States, the responses to repeated batches, undo and a restart give the
same results as before."""
import json
import uuid

import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.merges import MARKED_LONG_AGO
from support.meshes import folded_grid
from support.strata_server import StrataServer, wait_for

M = "/models/sheet"
L = M + "/layers/cracks"
STROKES, BATCHES = 3, 6
REVISIONS = 34  # more than a segment contains


@pytest.fixture(scope="module")
def server():
    # A stroke is merged in two parts if its author pauses for longer than this time.
    with StrataServer(options=["--merge-after", "5"]) as started:
        started.sql(MARKED_LONG_AGO)
        started.import_model(
            folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
        )
        started.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
        yield started


@pytest.fixture(scope="module")
def camera(server):
    return camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))


def texels(server, at):
    return server.ok("GET", f"{L}/texels.npy?at={at}").body


def history(server):
    return server.ok("GET", L + "/edits?limit=1000").json()


def begin(live, stroke, number, camera):
    live.send(
        {
            "op": "stroke.begin",
            "id": str(uuid.uuid4()),
            "stroke": stroke,
            "layer": "cracks",
            "value": number + 1,
            "erase": False,
            "camera": camera,
            "radius_px": 12,
        }
    )


def extend(live, stroke, n, path, edit):
    live.send({"op": "stroke.extend", "id": edit, "stroke": stroke, "n": n, "path": path})
    return live.receive_until("saved")


def path_of(number, n):
    return [[150 + 25 * n + k, 150 + 40 * number + 8 * k] for k in range(3)]


def test_strokes_become_one_edit_each(server, camera, story):
    """The connection stays open, so the room stays open until the strokes are merged."""
    story.saved, story.states = {}, {0: texels(server, 0)}
    with LiveClient(server, "sheet") as live:
        live.hello()
        for number in range(STROKES):
            stroke = str(uuid.uuid4())
            begin(live, stroke, number, camera)
            for n in range(BATCHES):
                edit = str(uuid.uuid4())
                answer = extend(live, stroke, n, path_of(number, n), edit)
                story.saved[edit] = (stroke, n, answer)
            live.send({"op": "stroke.end", "id": str(uuid.uuid4()), "stroke": stroke})
            story.states[answer["sequence"]] = texels(server, answer["sequence"])
        merged = wait_for(
            lambda: (lambda page: page if page["total"] == STROKES else None)(history(server)),
            "the strokes to be merged",
        )["edits"]
    assert [edit["sequence"] for edit in merged] == sorted(story.states, reverse=True)[:-1]
    for edit, number in zip(reversed(merged), range(STROKES)):
        batches = [answer for stroke, _, answer in story.saved.values() if stroke == edit["stroke"]]
        assert edit["texels_changed"] == sum(each["texels_changed"] for each in batches)
        drawn = [point for n in range(BATCHES) for point in path_of(number, n)]
        record = json.loads(
            server.sql(f"SELECT record FROM edits WHERE sequence = {edit['sequence']}")
        )
        assert record["path"] == drawn and record["n"] == BATCHES - 1, record


def test_every_state_is_as_before(server, story):
    for at, state in story.states.items():
        assert texels(server, at) == state, f"the state after edit {at} changed"
    ends = sorted(story.states)
    assert texels(server, ends[1] + 1) == story.states[ends[1]], "a stroke counts from its end"
    steps = server.ok("GET", M + "/timeline/steps").json()["steps"]
    assert [(step["first"], step["last"]) for step in steps] == [
        (before + 1, end) for before, end in zip(ends, ends[1:])
    ]


def test_batches_that_are_sent_again_get_their_first_response(server, camera, story):
    with LiveClient(server, "sheet") as live:
        live.hello()
        for edit, (stroke, n, first) in story.saved.items():
            number = list(dict.fromkeys(s for s, _, _ in story.saved.values())).index(stroke)
            if n == 0:
                begin(live, stroke, number, camera)
            again = extend(live, stroke, n, path_of(number, n), edit)
            for member in ("stroke", "n", "sequence", "texels_changed", "area_m2"):
                assert again[member] == first[member], (again, first)
    assert history(server)["total"] == STROKES


def test_undo_takes_whole_strokes_also_after_a_restart(server, story):
    assert server.stop() == 0
    server.start()
    ends = sorted(story.states, reverse=True)
    for undone, before in zip(ends, ends[1:]):
        answer = server.ok("POST", L + "/undo").json()
        assert texels(server, answer["sequence"]) == story.states[before], f"undo of {undone}"
    for end in reversed(ends[:-1]):
        answer = server.ok("POST", L + "/redo").json()
        assert texels(server, answer["sequence"]) == story.states[end], f"redo of {end}"
    for at, state in story.states.items():
        assert texels(server, at) == state


def stroke(camera, n):
    path = [[300, 300], [320 + n, 310]]
    return {"op": "stroke", "value": n + 1, "camera": camera, "radius_px": 9, "path": path}


def test_packed_revisions_give_the_same_states(server, camera):
    states = {}
    for n in range(REVISIONS):
        answer = server.ok("POST", L + "/edits", stroke(camera, n)).json()
        # Reading a state takes longer than painting. Undo needs the last three.
        if n % 5 == 0 or n >= REVISIONS - 3:
            states[answer["sequence"]] = texels(server, answer["sequence"])
    # A server counts the revisions of a layer at its first merge.
    assert server.stop() == 0
    server.start()
    last = server.ok("POST", L + "/edits", stroke(camera, REVISIONS)).json()["sequence"]
    wait_for(
        lambda: int(server.sql("SELECT count(*) FROM tile_segments")) > 0,
        "the revisions to be packed",
    )
    for at, state in states.items():
        assert texels(server, at) == state, f"the state after edit {at} changed"
    for before in sorted(states, reverse=True)[:3]:
        answer = server.ok("POST", L + "/undo").json()
        assert texels(server, answer["sequence"]) == states[before], f"undo to {before}"
    assert texels(server, last) != states[max(states)]
    server.assert_clean_log()
