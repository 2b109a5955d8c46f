"""A viewer sends the largest possible queries. The server still serves other users, and stops work
for closed connections."""
import concurrent.futures
import json
import re
import socket
import time

from attempts.tools import M, statuses
from support.cameras import camera_from
from support.meshes import folded_grid
from support.process_memory import PeakGrowth, rests
from support.strata_server import LONG_S, StrataServer, wait_for


def long_condition(layer):
    """Returns a condition of the maximum length without a table. It takes a processor some seconds
    on 2048²."""
    return " or ".join([f"sin({layer})>1"] * 340)


LONG = long_condition("n")
LARGE = 8192


def metric(server, name):
    text = server.request("GET", "//metrics", token=False).body.decode()
    return float(re.search(rf"^{name} (\S+)$", text, re.MULTILINE)[1])


def sent(server, path, body, token):
    """Sends a query on a new connection without reading the response."""
    text = json.dumps(body).encode()
    link = socket.create_connection((server.host, server.port), timeout=LONG_S)
    link.sendall(
        (
            f"POST /api/v1{path} HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nAuthorization: Bearer {token}\r\n"
            f"Content-Type: application/json\r\nContent-Length: {len(text)}\r\n\r\n"
        ).encode()
        + text
    )
    return link


def status_of(link):
    with link:
        return int(link.makefile("rb").readline().split()[1])


def is_idle(server):
    return (
        metric(server, "strata_questions_under_way")
        == metric(server, "strata_waiting_questions")
        == 0
    )


def lists(server, section, viewer):
    listed = ",".join(["1"] * 1900)
    answers = [
        server.post(M + "/select", {"where": f"{each} in ({listed})"}, token=viewer)
        for each in ("k", "n", "k not", "n not")
    ]
    section.tried(
        "Lists of 1900 items in a condition, as a viewer",
        statuses(answers),
        200,
        "lists are sets, and a condition on bytes is a lookup table: the time for a texel does not depend on the length of a list",
    )


def steps_after(server, links):
    """Closes connections with running queries. Returns the number of steps that the server took
    after it had become idle."""
    left = metric(server, "strata_questions_left_total")
    for link in links:
        link.close()
    wait_for(lambda: is_idle(server), "an idle server")
    wait_for(
        lambda: metric(server, "strata_questions_left_total") == left + len(links),
        "all of them gone",
    )
    at_rest = metric(server, "strata_question_steps_total")
    time.sleep(0.5)
    return metric(server, "strata_question_steps_total") - at_rest


def leaving(server, section, viewer):
    links = [sent(server, M + "/select", {"where": LONG}, viewer) for _ in range(3)]
    wait_for(lambda: metric(server, "strata_questions_under_way") > 0, "a question under way")
    steps = steps_after(server, links)
    section.tried(
        "Three queries of many seconds whose client disconnects immediately",
        "ended" if steps == 0 else f"{steps} steps more",
        "ended",
        "the server checks the connection ten times a second",
    )


def beside(server, section, viewer):
    links = []

    def as_many_wait_as_may():
        # the server may respond to some queries before all of them wait
        links.extend(sent(server, M + "/select", {"where": LONG}, viewer) for _ in range(15))
        return metric(server, "strata_waiting_questions") >= 32

    wait_for(as_many_wait_as_may, "questions that wait")
    asked = [
        server.post(M + "/select", {"where": "k > 3"}),
        server.get(M + "/layers/k/statistics"),
        server.get(M + "/position?coords=POINT(10%2010%200)"),
    ]
    section.tried(
        "Dozens of such queries of one user: another user's queries at the same time",
        statuses(asked),
        200,
        "the user whose queries have used the least time is next, and at most two queries of a user run at once",
    )
    refused = []
    for link in links:
        link.settimeout(0)
        try:
            refused.append(int(re.match(rb"HTTP/1\.1 (\d+)", link.recv(64))[1]))
        except BlockingIOError:
            pass
    section.tried(
        "Dozens of such queries of one user: further queries of the same user",
        set(refused) - {200},
        429,
        "at most 32 queries of a user wait",
        f"{refused.count(429)} refused",
    )
    for link in links:
        link.close()
    wait_for(lambda: is_idle(server), "an idle server")


