#!/usr/bin/env python3
"""Roles in one project: what a guest sees of the others (nothing, through every door of the contract), and what each role does in its own."""
import os
import re
import sys
import urllib.parse

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support.browsers import Browser, join
from support.live_client import LiveClient, Refused
from support.meshes import folded_grid
from support.strata_server import StrataServer

FILL = {"op": "fill", "mode": "where", "where": "true", "value": 1}
IN_PROJECTS = ("project", "model", "table", "attachment", "comment", "job", "kiosk")
OF_THE_SITE = ("user", "session", "token", "tool")


class Someone(Browser):
    """A person who came in by an invitation."""

    def __init__(self, server, user, role):
        invitation = server.ok("POST", "/users", {"user": user, "role": role}).json()
        super().__init__(server)
        self.user, self.cookie = user, join(server, invitation).cookie

    def status(self, method, path, body=None):
        return self.request(method, path, body).status

    def now(self, project, role):
        if role:
            self.server.ok("PUT", f"/projects/{project}/members/{self.user}", {"role": role})
        else:
            self.server.ok("DELETE", f"/projects/{project}/members/{self.user}")


def make_sites(server):
    """Two projects that have one of everything each."""
    sites = {}
    for name in ("Villa", "Forum"):
        slug = name.lower()
        project = server.ok("POST", "/projects", {"name": name}).json()
        job = server.ok("POST", "/models?" + urllib.parse.urlencode({"filename": "x.ply", "name": name + " wall", "unit": "mm", "project": slug}), folded_grid(fold=0.001)).json()["id"]
        model = server.ok("GET", f"/models/{server.wait_for_job(job)['model']}").json()
        server.ok("POST", f"/models/{model['slug']}/layers", {"name": "Marks", "type": "u8", "resolution": 2048})
        table = server.ok("POST", f"/projects/{slug}/tables", {"name": name + " finds", "columns": [{"name": "Photo", "kind": "picture"}, {"name": "What"}]}).json()
        server.ok("POST", f"/tables/{table['id']}/records", {"records": [{"values": {"what": "a coin"}}]})
        attachment = server.ok("POST", f"/tables/{table['id']}/records/1/attachments?column=photo&name=x.png", PNG).json()["attachments"][0]
        comment = server.ok("POST", f"/models/{model['slug']}/comments", {"text": "Look here.", "position": [0, 0, 0]}).json()
        camera = {"view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -300, 1], "projection": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.1, -1, 0, 0, -21, 0], "width": 400, "height": 400}
        server.ok("POST", f"/models/{model['slug']}/views", {"name": "Plan", "camera": camera})
        server.ok("POST", f"/models/{model['slug']}/tours", {"name": "Round", "languages": ["en"], "stops": [{"view": "plan", "title": {"en": "Here"}}]})
        kiosk = server.ok("POST", f"/models/{model['slug']}/tours/round/kiosks", {"name": "Hall"}).json()["kiosk"]
        sites[slug] = {"comment": comment, "kiosk": {"id": kiosk["id"]}, "project": project, "model": model, "table": table, "attachment": attachment, "job": {"id": job}}
    return sites


PNG = bytes.fromhex("89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c6360f8cf0000000301010018dd8db40000000049454e44ae426082")


def doors(server, site):
    """Every operation of the contract that leads into the project: method, address there, and the same of what is not there."""
    for path, operations in server.contract.document["paths"].items():
        place = next((name for name in IN_PROJECTS if "{" + name + "}" in path), None)
        if place is None or path.endswith("/live"):
            assert place or all(name in OF_THE_SITE for name in re.findall(r"\{(\w+)\}", path)), f"whose is {path}?"
            continue
        for ref in ("id", "slug"):
            if ref not in site[place]:
                continue
            there, ghost = str(site[place][ref]), "987654321" if ref == "id" else "ghost"
            address = re.sub(r"\{(?!" + place + r"\})\w+\}", "1", path.removeprefix("/api/v1"))
            for method in operations:
                if method in ("get", "post", "put", "patch", "delete"):
                    yield method.upper(), address.replace("{" + place + "}", there), address.replace("{" + place + "}", ghost), there, ghost


def nothing_is_seen(server, guest, site):
    """What is there and not for them answers like what is not there."""
    count = 0
    for method, there, nowhere, ref, ghost in doors(server, site):
        body = {} if method in ("POST", "PUT", "PATCH") else None
        seen, missing = guest.request(method, there, body), guest.request(method, nowhere, body)
        assert seen.status == missing.status == 404, (method, there, seen, missing)
        assert seen.json()["detail"].replace(f"`{ref}`", "`x`") == missing.json()["detail"].replace(f"`{ghost}`", "`x`"), (there, seen, missing)
        count += 1
    assert count > 120, f"only {count} doors were tried"
    slug = site["project"]["slug"]
    for path, member in (("/projects", "projects"), ("/models", "models"), ("/jobs", "jobs")):
        listed = guest.ok("GET", path).json()
        assert slug not in str(listed) and site["model"]["slug"] not in str(listed) and listed["total"] == len(listed[member]), listed
    assert guest.status("GET", "/models?project=" + slug) == guest.status("GET", "/models?project=ghost") == 404
    upload = "/models?" + urllib.parse.urlencode({"filename": "x.ply", "project": slug})
    assert guest.status("POST", upload, folded_grid()) == guest.status("POST", upload.replace(slug, "ghost"), folded_grid()) == 404
    assert guest.status("POST", "/models?filename=x.ply", folded_grid()) == 404, "the project `default`"
    try:
        LiveClient(server, site["model"]["slug"], token="", cookie=guest.cookie, origin=server.url)
        raise AssertionError("a guest looks at a model of another project")
    except Refused as refused:
        assert refused.status == 404, refused
    return count


def ladder(server, guest, villa, forum):
    """In the villa, from nothing to curator and back."""
    model, table = "/models/" + villa["model"]["slug"], f"/tables/{villa['table']['id']}"
    tries = (("GET", model, None), ("POST", model + "/layers/marks/edits", FILL), ("PATCH", model, {"credit": "x"}), ("GET", "/projects/villa/members", None),
             ("PUT", f"/projects/villa/members/{guest.user}", {"role": "curator"}), ("PATCH", "/projects/villa", {"description": "mine"}), ("GET", "/users", None))
    for role, good in ((None, 0), ("viewer", 1), ("annotator", 2), ("curator", 4), ("viewer", 1)):
        if role:
            guest.now("villa", role)
        for i, (method, path, body) in enumerate(tries):
            status = guest.status(method, path, body)
            assert status == (200 if i < good else 403 if role or path == "/users" else 404), (role, method, path, status)
        listed = {project["slug"]: project["role"] for project in guest.ok("GET", "/projects").json()["projects"]}
        assert listed == ({"villa": role} if role else {}), listed
    guest.now("villa", "curator")
    assert guest.ok("GET", "/me").json()["role"] == "guest"
    for path in ("/tools", "/templates", "/me/sessions", table + "/records", f"/attachments/{villa['attachment']['id']}", f"/jobs/{villa['job']['id']}"):
        guest.ok("GET", path)
    assert [model["slug"] for model in guest.ok("GET", "/models").json()["models"]] == [villa["model"]["slug"]]
    assert [job["id"] for job in guest.ok("GET", "/jobs").json()["jobs"]] == [villa["job"]["id"]]
    assert guest.ok("GET", "/projects/villa/members").json() == {"members": [{"user": guest.user, "full_name": "", "role": "curator"}], "total": 1}
    imported = server.wait_for_job(guest.ok("POST", "/models?filename=y.ply&name=Second&unit=mm&project=villa", folded_grid(fold=0.002)).json()["id"])
    assert imported["state"] == "done", imported
    # From a model of elsewhere nothing can be brought over.
    refused = [guest.request("POST", "/models/second/transfer", {"from": source}) for source in (forum["model"]["slug"], "ghost")]
    assert [answer.status for answer in refused] == [422, 422] and refused[0].json()["detail"].replace(forum["model"]["slug"], "ghost") == refused[1].json()["detail"], refused


def scripts(server, guest, villa):
    """A token does no more than its own role, in every project."""
    def token(**asked):
        made = guest.ok("POST", "/me/tokens", {"name": "t", "days": 1, **asked}).json()
        return made["secret"]

    model = "/models/" + villa["model"]["slug"]
    weak, full = token(role="viewer"), token()
    assert server.get(model, token=weak).status == 200 and server.request("PATCH", model, {"credit": "x"}, token=weak).status == 403
    assert server.request("PATCH", model, {"credit": "y"}, token=full).status == 200
    assert guest.status("POST", "/me/tokens", {"name": "t", "days": 1, "role": "administrator"}) == 403
    root = server.ok("POST", "/me/tokens", {"name": "t", "days": 1}).json()["secret"]
    assert server.request("PUT", f"/projects/villa/members/{guest.user}", {"role": "viewer"}, token=root).status == 403, "scripts change nobody's role"


def both(server, villa, forum):
    """Who may look everywhere does more where they have a role, and no less elsewhere."""
    vera = Someone(server, "Vera", "viewer")
    vera.now("villa", "curator")
    vera.ok("PATCH", "/models/" + villa["model"]["slug"], {"credit": "Vera"})
    vera.ok("GET", "/models/" + forum["model"]["slug"])
    assert vera.status("PATCH", "/models/" + forum["model"]["slug"], {"credit": "Vera"}) == 403
    vera.now("forum", "annotator")
    vera.ok("POST", f"/models/{forum['model']['slug']}/layers/marks/edits", FILL)
    assert {project["slug"]: project["role"] for project in vera.ok("GET", "/projects").json()["projects"]} == {"default": "viewer", "villa": "curator", "forum": "annotator"}
    anne = Someone(server, "Anne", "curator")
    anne.now("villa", "viewer")
    anne.ok("PATCH", "/models/" + villa["model"]["slug"], {"credit": "Anne"})
    # What is wrong is told.
    for body, status in (({"role": "administrator"}, 422), ({"role": "guest"}, 422), ({}, 422), ({"role": "viewer", "x": 1}, 422)):
        assert server.request("PUT", "/projects/villa/members/Anne", body).status == status, body
    for path in ("/projects/villa/members/nobody", "/projects/ghost/members/Anne"):
        assert server.request("PUT", path, {"role": "viewer"}).status == 404, path
    anne.now("villa", None)
    assert server.request("DELETE", "/projects/villa/members/Anne").status == 404
    server.ok("DELETE", "/users/Vera")
    assert "Vera" not in str(server.ok("GET", "/projects/villa/members").json())


def live(server, guest, villa):
    """An open connection ends with the role, and another one has the new role."""
    def look():
        return LiveClient(server, villa["model"]["slug"], token="", cookie=guest.cookie, origin=server.url)

    for role, then in (("curator", "viewer"), ("viewer", None)):
        with look() as connection:
            assert connection.hello(dpr=1, accept=["jpeg"])["role"] == role
            guest.now("villa", then)
            connection.until_closed()
    try:
        look()
        raise AssertionError("they are no member any more")
    except Refused as refused:
        assert refused.status == 404, refused


def main():
    with StrataServer() as server:
        sites = make_sites(server)
        villa, forum = sites["villa"], sites["forum"]
        guest = Someone(server, "Gus", "guest")
        doors_tried = nothing_is_seen(server, guest, villa)
        ladder(server, guest, villa, forum)
        nothing_is_seen(server, guest, forum)
        scripts(server, guest, villa)
        both(server, villa, forum)
        live(server, guest, villa)
        nothing_is_seen(server, guest, villa)
        server.assert_clean_log()
    print(f"project roles: {doors_tried} doors closed to a guest; roles, tokens and connections follow the project")


if __name__ == "__main__":
    main()
