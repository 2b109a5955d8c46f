"""An attacker uses the owner's token from the environment, after an administrator has set a
password."""
from attempts.tools import FILL, L, M, person, statuses, upgraded
from support.browsers import PASSWORD, Browser, secret_of
from support.strata_server import StrataServer

RIGHTS = [
    ("GET", "/me/sessions", None),
    ("DELETE", "/me/sessions", None),
    ("POST", "/me/password", {"password": PASSWORD}),
    ("PATCH", "/me", {"full_name": "x"}),
    ("GET", "/me/tokens", None),
    ("POST", "/me/tokens", {"name": "x", "role": "owner", "days": 1}),
    ("POST", "/users", {"user": "x"}),
    ("PATCH", "/users/ann", {"role": "curator"}),
    ("POST", "/users/ann/invite", None),
    ("DELETE", "/users/ann", None),
    ("PUT", "/projects/default/members/ann", {"role": "viewer"}),
    ("POST", "/groups", {"name": "x"}),
]
WORK = [
    ("GET", M, None),
    ("POST", L + "/edits", FILL),
    ("POST", M + "/layers", {"name": "Made", "type": "u8"}),
    ("POST", "/projects", {"name": "Made"}),
]


def attempts(table, site):
    section = table.section("The owner's token in the environment")
    with StrataServer() as server:
        site(server)
        person(server, "ann", "viewer")
        assert (
            upgraded(server, token="", cookie="strata_session=" + server.token, origin=server.url)
            == 401
        )
        session = Browser(server)
        assert (
            session.request("POST", "/login", {"token": server.token}).status == 200
        ), "so far it is the owner's"
        # now another administrator can give users access
        invitation = server.ok("POST", "/users", {"user": "root", "role": "administrator"}).json()
        Browser(server).ok(
            "POST",
            "/invitations/accept",
            {"invitation": secret_of(invitation), "password": PASSWORD},
        )
        section.tried(
            "After an administrator has a password: changes of accounts, roles, tokens and passwords with the token",
            statuses(server.request(*call, token=server.token) for call in RIGHTS),
            403,
            "it is then a token for scripts with the role administrator",
        )
        section.tried(
            "… exchanged for a session in a browser",
            Browser(server).request("POST", "/login", {"token": server.token}).status,
            403,
            "tokens for scripts open no sessions",
        )
        section.tried(
            "… as the session cookie",
            {
                server.get(
                    M, token=False, headers={"Cookie": "strata_session=" + server.token}
                ).status,
                upgraded(
                    server, token="", cookie="strata_session=" + server.token, origin=server.url
                ),
            },
            401,
            "only the secret of a session is valid as cookie",
        )
        worked = {server.request(*call).status for call in WORK} | {upgraded(server)}
        assert worked == {200, 201, 101}, f"`./run FILE` and scripts go on: {worked}"
        server.ok("DELETE", "/projects/made")
        assert server.stop() == 0
        server.assert_clean_log()
