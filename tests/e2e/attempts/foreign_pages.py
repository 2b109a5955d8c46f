"""Pages of other sites that use a visitor's session, and the responses to the visitor's browser."""
import json
import urllib.parse

from attempts.tools import FOREIGN, L, M, T, body_for, calls, owner_browser, statuses, upgraded
from support.raw_http import raw_request

CHANGES = ("post", "put", "patch", "delete")
FORMS = ("application/x-www-form-urlencoded", "text/plain", "multipart/form-data; boundary=x", None)


def changing(server, section, cookie):
    def ask(method, path, **headers):
        return server.request(
            method, path, body_for(method), token=False, headers={"Cookie": cookie, **headers}
        )

    for what, headers in (
        ("a foreign Origin", {"Origin": FOREIGN}),
        ("no Origin (an old browser)", {}),
        ("`null` (a sandboxed frame)", {"Origin": "null"}),
    ):
        answers = [ask(method, path, **headers) for method, path in calls(server, CHANGES)]
        there = [answer for answer in answers if answer.status != 404]
        assert len(there) > 60 and all(answer.json()["field"] == "Origin" for answer in there), (
            len(there),
            there,
        )
        section.tried(
            f"Every changing call of the contract with the owner's cookie and {what}",
            statuses(there),
            403,
            "with a cookie, Origin must be the server's own",
            f"{len(there)} calls; {len(answers) - len(there)} of missing items: 404",
        )
    lookalikes = [
        server.url + ".example",
        server.url + "0",
        server.url.replace("127.0.0.1", "127.0.0.2"),
        server.url.replace("http:", "ftp:"),
        server.url.replace("http:", "https:"),
        "http://localhost:" + str(server.port),
        server.url + "/",
        "http://a@" + server.url[7:],
        server.url + "#",
        " ",
    ]
    section.tried(
        "Origins similar to the server's own",
        statuses(ask("POST", L + "/undo", Origin=origin) for origin in lookalikes),
        403,
        "the server compares the whole Origin",
        f"{len(lookalikes)} of them",
    )
    # requests that a form can send without a preflight
    body = json.dumps({"name": "Taken over"}).encode()
    answers = [
        server.request(
            "POST",
            path,
            body,
            token=False,
            headers={
                "Cookie": cookie,
                "Origin": FOREIGN,
                **({"Content-Type": kind} if kind else {}),
            },
        )
        for kind in FORMS
        for path in ("/projects", M + "/layers", T + "/records")
    ]
    section.tried(
        "Forms of other pages: JSON sent as urlencoded, as text, as multipart, without a type",
        statuses(answers),
        403,
        "the check of Origin is independent of the body's type",
    )
    method = {"X-HTTP-Method-Override": "DELETE", "X-Method-Override": "DELETE"}
    section.tried(
        "DELETE as a header or a parameter of GET and POST",
        {
            ask("POST", "/projects/default", Origin=server.url, **method).status,
            ask("GET", M + "?_method=DELETE").status,
        },
        {400, 405},
        "the server ignores such headers and refuses unknown parameters",
    )
    assert server.get(L).status == 200
    section.tried(
        "Signing a visitor in as another user, from another page",
        server.post(
            "/login", {"token": server.token}, token=False, headers={"Origin": FOREIGN}
        ).status,
        403,
        "the server also checks Origin for sign-in, if the browser sends it",
    )


