"""Sign-in with a real OpenID Connect provider: new accounts, roles and groups from claims, the
audit log, and attacks on the sign-in."""
import json
import subprocess
import urllib.parse

import pytest
from support.browsers import PASSWORD, Browser, secret_of
from support.nginx import free_port
from support.oidc_provider import SECRET, OidcProvider, Visitor, problem_of
from support.strata_server import LONG_S, StrataServer

GROUP = "Excavation 2026"


def config_of(provider):
    rules = {
        "roles": {
            "claim": "/realm_access/roles",
            "map": {"staff": "annotator", "leader": "curator", "boss": "administrator"},
        },
        "groups": {"claim": "groups", "map": {"/dig": GROUP, "/gone": "No such group"}},
        "scopes": ["openid", "profile", "groups"],
        "issuer": provider.issuer,
    }
    museum = {
        "id": "museum",
        "name": "Museum",
        "client_id": "strata",
        "client_secret_file": "secret",
        "accounts": "everybody",
        **rules,
    }
    university = {
        "id": "university",
        "name": "University",
        "client_id": "strata-open",
        "accounts": {"claim": "groups", "values": ["/dig"]},
        **rules,
    }
    return {"providers": [museum, university]}


@pytest.fixture(scope="module", name="port")
def port_of_strata():
    return free_port()


@pytest.fixture(scope="module", name="provider")
def provider_of_tests(port):
    with OidcProvider(f"http://127.0.0.1:{port}") as started:
        yield started


@pytest.fixture(scope="module", name="config")
def config_file(provider, tmp_path_factory):
    folder = tmp_path_factory.mktemp("oidc")
    (folder / "secret").write_text(SECRET + "\n")
    (folder / "oidc.json").write_text(json.dumps(config_of(provider)))
    return folder / "oidc.json"


@pytest.fixture(scope="module")
def server(port, config):
    site = StrataServer(options=["--oidc-config", str(config)])
    site.listen = f"127.0.0.1:{port}"
    with site as started:
        started.ok("POST", "/groups", {"name": GROUP})
        yield started


def person(server, user):
    return server.ok("GET", f"/users/{user}").json()


def group_id(server):
    groups = server.ok("GET", "/groups").json()["groups"]
    return next(group["id"] for group in groups if group["name"] == GROUP)


def audited(server, action):
    return server.ok("GET", f"/audit?action={action}&limit=1").json()["entries"][0]


def with_query(address, **changes):
    """Changes parameters of an address. The value None removes a parameter."""
    parts = urllib.parse.urlsplit(address)
    query = {**dict(urllib.parse.parse_qsl(parts.query)), **changes}
    kept = {name: value for name, value in query.items() if value is not None}
    return urllib.parse.urlunsplit(parts._replace(query=urllib.parse.urlencode(kept)))


def test_the_ways_to_sign_in_are_public(server):
    assert Visitor(server).get_api("/sign-in/providers").json() == {
        "providers": [
            {"id": "museum", "name": "Museum"},
            {"id": "university", "name": "University"},
        ],
        "local_accounts": True,
    }


def test_the_address_at_the_provider_has_no_secrets(server, provider):
    visitor = Visitor(server)
    address = visitor.begin()
    query = dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(address).query))
    assert address.startswith(provider.issuer + "/auth?"), address
    assert query["response_type"] == "code" and query["code_challenge_method"] == "S256", query
    assert query["redirect_uri"] == f"{server.url}/sign-in/museum/callback", query
    assert SECRET not in address and visitor.jar["strata_sign_in"] not in address
    answer = visitor.get(f"{server.url}/sign-in/museum")
    cookie = answer.headers["Set-Cookie"]
    assert "HttpOnly" in cookie and "SameSite=Lax" in cookie and "Max-Age=600" in cookie, cookie
    assert answer.headers["Cache-Control"] == "no-store"


def test_a_first_sign_in_creates_an_account(server, provider):
    provider.set_claims(
        "ada", name="Ada Lovelace", groups=["/dig", "/gone"], realm_access={"roles": ["staff"]}
    )
    visitor = Visitor(server)
    answer = visitor.sign_in("ada", return_to="/models/7?view=2")
    assert answer.status == 303 and answer.headers["Location"] == "/models/7?view=2", answer
    session = next(
        cookie
        for cookie in answer.headers.get_all("Set-Cookie")
        if cookie.startswith("strata_session=")
    )
    assert "HttpOnly" in session and "SameSite=Strict" in session, session
    assert "strata_sign_in" not in visitor.jar, "the cookie of the sign-in ends"
    me = visitor.get_api("/me").json()
    assert (me["user"], me["full_name"], me["role"]) == ("ada", "Ada Lovelace", "annotator"), me
    assert me["has_password"] is False
    ada = person(server, "ada")
    assert ada["groups"] == [GROUP] and ada["state"] == "active", ada
    assert any("No such group" in line for line in server.log), "the log names the missing group"


