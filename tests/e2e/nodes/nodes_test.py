"""Several nodes over one PostgreSQL: requests reach the node that has a model, and a model moves to
another node when its node is killed, frozen or stopped. A node without the database still draws for
its viewers. Times are printed, because the machine of a test may be slow."""
import http.client
import json
import os
import signal
import socket
import subprocess
import time
import uuid
from types import SimpleNamespace

import pytest
from support.cameras import camera_from
from support.live_client import AWAY, LAST_RECTANGLE, Closed, LiveClient, Refused
from support.meshes import folded_grid
from support.nginx import Nginx, free_port
from support.nodes import FAULT_WORDS, Site
from support.strata_server import LONG_S, StrataServer, wait_for

MOVED = 4307


@pytest.fixture(scope="module")
def site():
    with Site(2) as started:
        yield started


@pytest.fixture(scope="module")
def model(site):
    made = site.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
    site.ok("POST", f"/models/{made['id']}/layers", {"name": "marks", "type": "u8"})
    return made


def owner_and_other(site, model):
    """Returns a node that owns the model, and one that does not."""
    site.ok("GET", f"/models/{model['id']}/layers/marks/texels.npy")
    owner = wait_for(lambda: site.owner(model["id"]), "a node that owns the model")
    return owner, next(node for node in site.running() if node is not owner)


def stroke(model, value=1, x=320):
    return {
        "op": "stroke",
        "camera": camera_from(model, (0, -0.2, 1)),
        "radius_px": 8,
        "path": [[x, 200], [x + 30, 240]],
        "value": value,
    }


def edit_at(node, model, key=None, value=1):
    return node.post(
        f"/models/{model['id']}/layers/marks/edits",
        stroke(model, value),
        headers={"Idempotency-Key": key or str(uuid.uuid4())},
    )


def live_edit(live, model, value=1):
    """Sends an edit over a live connection. Returns its id."""
    edit_id = str(uuid.uuid4())
    live.send({"op": "edit", "id": edit_id, "layer": "marks", "edit": stroke(model, value)})
    return edit_id


def saved(live, edit_id):
    """Returns the message that reports this edit as saved."""
    while True:
        message = live.receive_until("saved", "unsaved", "problem")
        assert message["op"] == "saved", message
        if message.get("id") == edit_id:
            return message


def until_database(live, reachable):
    """Waits until the node reports that it has lost its database, or has it again."""
    while live.receive_until("database")["reachable"] is not reachable:
        pass


def turn(live, model, seq):
    """Turns the view, and returns when a frame shows it."""
    camera = camera_from(model, (seq / 20, -0.2, 1), 320, 240)
    live.send({"op": "camera", "seq": seq, "moving": False, **camera})
    while True:
        frame = live.receive_until("frame")
        if frame["camera_seq"] == seq and frame["flags"] & LAST_RECTANGLE:
            return


def until_moved(live):
    """Returns the messages until the connection ends, which must be for a move."""
    messages = []
    with pytest.raises(Closed) as closed:
        while True:
            messages.append(live.receive())
    assert closed.value.code == MOVED, closed.value
    assert messages and messages[-1]["op"] == "moved", messages[-3:]
    return messages


def history_ids(site, model):
    rows = site.ok("GET", f"/models/{model['id']}/layers/marks/edits?limit=1000").json()["edits"]
    return [row["id"] for row in rows]


def paint_soon(site, model, begun):
    """Paints as soon as a node accepts it. Prints and returns the time since `begun`."""
    key = str(uuid.uuid4())
    answer = site.post(
        f"/models/{model['id']}/layers/marks/edits",
        stroke(model, 2),
        headers={"Idempotency-Key": key},
    )
    assert answer.status == 200, answer
    return time.monotonic() - begun


def test_a_request_at_the_wrong_node_is_redirected(site, model):
    owner, other = owner_and_other(site, model)
    path = f"/models/{model['id']}/layers?limit=5"
    answer = other.get(path)
    assert answer.status == 307, answer
    assert answer.headers["Location"] == f"{owner.node_url}/api/v1{path}"
    problem = answer.json()
    assert problem["type"] == "/problems#moved" and problem["detail"], problem
    assert owner.get(path).status == 200
    # the same for the slug, and for every address below the model
    for there in (
        f"/models/{model['slug']}",
        f"/models/{model['slug']}/comments",
        f"/models/{model['id']}/layers/marks/edits",
    ):
        assert other.get(there).status == 307, there
        assert owner.get(there).status == 200, there
    assert other.get(f"/me/models/{model['id']}/view").status == 307