def budgets(server, section, viewer):
    answers = [server.post(M + "/select", {"where": long_condition("f")}, token=viewer)]
    section.tried(
        "A condition of a thousand parts over 4096² texels, as a viewer",
        statuses(answers),
        422,
        "20 billion steps for viewers, checked before the start",
    )


def empty_layer(server, section, viewer):
    server.ok("POST", M + "/layers", {"name": "Vast", "type": "u8", "resolution": 16384})
    # The query starts after the server has made the surface map of the new layer.
    wait_for(lambda: rests(server), "a server that computes nothing")
    with PeakGrowth(server) as growth:
        answer = server.get(M + "/layers/vast/statistics", token=viewer)
    section.tried(
        "Statistics of an empty layer of 16384²",
        answer.status,
        200,
        "the server computes nothing for unpainted surface",
        growth.checked(200),
    )


def points(server, section, viewer):
    body = b'{"points":[' + b"[1,2,3]," * 1_199_999 + b"[1,2,3]]}"
    with PeakGrowth(server) as growth:
        answer = server.post(
            M + "/positions", body, headers={"Content-Type": "application/json"}, token=viewer
        )
    section.tried(
        "1 200 000 points at once",
        answer.status,
        422,
        "the server counts a list before it builds the items",
        growth.checked(200),
    )


def pictures(server, section, viewer):
    model = server.get(M).json()
    large = {"camera": camera_from(model, (0.2, -1, 0.6), LARGE, LARGE)}
    small = {"camera": camera_from(model, (0.2, -1, 0.6), 320, 180)}
    with PeakGrowth(server) as growth, concurrent.futures.ThreadPoolExecutor(3) as hands:
        links = [sent(server, M + "/frame", large, viewer) for _ in range(6)]
        wait_for(lambda: metric(server, "strata_questions_under_way") > 0, "a picture under way")
        answers = list(hands.map(lambda _: server.post(M + "/frame", small), range(3)))
        unfinished = sum(not_yet(link) for link in links)
    assert unfinished > 0, "the small ones waited for all of the large ones"
    section.tried(
        "Six pictures of 8192² of one user: another user's small ones at the same time",
        statuses(answers),
        200,
        "the server draws large pictures in bands, with others' pictures between them, and never stores them as a whole",
        growth.checked(600),
    )
    steps_after(server, links)
    section.tried(
        "Six such pictures whose client disconnects",
        "ended",
        "ended",
        "the server stops between two bands",
    )


def not_yet(link):
    link.settimeout(0)
    try:
        return not link.recv(1, socket.MSG_PEEK)
    except BlockingIOError:
        return True


def stop(server, section, viewer):
    links = [sent(server, M + "/select", {"where": LONG}, viewer) for _ in range(3)]
    wait_for(lambda: metric(server, "strata_questions_under_way") > 0, "a question under way")
    code = server.stop()
    section.tried(
        "The server is stopped during queries",
        {status_of(link) for link in links},
        503,
        "queries end with the server",
        "" if code == 0 else f"exit status {code}",
    )


def attempts(table):
    section = table.section("Large queries of one reader")
    with StrataServer() as server:
        server.import_model(
            folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
        )
        for layer in (
            {"name": "k", "type": "u8"},
            {"name": "n", "type": "f32"},
            {"name": "f", "type": "f32", "resolution": 4096},
        ):
            server.ok("POST", M + "/layers", layer)
        server.ok(
            "POST",
            M + "/layers/k/edits",
            {"op": "fill", "mode": "where", "where": "true", "value": 7},
        )
        viewer = server.add_person("eve", "viewer")
        # attempts that measure memory are first, because the later ones make surface maps
        for attempt in (points, empty_layer, lists, leaving, beside, budgets, pictures, stop):
            attempt(server, section, viewer)
        server.assert_clean_log()