def listening(server, section, cookie):
    """Reads data as a foreign page."""
    origins = {
        upgraded(server, token="", cookie=cookie, origin=origin)
        for origin in (
            FOREIGN,
            "null",
            server.url + ".example",
            server.url.replace("http:", "https:"),
            None,
        )
    }
    section.tried(
        "A live connection with the visitor's cookie and a foreign, `null`, similar, https or missing Origin",
        origins,
        403,
        "checked before the upgrade; only tokens of scripts need no Origin",
    )
    preflight = raw_request(
        server,
        f"OPTIONS /api/v1{M} HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nOrigin: {FOREIGN}\r\nAccess-Control-Request-Method: PATCH\r\nConnection: close\r\n\r\n".encode(),
    )
    read = server.get(M, token=False, headers={"Cookie": cookie, "Origin": FOREIGN})
    grants = (preflight.decode() + str(read.headers)).lower().count("access-control-")
    assert preflight.startswith(b"HTTP/1.1 204 "), preflight
    section.tried(
        "A request for permission to read across origins (CORS)",
        f"{grants} permissions",
        "0 permissions",
        "the server sends no Access-Control header, and always `Cross-Origin-Resource-Policy: same-origin`",
    )
    assert read.headers["Cross-Origin-Resource-Policy"] == "same-origin"
    page = server.get("//", token=False)
    policy = page.headers["Content-Security-Policy"]
    assert (
        "frame-ancestors 'none'" in policy
        and "default-src 'self'" in policy
        and "unsafe" not in policy
        and page.headers["X-Content-Type-Options"] == "nosniff"
    ), page.headers
    section.tried(
        "Strata's page in a frame of another site",
        "frame-ancestors 'none'",
        "frame-ancestors 'none'",
        "Content-Security-Policy of each answer, which also forbids inline scripts and content of other sites",
    )
    whole = server.post("/login", {"token": server.token}, token=False).headers["Set-Cookie"]
    assert all(word in whole for word in ("HttpOnly", "SameSite=Strict", "Path=/")), whole
    section.tried(
        "A script that reads the cookie, a link that sends it",
        "HttpOnly, SameSite=Strict",
        "HttpOnly, SameSite=Strict",
        "attributes of the cookie; also `Secure` if the page was loaded by https",
    )


def hosts(server, section, cookie):
    """Uses a foreign name that resolves to the server's address (DNS rebinding), and other Host
    headers."""
    rebound = {"Host": "evil.example:8080", "Origin": "http://evil.example:8080"}
    answers = [
        server.get(M, token=False, headers=rebound),
        server.request("PATCH", M, {"credit": "x"}, token=False, headers=rebound),
    ]
    section.tried(
        "A foreign name that resolves to the server's address, as Host and Origin",
        statuses(answers),
        421,
        "the server accepts only the names of --origin and of the machine",
    )
    section.tried(
        "The server's cookie with a foreign Host",
        server.post(
            L + "/undo",
            token=False,
            headers={"Cookie": cookie, "Origin": server.url, "Host": "evil.example"},
        ).status,
        421,
        "the server checks Host before everything else",
    )
    evil = "http://evil.example"
    answers = [
        server.get(
            path, token=False, headers={"Host": "evil.example", "X-Forwarded-Host": "evil.example"}
        )
        for path in ("//", "//livez", "/openapi.json")
    ]
    answers += [
        server.post(
            "/users",
            {"user": "linked"},
            headers={"Host": "evil.example", "X-Forwarded-Host": "evil.example"},
        )
    ]
    found = [
        answer for answer in answers if evil.encode() in answer.body or evil in str(answer.headers)
    ]
    section.tried(
        "A foreign Host and X-Forwarded-Host, to get links to another site",
        f"in {len(found)} of {len(answers)} answers",
        "in 0 of 4 answers",
        "links are paths; the server uses Host only in the redirect from http to https",
    )
    target = urllib.parse.quote("\r\nSet-Cookie: strata_session=x\r\n\r\n<script>", safe="")
    split = [
        server.get(path, token=server.token)
        for path in (
            f"/models?project={target}",
            f"/models/{target}",
            f"//{target}",
            f"/models?limit=1&offset={target}",
        )
    ]
    assert not any("Set-Cookie" in answer.headers for answer in split), split
    section.tried(
        "Line breaks in addresses, to add headers to the answer",
        f"{sum('Set-Cookie' in answer.headers for answer in split)} headers added",
        "0 headers added",
        "the server encodes values that it returns in headers",
    )


def attempts(server, table):
    section = table.section("Pages of other sites")
    cookie = owner_browser(server).cookie
    for attempt in (changing, listening, hosts):
        attempt(server, section, cookie)