def test_other_requests_are_answered_by_any_node(site, model):
    for node in site.nodes:
        for path in ("/me", "/projects", "/models", "/tools", "/nodes", "//readyz"):
            assert node.get(path).status == 200, path
        assert node.get("/models/nothing-here").status == 404
        assert node.get(f"/models/{model['id']}", token=False).status == 401
        assert node.get(f"/models/{model['id']}", token="x" * 40).status == 401


def test_curl_follows_the_redirection_with_its_body(site, model):
    _, other = owner_and_other(site, model)
    key = str(uuid.uuid4())
    # curl sends Authorization to another port only with --location-trusted
    told = [
        *("curl", "-sS", "--location-trusted", "-o", "-", "-w", "\n%{http_code} %{num_redirects}"),
        *("-H", f"Authorization: Bearer {site.token}", "-H", f"Idempotency-Key: {key}"),
        *("-H", "Content-Type: application/json", "-d", json.dumps(stroke(model))),
        f"{other.url}/api/v1/models/{model['id']}/layers/marks/edits",
    ]
    first, again = (
        subprocess.run(told, check=True, capture_output=True, text=True).stdout.rsplit("\n", 1)
        for _ in range(2)
    )
    assert first[1] == "200 1" and again[1] == "200 1", (first, again)
    assert json.loads(first[0])["sequence"] == json.loads(again[0])["sequence"], "painted twice"


def test_a_redirected_key_is_free_for_the_owner(site, model):
    owner, other = owner_and_other(site, model)
    key, before = str(uuid.uuid4()), len(history_ids(site, model))
    assert edit_at(other, model, key).status == 307
    assert edit_at(other, model, key, value=3).status == 307  # another body: the key is still free
    done = edit_at(owner, model, key)
    assert done.status == 200, done
    assert edit_at(owner, model, key).json() == done.json()
    assert len(history_ids(site, model)) == before + 1


def test_a_request_whose_path_does_not_name_the_model_is_redirected_once(site, model):
    owner, other = owner_and_other(site, model)
    spare = owner.ok("POST", f"/models/{model['id']}/layers", {"name": "Spare", "type": "u8"})
    layer = spare.json()["id"]
    owner.ok(
        "DELETE",
        f"/models/{model['id']}/layers/{layer}",
        headers={"If-Match": spare.headers["ETag"]},
    )
    path = f"/projects/default/bin/layer-{layer}/restore"
    answer = other.post(path)
    assert answer.status == 307, answer
    assert answer.headers["Location"] == f"{owner.node_url}/api/v1{path}?moved=1"
    assert other.post(path + "?moved=1").status == 503
    assert owner.post(path + "?moved=1").status == 200
    assert owner.get(f"/models/{model['id']}/layers/{layer}").status == 200


def test_a_job_is_found_through_any_node(site):
    first, second = site.nodes
    asked = "/models?filename=sheet.ply&unit=mm&name=Sheet"
    job = first.ok("POST", asked, folded_grid(9)).json()["id"]
    answer = second.get(f"/jobs/{job}")
    assert answer.status == 307, answer
    assert answer.headers["Location"] == f"{first.node_url}/api/v1/jobs/{job}?moved=1"
    assert first.get(f"/jobs/{job}?moved=1").status == 200
    assert first.wait_for_job(job)["state"] == "done"
    assert second.get(f"/jobs/{job}", token="x" * 40).status == 401
    assert second.get("/jobs/999999999").status == 404


def test_connections_survive_a_redirection(site, model):
    owner, other = owner_and_other(site, model)
    path = f"/api/v1/models/{model['id']}/layers/marks/edits"
    headers = {
        "Authorization": f"Bearer {site.token}",
        "Content-Type": "application/json",
    }
    # the server reads a small body, and the connection stays open
    link = http.client.HTTPConnection(other.host, other.port, timeout=60)
    for _ in range(3):
        link.request("POST", path, json.dumps(stroke(model)), headers)
        answer = link.getresponse()
        assert answer.status == 307 and b"moved" in answer.read()
        assert answer.getheader("Connection") != "close"
    link.close()
    # a client that waits for 100 sends no body
    with socket.create_connection((other.host, other.port), timeout=60) as plain:
        head = [
            f"POST {path} HTTP/1.1",
            f"Host: {other.host}:{other.port}",
            *(f"{name}: {value}" for name, value in headers.items()),
            "Content-Length: 500",
            "Expect: 100-continue",
        ]
        plain.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
        told = plain.makefile("rb").read().decode()
    assert told.startswith("HTTP/1.1 307 "), told
    assert f"Location: {owner.node_url}{path}\r\n" in told, told
    assert "Connection: close" in told and " 100 " not in told.split("\r\n")[0], told


