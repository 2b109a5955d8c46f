"""Two projects with one object of every kind each, and a guest's attempts to see one of the
projects, with every address of the contract."""
import re
import urllib.parse

from support.browsers import Browser, join
from support.contract import address_of
from support.live_client import LiveClient, Refused
from support.meshes import folded_grid

IN_PROJECTS = (
    "project",
    "model",
    "collection",
    "table",
    "attachment",
    "comment",
    "job",
    "kiosk",
)
OF_A_LAYER = ("/items", "/coverage", "/schema")  # parts of collections that a model lacks
OF_THE_SITE = ("user", "group", "session", "token", "tool", "provider")


class Someone(Browser):
    """A user who joined by an invitation."""

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
    """Makes two projects with one object of every kind each."""
    sites = {}
    for name in ("Villa", "Forum"):
        slug = name.lower()
        project = server.ok("POST", "/projects", {"name": name}).json()
        job = server.ok(
            "POST",
            "/models?"
            + urllib.parse.urlencode(
                {"filename": "x.ply", "name": name + " wall", "unit": "mm", "project": slug}
            ),
            folded_grid(fold=0.001),
        ).json()["id"]
        model = server.ok("GET", f"/models/{server.wait_for_job(job)['model']}").json()
        server.ok(
            "POST",
            f"/models/{model['slug']}/layers",
            {"name": "Marks", "type": "u8", "resolution": 2048},
        )
        table = server.ok(
            "POST",
            f"/projects/{slug}/tables",
            {
                "name": name + " finds",
                "columns": [{"name": "Photo", "kind": "picture"}, {"name": "What"}],
            },
        ).json()
        server.ok(
            "POST", f"/tables/{table['id']}/records", {"records": [{"values": {"what": "a coin"}}]}
        )
        attachment = server.ok(
            "POST", f"/tables/{table['id']}/records/1/attachments?column=photo&name=x.png", PNG
        ).json()["attachments"][0]
        comment = server.ok(
            "POST",
            f"/models/{model['slug']}/comments",
            {"text": "Look here.", "position": [0, 0, 0]},
        ).json()
        camera = {
            "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -300, 1],
            "projection": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.1, -1, 0, 0, -21, 0],
            "width": 400,
            "height": 400,
        }
        server.ok("POST", f"/models/{model['slug']}/views", {"name": "Plan", "camera": camera})
        server.ok(
            "POST",
            f"/models/{model['slug']}/tours",
            {
                "name": "Round",
                "languages": ["en"],
                "stops": [{"view": "plan", "title": {"en": "Here"}}],
            },
        )
        kiosk = server.ok(
            "POST", f"/models/{model['slug']}/tours/round/kiosks", {"name": "Hall"}
        ).json()["kiosk"]
        sites[slug] = {
            "comment": comment,
            "kiosk": {"id": kiosk["id"]},
            "project": project,
            "model": model,
            "collection": model,
            "table": table,
            "attachment": attachment,
            "job": {"id": job},
        }
    return sites


PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c6360f8cf0000000301010018dd8db40000000049454e44ae426082"
)


def doors(server, site):
    """Yields every operation of the contract in the project: the method, the address, and the same
    address for a missing object."""
    for path, operations in server.contract.document["paths"].items():
        place = next((name for name in IN_PROJECTS if "{" + name + "}" in path), None)
        if place is None or path.endswith("/live"):
            assert place or all(
                name in OF_THE_SITE for name in re.findall(r"\{(\w+)\}", path)
            ), f"whose is {path}?"
            continue
        for ref in ("id", "slug"):
            if ref not in site[place]:
                continue
            there, ghost = str(site[place][ref]), "987654321" if ref == "id" else "ghost"
            address = re.sub(r"\{(?!" + place + r"\})\w+\}", "1", address_of(path))
            if any(part in path for part in OF_A_LAYER):
                address = address.replace("{collection}", "{collection}.1")
            for method in operations:
                if method in ("get", "post", "put", "patch", "delete"):
                    yield method.upper(), address.replace(
                        "{" + place + "}", there
                    ), address.replace("{" + place + "}", ghost), there, ghost


def nothing_is_seen(server, guest, site):
    """Checks that invisible objects get the same response as missing ones."""
    count = 0
    for method, there, nowhere, ref, ghost in doors(server, site):
        body = {} if method in ("POST", "PUT", "PATCH") else None
        seen, missing = guest.request(method, there, body), guest.request(method, nowhere, body)
        assert seen.status == missing.status == 404, (method, there, seen, missing)
        assert seen.json()["detail"].replace(f"`{ref}`", "`x`") == missing.json()["detail"].replace(
            f"`{ghost}`", "`x`"
        ), (there, seen, missing)
        count += 1
    assert count > 120, f"only {count} doors were tried"
    slug = site["project"]["slug"]
    for path, member in (("/projects", "projects"), ("/models", "models"), ("/jobs", "jobs")):
        listed = guest.ok("GET", path).json()
        assert (
            slug not in str(listed)
            and site["model"]["slug"] not in str(listed)
            and listed["total"] == len(listed[member])
        ), listed
    assert (
        guest.status("GET", "/models?project=" + slug)
        == guest.status("GET", "/models?project=ghost")
        == 404
    )
    upload = "/models?" + urllib.parse.urlencode({"filename": "x.ply", "project": slug})
    assert (
        guest.status("POST", upload, folded_grid())
        == guest.status("POST", upload.replace(slug, "ghost"), folded_grid())
        == 404
    )
    assert (
        guest.status("POST", "/models?filename=x.ply", folded_grid()) == 404
    ), "the project `default`"
    try:
        LiveClient(server, site["model"]["slug"], token="", cookie=guest.cookie, origin=server.url)
        raise AssertionError("a guest looks at a model of another project")
    except Refused as refused:
        assert refused.status == 404, refused
    return count
