"""Browsers of users who sign in over HTTP, with a cookie and with the origin of the page."""
import re

PASSWORD = "seven blue herons at noon"


class Browser:
    """A user's browser. It stores the cookie, and sends the page's origin."""

    def __init__(self, server, agent="Mozilla/5.0 (X11; Linux) Firefox/128.0"):
        self.server, self.agent, self.cookie = server, agent, None

    def request(self, method, path, body=None, **headers):
        sent = {"User-Agent": self.agent, "Origin": self.server.url, **headers}
        if self.cookie:
            sent["Cookie"] = self.cookie
        answer = self.server.request(method, path, body, headers=sent, token=False)
        if answer.headers.get("Set-Cookie"):
            self.cookie = answer.headers["Set-Cookie"].split(";")[0]
        return answer

    def ok(self, method, path, body=None):
        answer = self.request(method, path, body)
        assert answer.status in (200, 201, 202, 204), (method, path, answer)
        return answer

    def sign_in(self, user, password):
        return self.request("POST", "/login", {"user": user, "password": password})


def uncoloured(person):
    """Returns the body without the user's color, which depends on the user's number."""
    assert re.fullmatch("#[0-9a-f]{6}", person["color"]), person
    return {name: value for name, value in person.items() if name != "color"}


def secret_of(invitation):
    path, _, secret = invitation["path"].partition("#")
    assert path == "/join" and len(secret) == 43, invitation
    return secret


def join(server, invitation, password=PASSWORD, **more):
    browser = Browser(server)
    browser.ok(
        "POST",
        "/invitations/accept",
        {"invitation": secret_of(invitation), "password": password, **more},
    )
    return browser