def test_a_live_connection_at_the_wrong_node_is_told_where_to_go(site, model):
    owner, other = owner_and_other(site, model)
    with LiveClient(other, model["id"]) as live:
        assert until_moved(live) == [{"op": "moved", "url": owner.node_url}]
    with LiveClient(owner, model["id"]) as live:
        assert live.hello()["op"] == "welcome"
    # a client that may not connect does not get the address
    with pytest.raises(Refused) as refused:
        LiveClient(other, model["id"], token="x" * 40)
    assert refused.value.status == 401, refused.value


def test_administrators_see_the_nodes(site, model):
    owner, other = owner_and_other(site, model)
    ada = site.nodes[0].add_person("ada", "curator")
    assert site.nodes[0].get("/nodes", token=ada).status == 403

    def listed():
        found = other.ok("GET", "/nodes").json()
        by_url = {node["url"]: node for node in found["nodes"]}
        there = by_url[owner.node_url]
        return (found, by_url) if there["open_models"] > 0 and there["models"] else None

    found, by_url = wait_for(listed, "the load of the owner")
    assert found["total"] == len(by_url) == 2
    here = next(node for node in found["nodes"] if node["id"] == found["this_node"])
    assert here["url"] == other.node_url
    for node in by_url.values():
        assert node["state"] == "ready" and not node["draining"] and 0 < node["lease_s"] <= 3, node
        assert node["version"] and node["gpu"], node
    assert by_url[owner.node_url]["models"] == [{"id": model["id"], "name": model["name"]}]
    assert by_url[owner.node_url]["models_total"] == 1
    assert by_url[other.node_url]["models"] == []
    page = other.ok("GET", "/nodes?limit=1")
    assert len(page.json()["nodes"]) == 1 and 'rel="next"' in page.headers["Link"], page
    assert 0 < owner.metric("strata_node_lease_seconds") <= 3


def test_an_owner_that_is_killed_is_replaced_after_its_lease(site, model):
    owner, other = owner_and_other(site, model)
    epoch, known = site.epoch(model["id"]), []
    with LiveClient(owner, model["id"]) as live:
        live.hello()
        for value in (1, 2, 3):
            known.append(live_edit(live, model, value))
            saved(live, known[-1])
    owner.kill()
    took_s = paint_soon(site, model, time.monotonic())
    print(f"killed: painting went on after {took_s:.2f} s")
    assert took_s < 60, took_s
    assert site.owner(model["id"]) is other
    assert site.epoch(model["id"]) > epoch
    ids = history_ids(site, model)
    assert all(ids.count(edit_id) == 1 for edit_id in known), (known, ids)
    gone = next(
        node for node in other.ok("GET", "/nodes").json()["nodes"] if node["url"] == owner.node_url
    )
    assert (gone["state"], gone["lease_s"], gone["models"]) == ("lost", 0, []), gone
    owner.start()
    assert edit_at(owner, model).status == 307  # it does not claim the model again


def test_a_frozen_owner_acknowledges_nothing_when_it_continues(site, model):
    owner, other = owner_and_other(site, model)
    with LiveClient(owner, model["id"]) as live, LiveClient(owner, model["id"]) as viewer:
        live.hello()
        viewer.hello()
        saved(live, live_edit(live, model))
        owner.freeze()
        begun = time.monotonic()
        # The frozen node gets these edits when it continues.
        late = [live_edit(live, model, value) for value in (1, 2, 3)]
        took_s = paint_soon(site, model, begun)
        print(f"frozen: painting went on after {took_s:.2f} s")
        assert took_s < 60, took_s
        assert site.owner(model["id"]) is other
        owner.thaw()
        messages = until_moved(live)
        until_moved(viewer)
        acknowledged = [message for message in messages if message["op"] == "saved"]
        assert not acknowledged, acknowledged
    assert not set(late) & set(history_ids(site, model)), "a frozen node wrote to the journal"
    # The client sends the same edits to the new owner. They are painted once.
    with LiveClient(other, model["id"]) as live:
        live.hello()
        for edit_id, value in zip(late, (1, 2, 3)):
            for _ in range(2):
                live.send(
                    {"op": "edit", "id": edit_id, "layer": "marks", "edit": stroke(model, value)}
                )
        for edit_id in late:
            saved(live, edit_id)
    ids = history_ids(site, model)
    assert all(ids.count(edit_id) == 1 for edit_id in late), (late, ids)
    wait_for(lambda: owner.get("//readyz").status == 200, "the thawed node to have a lease again")
    assert owner.metric("strata_models_moved_total") >= 1