def test_the_audit_log_names_the_provider(server):
    entry = audited(server, "sign_in")
    assert entry["details"] == {"method": "oidc", "provider": "museum"}, entry
    assert entry["actor"] == "ada" and entry["address"].startswith("10.7."), entry
    entry = audited(server, "oidc_bound")
    assert entry["subject"] == "ada" and entry["details"]["subject"] == "ada", entry


def test_claims_change_rights_at_each_sign_in(server, provider):
    provider.set_claims("bob", groups=["/dig"], realm_access={"roles": ["staff", "leader"]})
    bob = Visitor(server)
    bob.sign_in("bob")
    assert person(server, "bob")["role"] == "curator"
    server.ok("POST", "/groups", {"name": "By hand", "members": ["bob"]})
    provider.set_claims("bob", groups=[])
    assert bob.sign_in("bob").headers["Location"] == "/"
    now = person(server, "bob")
    assert (now["role"], now["groups"]) == ("guest", ["By hand"]), now


def test_an_equal_name_does_not_take_over_an_account(server):
    server.ok("POST", "/users", {"user": "carol", "role": "curator"})
    visitor = Visitor(server)
    assert visitor.sign_in("carol").status == 303
    me = visitor.get_api("/me").json()
    assert (me["user"], me["role"]) == ("carol-2", "guest"), me
    assert person(server, "carol")["state"] == "invited"


def test_an_administrator_can_bind_an_account(server, provider):
    answer = Visitor(server).sign_in("dora", provider="university")
    assert problem_of(answer) == "no_account"
    entry = audited(server, "sign_in_failed")
    assert entry["actor"] == "dora" and entry["details"]["provider"] == "university", entry
    server.ok("POST", "/users", {"user": "dorothea", "role": "viewer"})
    bind = [server.binary, "user", "bind", "dorothea", "--data", server.data]
    subprocess.run(
        [*bind, "--issuer", provider.issuer, "--subject", "dora"], check=True, timeout=LONG_S
    )
    visitor = Visitor(server)
    assert visitor.sign_in("dora", provider="university").headers["Location"] == "/"
    assert visitor.get_api("/me").json()["user"] == "dorothea"


def test_claims_can_be_required_for_an_account(server, provider):
    provider.set_claims("erik", groups=["/dig"])
    visitor = Visitor(server)
    visitor.sign_in("erik", provider="university")  # the token is signed with ES256
    assert visitor.get_api("/me").json()["user"] == "erik"


def test_a_disabled_person_cannot_sign_in(server):
    assert Visitor(server).sign_in("fay").headers["Location"] == "/"
    server.ok("PATCH", "/users/fay", {"disabled": True})
    assert problem_of(Visitor(server).sign_in("fay")) == "disabled"


def test_a_person_can_refuse(server):
    assert problem_of(Visitor(server).sign_in(None)) == "denied"


def test_a_response_counts_once(server):
    visitor = Visitor(server)
    begun = visitor.begin()
    cookie = visitor.jar["strata_sign_in"]
    callback = visitor.callback(begun, "gil")
    assert visitor.get(callback).headers["Location"] == "/"
    visitor.jar["strata_sign_in"] = cookie  # an attacker who has the cookie and the address
    assert problem_of(visitor.get(callback)) == "expired"
    # the code in a new sign-in
    state = dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(visitor.begin()).query))["state"]
    assert problem_of(visitor.get(with_query(callback, state=state))) == "refused"


def test_a_response_belongs_to_one_browser(server):
    """An attacker who sends their own response to other people cannot sign these people in."""
    attacker, victim = Visitor(server), Visitor(server)
    callback = attacker.callback(attacker.begin(), "mallory")
    assert problem_of(victim.get(callback)) == "expired"
    victim.begin()  # the victim has a sign-in too
    assert problem_of(victim.get(callback)) == "expired"
    assert "strata_session" not in victim.jar
    assert attacker.get(callback).headers["Location"] == "/", "it was not used up"


def test_a_stolen_code_is_useless(server):
    """The code of a victim does not match the verifier and nonce of the attacker's sign-in."""
    attacker, victim = Visitor(server), Visitor(server)
    stolen = victim.callback(victim.begin(), "hugo")
    code = dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(stolen).query))["code"]
    own = attacker.callback(attacker.begin(), "mallory")
    assert problem_of(attacker.get(with_query(own, code=code))) == "refused"


