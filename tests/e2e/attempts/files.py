"""Files and addresses outside their folder, archives that expand, and texts with SQL."""
import io
import json
import os
import urllib.parse
import uuid
import zipfile

from attempts.tools import FILL, L, T, statuses
from support.meshes import folded_grid
from support.pictures import png
from support.process_memory import PeakGrowth
from support.raw_http import raw_request

PNG = png(8, 8, lambda x, y: (200, 100, 50))


def paths(server, section):
    """Requests a file on the server's machine in every spelling of its address."""
    kept = os.path.join(server.data, "secret.txt")
    with open(kept, "w", encoding="ascii") as file:
        file.write("the secret of this test")
    dots = ["..", "%2e%2e", ".%2e", "..%00", "%252e%252e", "..\\", "..%5c", "%c0%ae%c0%ae"]
    targets = [
        f"{start}/" + "/".join([dot] * 12) + path
        for start in ("", "/assets", "/kiosk", "/api/v1/docs")
        for dot in dots
        for path in (kept, "/etc/passwd", "/proc/self/environ")
    ]
    targets += [
        "/" + kept,
        "/%2f" + kept,
        "/.git/config",
        f"/api/v1/models/sheet/source/..%2f..%2f..%2f..{kept.replace('/', '%2f')}",
        "/api/v1/models/sheet/source/..%2fsheet.ply",
        "/api/v1/attachments/..%2f..%2fetc%2fpasswd",
    ]
    answers = [
        raw_request(
            server,
            f"GET {target} HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer {server.token}\r\nConnection: close\r\n\r\n".encode(),
        )
        for target in targets
    ]
    leaked = [
        answer
        for answer in answers
        if b"the secret of" in answer or b"root:" in answer or server.token.encode() in answer
    ]
    odd = {
        int(answer.split(b" ")[1])
        for answer in answers
        if b"<strata-app" not in answer and b"kiosk" not in answer
    }
    assert odd <= {400, 404, 503}, odd
    section.tried(
        "Addresses outside the page's folder: dots plain, escaped once and twice, with NUL, backslashes, overlong UTF-8",
        f"{len(leaked)} files returned",
        "0 files returned",
        "the server decodes each part of an address once and accepts only plain names; the file's real path must be in the folder",
        f"{len(targets)} addresses",
    )


def packed(*files):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files:
            archive.writestr(name, content)
    return made.getvalue()


def imported(server, name, body):
    """Returns the final state of the import, and the reason if it failed."""
    started = server.post(f"/models?filename={name}", body)
    if started.status != 202:
        return str(started.status), ""
    job = server.wait_for_job(started.json()["id"])
    if "model" in job:
        server.ok("DELETE", f"/models/{job['model']}")
    return job["state"], job.get("problem", {}).get("detail", "")