def test_a_node_that_is_stopped_passes_its_models_on(site, model):
    owner, other = owner_and_other(site, model)
    with LiveClient(owner, model["id"]) as live:
        live.hello()
        saved(live, live_edit(live, model))
        begun = time.monotonic()
        owner.process.send_signal(signal.SIGTERM)
        messages = until_moved(live)
        told_s = time.monotonic() - begun
        assert messages[-1] == {"op": "moved", "url": other.node_url}, messages[-1]
        with LiveClient(other, model["id"]) as there:
            there.hello()
            saved(there, live_edit(there, model, 3))
        went_on_s = time.monotonic() - begun
    print(f"stopped: told after {told_s:.2f} s, painting went on after {went_on_s:.2f} s")
    assert went_on_s < 60, went_on_s
    assert owner.process.wait(LONG_S) == 0
    left = [node for node in other.ok("GET", "/nodes").json()["nodes"] if node["state"] != "lost"]
    assert [node["url"] for node in left] == [other.node_url], left
    owner.start()


def test_one_of_two_nodes_takes_over():
    """After one of three nodes has ended, the other two agree on the owner."""
    with Site(3, seed=2) as three:
        made = three.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
        three.ok("POST", f"/models/{made['id']}/layers", {"name": "marks", "type": "u8"})
        owner, _ = owner_and_other(three, made)
        known = edit_at(owner, made)
        assert known.status == 200, known
        owner.kill()
        took_s = paint_soon(three, made, time.monotonic())
        print(f"killed, two nodes left: painting went on after {took_s:.2f} s")
        answers = [edit_at(node, made).status for node in three.running()]
        assert sorted(answers) == [200, 307], answers
        sequences = [
            row["sequence"]
            for row in three.ok("GET", f"/models/{made['id']}/layers/marks/edits").json()["edits"]
        ]
        assert sorted(sequences) == list(range(1, len(sequences) + 1)), sequences
        for node in three.running():
            assert node.stop() == 0
            node.assert_clean_log(FAULT_WORDS)


@pytest.fixture(name="linked", scope="module")
def linked_site():
    """A site whose nodes can be cut off from the database."""
    with Site(2, seed=3, links=True) as started:
        started.model = started.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
        started.ok("POST", f"/models/{started.model['id']}/layers", {"name": "marks", "type": "u8"})
        yield started


def test_viewers_turn_the_model_while_there_is_no_database(linked):
    model = linked.model
    owner, _ = owner_and_other(linked, model)
    epoch = linked.epoch(model["id"])
    with LiveClient(owner, model["id"]) as live, LiveClient(owner, model["id"]) as viewer:
        live.hello()
        viewer.hello(accept=["jpeg"])
        turn(viewer, model, 1)
        linked.postgres.kill()
        until_database(live, False)
        until_database(viewer, False)
        for seq in (2, 3, 4):
            turn(viewer, model, seq)
        waiting = live_edit(live, model)
        refused = live.receive_until("saved", "unsaved", "problem")
        assert (refused["op"], refused.get("status")) == ("problem", 503), refused
        assert refused["ref"] == waiting, refused
        assert owner.get("//readyz").status == 503

        linked.postgres.restart()
        until_database(live, True)
        until_database(viewer, True)
        for _ in range(2):
            live.send({"op": "edit", "id": waiting, "layer": "marks", "edit": stroke(model)})
            saved(live, waiting)
        turn(viewer, model, 5)
    assert history_ids(linked, model).count(waiting) == 1
    assert linked.epoch(model["id"]) == epoch, "the model was opened again"


