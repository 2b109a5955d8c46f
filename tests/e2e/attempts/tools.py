"""Functions that several attempts use."""
import re

from support.browsers import Browser, join
from support.live_client import Closed, LiveClient, Refused

M, L, T = "/models/sheet", "/models/sheet/layers/marks", "/tables/kept"
FILL = {"op": "fill", "mode": "where", "where": "x < 1", "value": 1}
FOREIGN = "https://elsewhere.example"
WORDS = {
    "model": "sheet",
    "layer": "marks",
    "table": "kept",
    "key": "1",
    "collection": "sheet.marks",
    "column": "note",
    "project": "default",
    "user": "owner",
    "name": "sheet.ply",
    "format": "npy",
}
METHODS = ("get", "post", "put", "patch", "delete")


def statuses(answers):
    return {answer.status for answer in answers}


def calls(server, methods=METHODS):
    """Yields the method and address of every operation in the contract that requires sign-in,
    except for the live connection."""
    for path, operations in server.contract.document["paths"].items():
        address = re.sub(r"\{(\w+)\}", lambda match: WORDS.get(match[1], "1"), path)
        for method, operation in operations.items():
            if method in methods and operation.get("security") != [] and not path.endswith("/live"):
                yield method.upper(), "/" + address


def body_for(method):
    return {} if method in ("POST", "PUT", "PATCH") else None


def upgraded(server, model="sheet", **options):
    """Returns 101, or the status of the refusal."""
    try:
        LiveClient(server, model, **options).socket.close()
        return 101
    except Refused as refused:
        return refused.status


def close_code(connection):
    """Returns the code with which the server closes the connection, or `cut off` if there is no
    code."""
    try:
        while True:
            connection.receive()
    except Closed as closed:
        return closed.code or "cut off"
    except OSError:
        return "cut off"


def person(server, user, role="annotator"):
    """Returns the browser of a new user."""
    return join(server, server.ok("POST", "/users", {"user": user, "role": role}).json())


def owner_browser(server):
    browser = Browser(server)
    assert browser.request("POST", "/login", {"token": server.token}).status == 200
    return browser