def archives(server, section):
    outside = f"/tmp/strata-slipped-{uuid.uuid4()}"
    for name in ("../" * 12 + outside[1:], outside, "..\\" * 12 + outside[1:].replace("/", "\\")):
        state, why = imported(
            server, "slip.zip", packed((name, b"x"), ("scan.ply", folded_grid(4)))
        )
        assert state == "done" and not os.path.exists(outside), (name, state, why)
    section.tried(
        "A zip with files named `../../…` or `/tmp/…` (zip slip)",
        "imported, nothing outside" if not os.path.exists(outside) else "outside",
        "imported, nothing outside",
        "the server gives unpacked files other names; it uses the names in the zip only to find companion files",
    )
    with PeakGrowth(server) as growth:
        states = {
            imported(server, name, body)[0]
            for name, body in (
                ("bomb.zip", packed(("scan.ply", bytes(200 << 20)))),
                ("many.zip", packed(*((f"{n}.txt", b"") for n in range(10_001)))),
                ("nested.zip", packed(("inner.zip", packed(("scan.ply", folded_grid(4)))))),
            )
        }
    section.tried(
        "A zip that unpacks to 1000 times its size, one with 10 001 files, one inside another",
        states,
        {"failed"},
        "limits of 100 times its size, 10 000 files and one level",
        growth.checked(512),
    )
    scene = {
        "asset": {"version": "2.0"},
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    ends = [
        imported(
            server,
            "scan.gltf",
            json.dumps({**scene, "buffers": [{"uri": uri, "byteLength": 36}]}).encode(),
        )
        for uri in (
            "file:///etc/passwd",
            "../../../../../../../../etc/passwd",
            "/etc/passwd",
            "http://127.0.0.1:1/x",
        )
    ]
    assert all("does not contain this file" in why for _, why in ends), ends
    obj = (
        b"mtllib ../../../../../../../../etc/passwd\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    )
    ends.append(
        imported(
            server,
            "scan.zip",
            packed(
                ("scan.obj", obj.replace(b"../../../../../../../../etc/passwd", b"a.mtl")),
                ("a.mtl", b"newmtl a\nmap_Kd /etc/passwd\n"),
            ),
        )
    )
    assert not any("root:" in why for _, why in ends), ends
    section.tried(
        "A glTF with its data in `file:///etc/passwd`, `../…` or at a URL",
        {state for state, _ in ends[:4]},
        {"failed"},
        "the server searches companion files only among the uploaded files, and opens no URL",
    )
    hollow = [
        b'{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]}',
        b'{"asset":' + b"[" * 1_000_000,
        b"",
    ]
    ends = [imported(server, "scan.gltf", body)[0] for body in hollow]
    header, _, data = folded_grid(4).partition(b"end_header\n")
    ends.append(
        imported(
            server,
            "lies.ply",
            header.replace(b"element vertex 25", b"element vertex 2000000000")
            + b"end_header\n"
            + data,
        )[0]
    )
    section.tried(
        "Scans with false data: cycles of nodes, a million brackets, two billion vertices in a small file",
        {end for end in ends if end != "400"},
        {"failed"},
        "the server compares counts with the size of the file before it allocates memory; all readers are fuzzed",
    )
    left = os.listdir(os.path.join(server.data, "uploads"))
    section.tried(
        "Files and models left by these attempts",
        f"{len(left)} files, {server.get('/models').json()['total']} model",
        "0 files, 1 model",
        "an import is one transaction, and its files are deleted with it",
    )


def attached(server, section):
    names = [
        "../../../../etc/cron.d/x",
        "..\\..\\x.exe",
        "a\r\nSet-Cookie: x=y",
        "x\u202egpj.exe",
        "/etc/passwd",
        "...",
        "x" * 5000,
    ]
    made = [
        server.post(T + "/records/1/attachments?name=" + urllib.parse.quote(name, safe=""), PNG)
        for name in names
    ]
    kept = [answer.json()["attachments"][0] for answer in made if answer.status == 201]
    assert statuses(made) <= {201, 431} and not any(
        mark in each["name"] for each in kept for mark in "/\\\r\n\u202e"
    ), made
    ways = {
        server.get(f"/attachments/{each['id']}")
        .headers["Content-Disposition"]
        .partition("UTF-8''")[0]
        for each in kept
    }
    assert ways == {"inline; filename*="}, ways
    section.tried(
        "Files of records named `../../x`, with line breaks, with reversed text",
        "stored under the last part of their names",
        "stored under the last part of their names",
        "the server cleans the names and uses them in no path: the database stores the files",
        f"{len(kept)} names",
    )
    running = [
        server.ok(
            "POST",
            T + "/records/1/attachments?name=photo.png",
            body,
            headers={"Content-Type": "image/png"},
        ).json()["attachments"][0]["id"]
        for body in (
            b"<html><script>alert(1)</script>",
            b"<svg xmlns='http://www.w3.org/2000/svg' onload='alert(1)'/>",
            b"%PDF-1.7<script>",
        )
    ]
    read = [server.get(f"/attachments/{id}") for id in running]
    section.tried(
        "HTML, SVG and PDF with scripts, sent as pictures",
        {answer.headers["Content-Security-Policy"] for answer in read},
        {"sandbox; default-src 'none'"},
        "the first bytes decide the type; browsers show files in a sandbox, and download them unless they are pictures or PDF",
    )
    bomb = bytearray(PNG)
    bomb[16:24] = (2**31 - 1).to_bytes(4, "big") * 2
    with PeakGrowth(server) as growth:
        id = server.ok("POST", T + "/records/1/attachments?name=bomb.png", bytes(bomb)).json()[
            "attachments"
        ][0]["id"]
        status = server.get(f"/attachments/{id}?thumbnail=256").status
    section.tried(
        "The thumbnail of a picture with a declared width of 2 147 483 647 pixels",
        status,
        422,
        "the server checks the size before it decodes pixels",
        growth.checked(64),
    )


def sql(server, section):
    texts = [
        "'; DROP TABLE projects; --",
        "note = 'x' OR 1=1 --",
        "1=1; SELECT pg_sleep(100)",
        "note = 'x' UNION SELECT hash FROM tokens",
        "pg_read_file('/etc/passwd') = 'x'",
        "(SELECT 1) = 1",
        "note = $1",
        "c1 = 'x'",
        "\"note\"::text = 'x'",
        "note ~ '(a+)+$'",
    ]
    asked = [
        path + urllib.parse.quote(text, safe="")
        for text in texts
        for path in (
            T + "/records?filter=",
            T + "/records?sortby=",
            "/models?project=",
            T + "/edits?key=",
            T + "/records/",
            "/tables/",
            "/users/",
        )
    ]
    answers = [server.get(path) for path in asked]
    answers += [server.post(L + "/edits", {**FILL, "where": text}) for text in texts] + [
        server.post(
            "/login",
            {"user": text, "password": text},
            token=False,
            headers={"X-Forwarded-For": f"10.8.0.{n}"},
        )
        for n, text in enumerate(texts)
    ]
    assert all(400 <= answer.status < 500 for answer in answers), [
        answer for answer in answers if not 400 <= answer.status < 500
    ]
    kept = server.get(T + "/records/1").json()["values"]["note"]
    section.tried(
        "SQL as filter, order, condition, key, address and name",
        f"refused, record is `{kept}`",
        "refused, record is `stays`",
        "a separate grammar parses expressions; values are parameters, and identifiers are numbers from the server",
        f"{len(answers)} calls",
    )


def repeated(server, section):
    """Uses the idempotency keys of other users."""
    nia = server.add_person("nia", "annotator")
    key = {"Idempotency-Key": "somebody's"}
    first = server.post(T + "/records", {"values": {"note": "owner's"}}, headers=key)
    assert (
        first.status == 201
        and server.post(T + "/records", {"values": {"note": "owner's"}}, headers=key).headers[
            "Idempotency-Replayed"
        ]
    )
    other = server.post(T + "/records", {"values": {"note": "owner's"}}, headers=key, token=nia)
    section.tried(
        "Another user's Idempotency-Key with the same call, to get that user's answer",
        "a new answer"
        if "Idempotency-Replayed" not in other.headers
        and other.json()["key"] != first.json()["key"]
        else "theirs",
        "a new answer",
        "a key belongs to one user, method and address",
    )
    section.tried(
        "The same key with another body",
        server.post(T + "/records", {"values": {"note": "another"}}, headers=key).status,
        422,
        "the key is stored with a digest of the request",
    )


def attempts(server, table):
    section = table.section("Files, addresses and texts")
    for attempt in (paths, archives, attached, sql, repeated):
        attempt(server, section)
