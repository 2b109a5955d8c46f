"""Pages of elsewhere that use the session of whoever opens them, and what their browsers are told."""
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
        ("none (an old browser)", {}),
        ("`null` (a frame in a sandbox)", {"Origin": "null"}),
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
            "Origin must be the server's own where a cookie signs",
            f"{len(there)} calls; {len(answers) - len(there)} of things that are not there: 404",
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
        "Origins that look like the server's own",
        statuses(ask("POST", L + "/undo", Origin=origin) for origin in lookalikes),
        403,
        "compared as a whole",
        f"{len(lookalikes)} of them",
    )
    # What a form sends without asking first.
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
        "the type of a body is no way around Origin",
    )
    method = {"X-HTTP-Method-Override": "DELETE", "X-Method-Override": "DELETE"}
    section.tried(
        "DELETE in disguise: a header or a parameter beside GET and POST",
        {
            ask("POST", "/projects/default", Origin=server.url, **method).status,
            ask("GET", M + "?_method=DELETE").status,
        },
        {400, 405},
        "no such headers are known, and unknown parameters refused",
    )
    assert server.get(L).status == 200
    section.tried(
        "Signing somebody in as somebody else, from another page",
        server.post(
            "/login", {"token": server.token}, token=False, headers={"Origin": FOREIGN}
        ).status,
        403,
        "Origin is compared for sign-in, too, where a browser says it",
    )


def listening(server, section, cookie):
    """What a foreign page gets to read."""
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
        "A live connection with the visitor's cookie, Origin foreign, `null`, like ours, ours by https or absent",
        origins,
        403,
        "compared before the upgrade; tokens without Origin are for scripts",
    )
    preflight = raw_request(
        server,
        f"OPTIONS /api/v1{M} HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nOrigin: {FOREIGN}\r\nAccess-Control-Request-Method: PATCH\r\nConnection: close\r\n\r\n".encode(),
    )
    read = server.get(M, token=False, headers={"Cookie": cookie, "Origin": FOREIGN})
    grants = (preflight.decode() + str(read.headers)).lower().count("access-control-")
    assert preflight.startswith(b"HTTP/1.1 204 "), preflight
    section.tried(
        "Asking for leave to read across origins (CORS)",
        f"{grants} leaves given",
        "0 leaves given",
        "no Access-Control header is ever sent, and `Cross-Origin-Resource-Policy: same-origin` always",
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
        "Our page in a frame of theirs",
        "frame-ancestors 'none'",
        "frame-ancestors 'none'",
        "Content-Security-Policy of each answer; no inline script and nothing from elsewhere either",
    )
    whole = server.post("/login", {"token": server.token}, token=False).headers["Set-Cookie"]
    assert all(word in whole for word in ("HttpOnly", "SameSite=Strict", "Path=/")), whole
    section.tried(
        "A script that reads the cookie, a link that takes it along",
        "HttpOnly, SameSite=Strict",
        "HttpOnly, SameSite=Strict",
        "the cookie itself; `Secure`, too, where the page came by https",
    )


def hosts(server, section, cookie):
    """A name of theirs that leads to our address (DNS rebinding), and other tricks with Host."""
    rebound = {"Host": "evil.example:8080", "Origin": "http://evil.example:8080"}
    answers = [
        server.get(M, token=False, headers=rebound),
        server.request("PATCH", M, {"credit": "x"}, token=False, headers=rebound),
    ]
    section.tried(
        "A foreign name that was made to lead to our address, as Host and Origin",
        statuses(answers),
        421,
        "names are held against those of --origin and the machine's own",
    )
    section.tried(
        "Our cookie with a foreign Host",
        server.post(
            L + "/undo",
            token=False,
            headers={"Cookie": cookie, "Origin": server.url, "Host": "evil.example"},
        ).status,
        421,
        "the same, before anything else",
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
        "Host and X-Forwarded-Host of theirs, to get links that lead there",
        f"in {len(found)} of {len(answers)} answers",
        "in 0 of 4 answers",
        "links are paths; no address is made of Host, but where plain http is sent on to https",
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
        "Line breaks in addresses, to write headers of the answer",
        f"{sum('Set-Cookie' in answer.headers for answer in split)} headers written",
        "0 headers written",
        "what is told back in a header is encoded anew",
    )


def attempts(server, table):
    section = table.section("Pages of elsewhere")
    cookie = owner_browser(server).cookie
    for attempt in (changing, listening, hosts):
        attempt(server, section, cookie)