@pytest.mark.parametrize(
    "changes, problem",
    [
        ({"state": "x" * 43}, "expired"),
        ({"state": ""}, "expired"),
        ({"state": None}, "expired"),
        ({"code": "forged"}, "refused"),
        ({"code": ""}, "refused"),
        ({"code": None}, "refused"),
        ({"iss": "http://evil.example"}, "refused"),
        ({"iss": None}, "refused"),
        ({"error": "server_error"}, "refused"),
        ({"error": "<script>"}, "refused"),
    ],
)
def test_a_changed_response_is_refused(server, changes, problem):
    visitor = Visitor(server)
    callback = visitor.callback(visitor.begin(), "ada")
    assert problem_of(visitor.get(with_query(callback, **changes))) == problem
    assert "strata_session" not in visitor.jar


def test_a_response_belongs_to_one_provider(server):
    visitor = Visitor(server)
    callback = visitor.callback(visitor.begin(), "ada")
    other = callback.replace("/sign-in/museum/", "/sign-in/university/")
    assert problem_of(visitor.get(other)) == "refused"


@pytest.mark.parametrize(
    "path",
    [
        "https://evil.example/",
        "//evil.example/",
        "/\\evil.example/",
        "\\\\evil.example",
        "evil",
        "javascript:alert(1)",
        "/\t/evil.example",
        "/a\r\nSet-Cookie: a=b",
        "/á",
        "/api/v1/me",
        "/sign-in/museum",
        "/" + "a" * 1024,
    ],
)
def test_no_sign_in_leads_to_another_site(server, path):
    visitor = Visitor(server)
    query = urllib.parse.urlencode({"return_to": path})
    answer = visitor.get(f"{server.url}/sign-in/museum?{query}")
    assert answer.status == 422 and answer.json()["field"] == "return_to", answer
    assert "strata_sign_in" not in visitor.jar


def test_unknown_providers(server):
    for path in ("/sign-in/nobody", "/sign-in/nobody/callback?state=a&code=b"):
        assert problem_of(Visitor(server).get(server.url + path)) == "unknown_provider"


def test_pending_sign_ins_are_stored_without_secrets(server):
    visitor = Visitor(server)
    address = visitor.begin()
    state = dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(address).query))["state"]
    stored = server.sql("SELECT pending_sign_ins::text FROM pending_sign_ins")
    assert state not in stored and visitor.jar["strata_sign_in"] not in stored


def test_passwords_still_work_beside_the_provider(server):
    invited = server.ok("POST", "/users", {"user": "ines", "role": "viewer"}).json()
    ines = Browser(server)
    ines.ok("POST", "/invitations/accept", {"invitation": secret_of(invited), "password": PASSWORD})
    assert Browser(server).sign_in("ines", PASSWORD).status == 200


def refused_start(server, *options):
    done = subprocess.run(
        [server.binary, "serve", "--data", server.data, "--listen", "127.0.0.1:0", *options],
        capture_output=True,
        text=True,
        timeout=LONG_S,
        check=False,
    )
    assert done.returncode == 1, done
    return done.stderr


def test_a_wrong_configuration_is_refused_at_start(server, tmp_path):
    assert "--oidc-config" in refused_start(server, "--local-accounts", "off")
    file = tmp_path / "oidc.json"
    assert "oidc.json cannot be read" in refused_start(server, "--oidc-config", str(file))
    file.write_text('{"providers": [{"id": "museum", "issuer": "x"}]}')
    assert "/providers/0/name: Missing" in refused_start(server, "--oidc-config", str(file))


def test_passwords_can_be_switched_off(server):
    server.stop()
    server.session = None
    server.options += ["--local-accounts", "off"]
    server.start()
    visitor = Visitor(server)
    assert visitor.get_api("/sign-in/providers").json()["local_accounts"] is False
    refused = Browser(server).sign_in("ines", PASSWORD)
    assert refused.status == 403 and refused.json()["field"] == "password", refused
    invited = server.ok("POST", "/users", {"user": "jens", "role": "viewer"}).json()
    body = {"invitation": secret_of(invited), "password": PASSWORD}
    assert Browser(server).request("POST", "/invitations/accept", body).status == 403
    assert visitor.sign_in("ada").headers["Location"] == "/"
    ada = Browser(server)
    ada.cookie = f"strata_session={visitor.jar['strata_session']}"
    assert ada.request("POST", "/me/password", {"password": PASSWORD}).status == 403


def test_a_provider_can_fail(server, provider):
    visitor = Visitor(server)
    callback = visitor.callback(visitor.begin(), "ada")
    provider.stop()
    assert problem_of(visitor.get(callback)) == "unreachable"
    server.stop()
    server.start()  # the server starts without the provider
    answer = Visitor(server).get(f"{server.url}/sign-in/museum")
    assert problem_of(answer) == "unreachable"
    server.assert_clean_log(warnings=("sign-in with",))