def test_a_node_that_is_cut_off_draws_but_acknowledges_nothing(linked):
    model = linked.model
    owner, other = owner_and_other(linked, model)
    with LiveClient(owner, model["id"]) as live, LiveClient(owner, model["id"]) as viewer:
        live.hello()
        viewer.hello(accept=["jpeg"])
        saved(live, live_edit(live, model))
        owner.database.cut()
        begun = time.monotonic()
        until_database(live, False)
        until_database(viewer, False)
        late = [live_edit(live, model, value) for value in (1, 2, 3)]
        for seq in (1, 2):
            turn(viewer, model, seq)
        # The other node claims the model, and saves.
        key = str(uuid.uuid4())
        wait_for(lambda: edit_at(other, model, key).status == 200, "the other node to save")
        print(f"cut off: painting went on after {time.monotonic() - begun:.2f} s")
        turn(viewer, model, 3)
        owner.database.mend()
        messages = until_moved(live)
        until_moved(viewer)
        refused = {message.get("ref") for message in messages if message["op"] == "problem"}
        assert not [message for message in messages if message["op"] == "saved"], messages
        assert refused == set(late), messages
    with LiveClient(other, model["id"]) as live:
        live.hello()
        for edit_id, value in zip(late, (1, 2, 3)):
            live.send({"op": "edit", "id": edit_id, "layer": "marks", "edit": stroke(model, value)})
            saved(live, edit_id)
    ids = history_ids(linked, model)
    assert all(ids.count(edit_id) == 1 for edit_id in late), (late, ids)


def test_a_proxy_leads_away_from_a_node_that_is_cut_off(linked, tmp_path):
    """nginx sends each new connection to the owner first. The owner must refuse it at once: if it
    waited for its database, nginx would not try the other node, and pages would give up."""
    model = linked.model
    owner, other = owner_and_other(linked, model)
    os.chmod(tmp_path, 0o755)
    front = SimpleNamespace(host=owner.host, port=free_port(), tls=None, token=linked.token)
    site = (
        "map $http_upgrade $strata_connection { default upgrade; '' close; }\n"
        f"upstream nodes {{ server 127.0.0.1:{owner.own_port} max_fails=1 fail_timeout=2s;\n"
        f"server 127.0.0.1:{other.own_port} backup; }}\n"
        f"server {{ listen 127.0.0.1:{front.port}; proxy_http_version 1.1;\n"
        "proxy_set_header Host $http_host; proxy_set_header Upgrade $http_upgrade;\n"
        "proxy_set_header Connection $strata_connection; proxy_read_timeout 120s;\n"
        "location / { proxy_pass http://nodes;\n"
        "proxy_next_upstream error timeout http_502 http_503; } }"
    )
    with Nginx(str(tmp_path), site, front.port), LiveClient(owner, model["id"]) as viewer:
        viewer.hello()
        owner.database.cut()
        try:
            until_database(viewer, False)
            begun = time.monotonic()
            with pytest.raises(Refused) as refused:
                LiveClient(owner, model["id"])
            assert refused.value.status == 503, refused.value
            assert owner.get(f"/models/{model['id']}/layers").status == 503
            # The database gives no answer, so an attempt to use it takes at least 30 s.
            assert time.monotonic() - begun < 25

            def welcomed():
                try:
                    with LiveClient(front, model["id"]) as live:
                        live.send({"op": "hello", "client": "test"})
                        return live.receive_until("welcome", "moved")["op"] == "welcome"
                except (*AWAY, Refused):
                    return False

            wait_for(welcomed, "a welcome through nginx")
            assert linked.owner(model["id"]) is other
        finally:
            owner.database.mend()
        until_moved(viewer)


def test_a_server_alone_has_no_nodes():
    with StrataServer() as alone:
        assert alone.ok("GET", "/nodes").json() == {"nodes": [], "total": 0}
        assert b"strata_node_lease_seconds" not in alone.ok("GET", "//metrics").body
        made = alone.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
        assert alone.get(f"/models/{made['id']}").status == 200
        refused = subprocess.run(
            [alone.binary, "serve", "--data", alone.data, "--node-url", "http://127.0.0.1:1"],
            capture_output=True,
            text=True,
            check=False,
        )
        assert refused.returncode != 0 and "--database" in refused.stderr, refused
        assert alone.stop() == 0
        alone.assert_clean_log()


def test_the_nodes_end_with_clean_logs(site):
    for node in site.running():
        assert node.stop() == 0, "SIGTERM did not end the node well"
        node.assert_clean_log(FAULT_WORDS)
