"""Access without rights: without a secret, with expired or copied secrets, and beyond a token's
role.
"""
from attempts.tools import FILL, L, M, body_for, calls, person, statuses, upgraded
from support.browsers import PASSWORD, Browser, join, secret_of
from support.strata_server import wait_for


def nobody(server, section):
    for what, token in (
        ("no session and no token", False),
        ("an unknown token", "x" * 43),
        ("a token of 5000 characters", "x" * 5000),
    ):
        answers = [
            server.request(method, path, body_for(method), token=token)
            for method, path in calls(server)
        ]
        section.tried(
            f"Every call of the contract with {what}",
            statuses(answers),
            401,
            "the server checks the secret before the address",
            f"{len(answers)} calls",
        )
    headers = [
        {"Authorization": "Basic b3duZXI6b3duZXI="},
        {"Authorization": "Bearer "},
        {"Authorization": "Bearer null"},
        {"Cookie": "strata_session="},
        {"Cookie": "strata_session=" + server.token + "x"},
    ]
    section.tried(
        "Another authorization scheme, an empty token, an invented cookie",
        statuses(server.get(M, token=False, headers=each) for each in headers),
        401,
        "the server accepts one scheme and one cookie",
    )
    in_address = [
        server.get(f"{M}?{name}={server.token}", token=False)
        for name in ("token", "access_token", "key")
    ]
    section.tried(
        "The owner's token in the address",
        statuses(in_address),
        401,
        "the server accepts no secrets in addresses, because logs contain addresses",
    )
    section.tried(
        "Upgrade to a live connection without a secret, with an unknown or an empty secret",
        {
            upgraded(server, token=""),
            upgraded(server, token="x" * 43),
            upgraded(server, token="", cookie="strata_session=", origin=server.url),
        },
        401,
        "checked before the upgrade",
    )


def doors(server, cookie):
    """Reads, writes and opens a live connection with a copied session."""
    headers = {"Cookie": cookie, "Origin": server.url}
    return {
        server.get(M, token=False, headers=headers).status,
        server.post(L + "/edits", FILL, token=False, headers=headers).status,
        upgraded(server, token="", cookie=cookie, origin=server.url),
    }


def replayed_sessions(server, section):
    """Uses a copied cookie after its session has ended."""

    def other_browser_ends_it(browser, user):
        other = Browser(server)
        assert other.sign_in(user, PASSWORD).status == 200
        for session in other.ok("GET", "/me/sessions").json()["sessions"]:
            if not session["current"]:
                other.ok("DELETE", f"/me/sessions/{session['id']}")

    def expires(_, user):
        server.sql(
            f"UPDATE tokens SET expires = now() - interval '1 second' WHERE kind = 'session' AND user_name = '{user}'"
        )
        wait_for(lambda: doors(server, copied) == {401}, "the session's age to count")

    ends = [
        ("sign-out", "by1", lambda browser, user: browser.ok("POST", "/logout")),
        ("end from another browser", "by2", other_browser_ends_it),
        (
            "new password",
            "by3",
            lambda browser, user: join(
                server,
                server.ok("POST", f"/users/{user}/invite").json(),
                "twelve otters and a heron",
            ),
        ),
        (
            "disabled user",
            "by4",
            lambda browser, user: server.ok("PATCH", f"/users/{user}", {"disabled": True}),
        ),
        (
            "deleted user",
            "by5",
            lambda browser, user: server.ok("DELETE", f"/users/{user}"),
        ),
    ]
    answers = set()
    for _, user, end in ends:
        browser = person(server, user)
        copied = browser.cookie
        assert doors(server, copied) == {200, 101}
        end(browser, user)
        answers |= doors(server, copied)
    section.tried(
        "A copied session after each of these events: "
        + ", ".join(what for what, *_ in ends)
        + " (read, write, upgrade)",
        answers,
        401,
        "the database stores a digest of each session, and each change of accounts clears the server's cache of sessions",
    )
    browser = person(server, "by6")
    copied = browser.cookie
    expires(browser, "by6")
    section.tried(
        "A copied session after its 90 days",
        doors(server, copied),
        401,
        "the server checks the age again after 10 s at the latest",
    )
    fixed = Browser(server)
    fixed.cookie = "strata_session=" + "f" * 43
    given = fixed.request("POST", "/login", {"user": "by1", "password": PASSWORD})
    assert given.status == 200
    section.tried(
        "A session that the attacker sets in a browser before somebody signs in",
        doors(server, "strata_session=" + "f" * 43),
        401,
        "each sign-in creates a new secret",
    )


