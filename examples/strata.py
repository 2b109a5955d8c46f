"""A small client for the HTTP interface of Strata, which needs only Python's standard library.

    from strata import Strata

    site = Strata("http://127.0.0.1:8080", token)
    model = site.import_model("scan.ply", unit="mm")
    print(site.get(f"/models/{model['slug']}/layers"))

Paths are those of /docs, without /api/v1. The token is STRATA_OWNER_TOKEN of the server, or one
that an administrator made for scripts. Copy this file and change it as you need.
"""

import json
import pathlib
import re
import time
import urllib.error
import urllib.parse
import urllib.request
import uuid


class Problem(Exception):
    """A refusal of the server and its reason (RFC 9457). `type` is the kind of the problem."""

    def __init__(self, status: int, body: dict):
        super().__init__(f"{status} {body.get('title', '')}: {body.get('detail', '')}")
        self.status = status
        self.type = body.get("type", "about:blank")
        self.field = body.get("field")


class Strata:
    def __init__(self, address: str, token: str):
        self.base = address.rstrip("/") + "/api/v1"
        self.token = token

    def request(self, method: str, path: str, body=None, content_type: str | None = None) -> bytes:
        """Sends bytes unchanged, text as UTF-8, other values as JSON."""
        return self._answer(method, path, body, content_type)[0]

    def _answer(self, method: str, path: str, body=None, content_type: str | None = None):
        headers = {"Authorization": "Bearer " + self.token}
        data = None
        if body is not None:
            if isinstance(body, bytes):
                data, kind = body, "application/octet-stream"
            elif isinstance(body, str):
                data, kind = body.encode(), "text/plain"
            else:
                data, kind = json.dumps(body).encode(), "application/json"
            headers["Content-Type"] = content_type or kind
        if method in ("POST", "PATCH", "DELETE"):
            # With this key, a request that is repeated after a broken connection has no second
            # effect.
            headers["Idempotency-Key"] = str(uuid.uuid4())
        return self._send(method, self.base + path, data, headers, 5)

    def _send(self, method: str, url: str, data, headers: dict, redirections: int):
        asked = urllib.request.Request(url, data=data, headers=headers, method=method)
        try:
            with urllib.request.urlopen(asked, timeout=300) as answer:
                return answer.read(), answer.headers
        except urllib.error.HTTPError as refusal:
            # Another node of the site has the model. Python itself does not repeat a POST.
            if refusal.code == 307 and redirections > 0 and refusal.headers["Location"]:
                there = urllib.parse.urljoin(url, refusal.headers["Location"])
                return self._send(method, there, data, headers, redirections - 1)
            text = refusal.read()
            try:
                problem = json.loads(text)
            except ValueError:
                problem = {"title": refusal.reason, "detail": text[:200].decode(errors="replace")}
            raise Problem(refusal.code, problem) from None

    def get(self, path: str):
        return json.loads(self.request("GET", path))

    def post(self, path: str, body, content_type: str | None = None):
        return json.loads(self.request("POST", path, body, content_type))

    def all(self, path: str, name: str, page: int = 500) -> list:
        """Returns a whole list, page by page: `name` is the member of each response that contains a
        part of the list. The header `Link` of each page has the address of the next page, so that
        no entry is missing or doubled while others write."""
        found: list = []
        following: str | None = f"{path}{'&' if '?' in path else '?'}limit={page}"
        while following:
            text, headers = self._answer("GET", following)
            found += json.loads(text)[name]
            link = re.search(r'<(?:[^>]*/api/v1)?([^>]*)>; *rel="next"', headers.get("Link", ""))
            following = link[1] if link else None
        return found

    def wait_for(self, job: str, every_s: float = 0.2) -> dict:
        """Waits for the job and returns it. Raises the problem of a job that failed."""
        while True:
            state = self.get(f"/jobs/{job}")
            if state["state"] == "done":
                return state
            if state["state"] in ("failed", "cancelled"):
                raise Problem(0, state.get("problem", {"title": state["state"]}))
            time.sleep(every_s)

    def import_model(self, file: str | pathlib.Path, **query) -> dict:
        """Imports a scan. POST /models describes the arguments: `name`, `unit` (mm, cm or m),
        `project` and others."""
        file = pathlib.Path(file)
        asked = urllib.parse.urlencode({"filename": file.name, **query})
        job = self.post(f"/models?{asked}", file.read_bytes())
        return self.get(f"/models/{self.wait_for(job['id'])['model']}")
