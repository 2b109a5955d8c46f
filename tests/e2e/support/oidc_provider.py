"""An OpenID Connect provider for tests (tests/e2e/oidc), and browsers that sign in with it."""
import http.client
import json
import os
import subprocess
import urllib.parse
from http.cookies import SimpleCookie

from .contract import ROOT
from .missing import missing
from .nginx import free_port
from .strata_server import LONG_S, Answer, _end_with_parent

FOLDER = os.path.join(ROOT, "tests", "e2e", "oidc")
SECRET = "a secret of the tests that has forty characters"


class OidcProvider:
    """The npm package `oidc-provider`, with a confidential client `strata` and a public client
    `strata-open`, whose tokens have another algorithm."""

    def __init__(self, site):
        if not os.path.isdir(os.path.join(FOLDER, "node_modules")):
            missing("oidc-provider is not installed: npm ci in tests/e2e/oidc")
        self.port = free_port()
        self.issuer = f"http://127.0.0.1:{self.port}"
        self.clients = [
            {
                "client_id": "strata",
                "client_secret": SECRET,
                "redirect_uris": [f"{site}/sign-in/museum/callback"],
            },
            {
                "client_id": "strata-open",
                "token_endpoint_auth_method": "none",
                "id_token_signed_response_alg": "ES256",
                "redirect_uris": [f"{site}/sign-in/university/callback"],
            },
        ]
        self.process = None

    def __enter__(self):
        options = json.dumps({"port": self.port, "clients": self.clients})
        self.process = subprocess.Popen(
            ["node", os.path.join(FOLDER, "provider.mjs")],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env={**os.environ, "OIDC_OPTIONS": options},
            preexec_fn=_end_with_parent,
        )
        for line in self.process.stdout:
            if line.strip() == "listening":
                return self
        raise AssertionError(f"the provider ended with {self.process.wait()}")

    def __exit__(self, *_):
        self.stop()

    def stop(self):
        self.process.kill()
        self.process.wait()

    def set_claims(self, person, **claims):
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=LONG_S)
        link.request("PUT", f"/people/{person}", json.dumps(claims))
        assert link.getresponse().status == 200
        link.close()


class Visitor:
    """A browser that opens the pages of Strata and of the provider. Each browser has a separate
    address, because the server limits the sign-ins from one address."""

    made = 0

    def __init__(self, server):
        self.server, self.cookies = server, {}
        Visitor.made += 1
        self.address = f"10.7.{Visitor.made // 250}.{Visitor.made % 250 + 1}"

    def get(self, url):
        parts = urllib.parse.urlsplit(url)
        jar = self.cookies.setdefault(parts.netloc, {})
        link = http.client.HTTPConnection(parts.netloc, timeout=LONG_S)
        target = parts.path + (f"?{parts.query}" if parts.query else "")
        sent = {"X-Forwarded-For": self.address}
        if jar:
            sent["Cookie"] = "; ".join(f"{name}={value}" for name, value in jar.items())
        link.request("GET", target, headers=sent)
        answer = link.getresponse()
        for header in answer.headers.get_all("Set-Cookie") or []:
            for name, morsel in SimpleCookie(header).items():
                if morsel.value and morsel["max-age"] != "0":
                    jar[name] = morsel.value
                else:
                    jar.pop(name, None)
        read = Answer(answer.status, answer.headers, answer.read())
        link.close()
        if url.startswith(self.server.url):
            self.server.contract.check("GET", target, read)
        return read

    def get_api(self, path):
        return self.get(f"{self.server.url}/api/v1{path}")

    @property
    def jar(self):
        """The cookies of Strata."""
        return self.cookies.setdefault(urllib.parse.urlsplit(self.server.url).netloc, {})

    def begin(self, provider="museum", **query):
        """Begins a sign-in. Returns the address at the provider."""
        asked = "?" + urllib.parse.urlencode(query) if query else ""
        answer = self.get(f"{self.server.url}/sign-in/{provider}{asked}")
        assert answer.status == 303, answer
        return answer.headers["Location"]

    def callback(self, address, person):
        """Signs the person in at the provider; with None, refuses the sign-in. Returns
        the address at Strata to which the provider redirects."""
        self.cookies.pop(urllib.parse.urlsplit(address).netloc, None)  # forgets the last person
        for _ in range(10):
            answer = self.get(address)
            assert answer.status in (302, 303), answer
            address = urllib.parse.urljoin(address, answer.headers["Location"])
            if address.startswith(self.server.url):
                return address
            if "/interaction/" in address:
                address += f"?login={person}" if person else "?deny"
        raise AssertionError(f"the provider does not redirect to Strata: {address}")

    def sign_in(self, person, provider="museum", **query):
        return self.get(self.callback(self.begin(provider, **query), person))


def problem_of(answer):
    """Returns the code of a failed sign-in."""
    assert answer.status == 303, answer
    assert "strata_session" not in str(answer.headers), answer.headers
    path, _, problem = answer.headers["Location"].partition("?sign_in_problem=")
    assert path == "/", answer.headers
    return problem