def script_tokens(server, section):
    ida = person(server, "ida", "curator")

    def token(**asked):
        return ida.ok("POST", "/me/tokens", {"name": "t", **asked}).json()

    def tried(secret):
        return {
            server.get(M, token=secret).status,
            server.post(L + "/edits", FILL, token=secret).status,
            upgraded(server, token=secret),
        }

    made = token()
    assert tried(made["secret"]) == {200, 101}
    ida.ok("DELETE", f"/me/tokens/{made['token']['id']}")
    section.tried(
        "A script's token after it was revoked (read, write, upgrade)",
        tried(made["secret"]),
        401,
        "as for sessions",
    )
    made = token(days=1)
    assert tried(made["secret"]) == {200, 101}
    server.sql(
        f"UPDATE tokens SET expires = now() - interval '1 second' WHERE id = {made['token']['id']}"
    )
    wait_for(lambda: tried(made["secret"]) == {401}, "the token's age to count")
    section.tried(
        "A script's token after its last day", tried(made["secret"]), 401, "as for sessions"
    )
    weak = token(role="viewer")["secret"]
    writes = [
        ("POST", L + "/edits", FILL),
        ("POST", M + "/layers", {"name": "x"}),
        ("PATCH", M, {"credit": "x"}),
        ("DELETE", L, None),
        ("POST", "/projects/default/tables", {"name": "x"}),
        ("POST", M + "/comments", {"text": "x", "position": [1, 1, 0]}),
    ]
    section.tried(
        "A curator's token with the role viewer, used for changes",
        statuses(server.request(method, path, body, token=weak) for method, path, body in writes),
        403,
        "the lower role of the token and of its user applies",
    )
    strong = token()["secret"]
    accounts = [
        ("POST", "/me/password", {"current": PASSWORD, "password": "twelve otters and a heron"}),
        ("GET", "/me/sessions", None),
        ("DELETE", "/me/sessions", None),
        ("GET", "/me/tokens", None),
        ("POST", "/me/tokens", {"name": "x"}),
        ("PATCH", "/me", {"full_name": "x"}),
        ("POST", "/users", {"user": "x"}),
        ("PATCH", "/users/by1", {"role": "viewer"}),
        ("PUT", "/projects/default/members/by1", {"role": "viewer"}),
        ("POST", "/groups", {"name": "x"}),
        ("PATCH", "/groups/1", {"add": ["by1"]}),
        ("DELETE", "/groups/1", None),
        ("PUT", "/projects/default/groups/1", {"role": "viewer"}),
        ("DELETE", "/projects/default/groups/1", None),
    ]
    root = server.ok("POST", "/me/tokens", {"name": "root", "days": 1}).json()["secret"]
    section.tried(
        "A script's token of a user and of the owner, used for accounts, tokens, roles and passwords",
        statuses(
            server.request(method, path, body, token=secret)
            for secret in (strong, root)
            for method, path, body in accounts
        ),
        403,
        "tokens for scripts cannot change accounts, with any role",
    )
    section.tried(
        "A script's token, exchanged for a session in a browser",
        Browser(server).request("POST", "/login", {"token": strong}).status,
        403,
        "refused: a session would outlive the token",
    )
    as_cookie = [
        server.get(M, token=False, headers={"Cookie": "strata_session=" + secret})
        for secret in (strong, root)
    ]
    section.tried(
        "A script's token as the session cookie",
        statuses(as_cookie),
        401,
        "only the secret of a session is valid as cookie",
    )
    section.tried(
        "A token with a higher role than its user",
        ida.request("POST", "/me/tokens", {"name": "t", "role": "administrator"}).status,
        403,
        "the server compares the roles when it creates the token and at each use",
    )
    server.ok("PATCH", "/users/ida", {"role": "viewer"})
    section.tried(
        "A token created before its user lost the role",
        statuses(server.request(method, path, body, token=strong) for method, path, body in writes),
        403,
        "the server compares the roles when it creates the token and at each use",
    )


def invitations(server, section):
    invitation = server.ok("POST", "/users", {"user": "joe", "role": "viewer"}).json()
    first, second = secret_of(invitation), secret_of(server.ok("POST", "/users/joe/invite").json())

    def accept(secret):
        return Browser(server).request(
            "POST", "/invitations/accept", {"invitation": secret, "password": PASSWORD}
        )

    section.tried(
        "An invitation after a later one was created",
        accept(first).status,
        401,
        "one link for each user",
    )
    section.tried(
        "The secret of an invitation as a token for scripts, and as a token for signing in",
        {
            server.get(M, token=second).status,
            Browser(server).request("POST", "/login", {"token": second}).status,
        },
        401,
        "links are exchanged for sessions and are not tokens",
    )
    assert accept(second).status == 200
    section.tried(
        "An invitation used a second time",
        statuses(
            [
                accept(second),
                Browser(server).request("POST", "/invitations/show", {"invitation": second}),
            ]
        ),
        401,
        "the transaction that sets the password deletes it",
    )
    old = secret_of(server.ok("POST", "/users/joe/invite").json())
    server.sql("UPDATE tokens SET expires = now() - interval '1 second' WHERE kind = 'invitation'")
    section.tried(
        "An invitation after its seven days",
        accept(old).status,
        401,
        "the query checks its age",
    )
    link = server.link.partition("link=")[2]
    server.sql("UPDATE tokens SET expires = now() - interval '1 second' WHERE kind = 'owner_link'")
    section.tried(
        "The owner's link, a day after the server printed it",
        server.get("//login?link=" + link, token=False).status,
        401,
        "the query checks its age; once the owner has a password, the server prints no link",
    )


def attempts(server, table):
    section = table.section("Access without rights")
    for attempt in (nobody, replayed_sessions, script_tokens, invitations):
        attempt(server, section)
