"""Files of records over HTTP: upload and download of photos and documents, thumbnails, ranges, undo
and earlier states. The file also tests a gigabyte with little memory, a full disk, and a folder of
photos that is matched to records."""
import hashlib
import http.client
import os
import subprocess

import pytest
from support.live_client import LiveClient
from support.meshes import folded_grid
from support.pictures import png
from support.strata_server import wait_for

T = "/tables/units"
PHOTO = png(640, 480, lambda x, y: (x % 256, y % 256, 90))
PAPER = b"%PDF-1.7\n%%EOF\n"
GIGABYTE, PIECE = 1 << 30, 1 << 20
LARGEST_GROWTH = 64 << 20


def cell(server, key, column, query=""):
    return server.ok("GET", f"{T}/records/{key}{query}").json()["values"][column]


def attach(server, key, body, query="", headers=None, **more):
    return server.request(
        "POST", f"{T}/records/{key}/attachments{query}", body, headers=headers or {}, **more
    )


def make_table(server):
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Units",
            "columns": [
                {"name": "Code", "unique": True},
                {"name": "Photos", "kind": "picture"},
                {"name": "Papers", "kind": "document"},
            ],
        },
    )
    server.ok(
        "POST",
        T + "/records",
        {"records": [{"values": {"code": code}} for code in ("SU 1", "SU 2", "su_3")]},
    )


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(), "trench.ply", unit="mm", name="Trench")
    make_table(server)
    server.ok(
        "POST",
        "/models/trench/layers",
        {"name": "Units", "kind": "database", "type": "u16", "table": "units"},
    )
    return server


@pytest.fixture
def live(server):
    with LiveClient(server, "trench") as live:
        live.hello()
        yield live


def test_in_and_out(server, live, story):
    keyed = {"Idempotency-Key": "north"}
    made = attach(server, 1, PHOTO, "?name=../../etc/SU%201%20north.png", keyed)
    assert made.status == 201 and made.json()["total"] == 1, made
    photo = made.json()["attachments"][0]
    assert made.headers["Location"] == f"/api/v1/attachments/{photo['id']}"
    assert (photo["name"], photo["media_type"], photo["width"], photo["height"]) == (
        "SU 1 north.png",
        "image/png",
        640,
        480,
    ), photo
    assert photo["sha256"] == hashlib.sha256(PHOTO).hexdigest() and photo["bytes"] == len(PHOTO)
    told = live.receive_until("record")
    assert told["record"] == made.json()["record"] and told["record"]["values"]["photos"] == [
        photo["id"]
    ], told
    again = attach(server, 1, PHOTO, "?name=../../etc/SU%201%20north.png", keyed)
    assert again.json() == made.json() and cell(server, 1, "photos") == [photo["id"]]

    form = (
        b"".join(
            b'--XyZ\r\nContent-Disposition: form-data; name="file"; filename="%s"\r\n\r\n%s\r\n'
            % part
            for part in ((b"plan/section.pdf", PAPER), (b"notes.csv", b"a,b\n1,2\n"))
        )
        + b"--XyZ--\r\n"
    )
    papers = attach(
        server, 1, form, headers={"Content-Type": "multipart/form-data; boundary=XyZ"}
    ).json()["attachments"]
    assert [(each["name"], each["media_type"]) for each in papers] == [
        ("section.pdf", "application/pdf"),
        ("notes.csv", "text/csv"),
    ]
    listed = server.ok("GET", T + "/records/1/attachments").json()
    assert [(each["column"], each["name"]) for each in listed["attachments"]] == [
        ("photos", "SU 1 north.png"),
        ("papers", "section.pdf"),
        ("papers", "notes.csv"),
    ] and listed["total"] == 3
    assert server.ok("GET", "/models/trench/layers/units/records/1/attachments").json() == listed
    by_header = attach(
        server, 2, PAPER, headers={"Content-Disposition": 'attachment; filename="report.pdf"'}
    ).json()
    assert by_header["attachments"][0]["name"] == "report.pdf"
    story.photo, story.papers = photo, papers


def test_reading(server, story):
    photo = story.photo
    papers = story.papers
    path = f"/attachments/{photo['id']}"
    whole = server.ok("GET", path)
    assert whole.body == PHOTO and whole.headers["Content-Type"] == "image/png"
    assert whole.headers["Content-Disposition"] == "inline; filename*=UTF-8''SU%201%20north.png"
    assert whole.headers.get_all("Content-Security-Policy") == ["sandbox; default-src 'none'"]
    assert (
        whole.headers["X-Content-Type-Options"] == "nosniff"
        and whole.headers["Accept-Ranges"] == "bytes"
    )
    etag = whole.headers["ETag"]
    assert server.request("GET", path, headers={"If-None-Match": etag}).status == 304
    assert server.request("HEAD", path).headers["Content-Length"] == str(len(PHOTO))
    part = server.request("GET", path, headers={"Range": "bytes=10-19"})
    assert (part.status, part.body, part.headers["Content-Range"]) == (
        206,
        PHOTO[10:20],
        f"bytes 10-19/{len(PHOTO)}",
    ), part
    assert server.request("GET", path, headers={"Range": "bytes=-5"}).body == PHOTO[-5:]
    assert (
        server.request("GET", path, headers={"Range": "bytes=10-19", "If-Range": '"another"'}).body
        == PHOTO
    )
    behind = server.request("GET", path, headers={"Range": f"bytes={len(PHOTO)}-"})
    assert behind.status == 416 and behind.headers["Content-Range"] == f"bytes */{len(PHOTO)}"
    small = server.ok("GET", path + "?thumbnail=256")
    assert (
        small.headers["Content-Type"] == "image/jpeg"
        and small.body[:3] == b"\xff\xd8\xff"
        and len(small.body) < len(PHOTO)
    )
    assert (
        server.ok("GET", path + "?thumbnail=256").body == small.body
        and small.headers["ETag"] != etag
    )
    assert server.get(path + "?thumbnail=100").status == 422
    assert server.get(f"/attachments/{papers[0]['id']}?thumbnail=256").status == 415
    download = server.ok("GET", f"/attachments/{papers[1]['id']}")
    assert (
        download.headers["Content-Disposition"].startswith("attachment;")
        and download.body == b"a,b\n1,2\n"
    )
    assert server.get("/attachments/4711").status == server.get("/attachments/x").status == 404
    assert server.request("GET", path, token=False).status == 401


def test_undo_and_past(server, story):
    photo = story.photo
    before = server.ok("GET", T).json()["sequence"]
    server.ok("DELETE", f"/attachments/{photo['id']}", headers={"Idempotency-Key": "out"})
    server.ok("DELETE", f"/attachments/{photo['id']}", headers={"Idempotency-Key": "out"})
    assert cell(server, 1, "photos") is None and cell(server, 1, "photos", f"?at={before}") == [
        photo["id"]
    ]
    assert server.request("DELETE", f"/attachments/{photo['id']}").status == 404
    past = server.ok("GET", f"{T}/records/1/attachments?at={before}").json()["attachments"]
    assert (
        past[0]["id"] == photo["id"]
        and server.ok("GET", f"/attachments/{photo['id']}").body == PHOTO
    )
    server.ok("POST", T + "/undo")
    assert cell(server, 1, "photos") == [photo["id"]]
    server.ok("PATCH", T + "/records/2", {"values": {"photos": [photo["id"]]}})
    text = server.ok("GET", T + "/records?f=csv").body.decode("utf-8-sig")
    assert text.splitlines()[2] == f"2,SU 2,{photo['id']},{cell(server, 2, 'papers')[0]}", text
    same = server.ok(
        "POST", T + "/records", text.encode(), headers={"Content-Type": "text/csv"}
    ).json()
    assert same["unchanged"] == 3 and same["changed"] == 0, same


def test_folder_of_photos(server):
    asked = {
        "pattern": "{code}_{view}_{n}.jpg",
        "column": "code",
        "names": [
            "SU 1_north_1.jpg",
            "trip/SU 2_north_1.JPG",
            "su-1_top_2.jpg",
            "SU_3_top_1.jpg",
            "SU 99_north_1.jpg",
            "IMG_0001.jpg",
            "SU 1_north_1.jpg",
            "SU 1_taken_1.jpg",
        ],
    }
    server.ok(
        "POST", T + "/records/1/attachments?name=SU+1_taken_1.jpg&column=papers", b"there already"
    )
    told = server.ok("POST", T + "/attachments/match", asked).json()
    assert [
        (each["name"], each["key"], each["words"]["view"], each["words"]["n"])
        for each in told["matched"]
    ] == [
        ("SU 1_north_1.jpg", 1, "north", "1"),
        ("trip/SU 2_north_1.JPG", 2, "north", "1"),
        ("su-1_top_2.jpg", 1, "top", "2"),
        ("SU_3_top_1.jpg", 3, "top", "1"),
    ], told[
        "matched"
    ]
    assert [(each["name"], each["reason"]) for each in told["unmatched"]] == [
        ("SU 99_north_1.jpg", "record"),
        ("IMG_0001.jpg", "pattern"),
    ], told
    assert [(each["name"], each["reason"]) for each in told["duplicate"]] == [
        ("SU 1_north_1.jpg", "twice"),
        ("SU 1_taken_1.jpg", "attached"),
    ], told
    assert told["total"] == 8
    by_key = server.ok(
        "POST",
        T + "/attachments/match",
        {"pattern": "{key}.png", "column": "key", "names": ["2.png", "7.png"]},
    ).json()
    assert by_key["matched"][0]["key"] == 2 and by_key["unmatched"][0]["reason"] == "record"
    server.ok("POST", T + "/records", {"values": {"code": "SU-1"}})
    server.ok("POST", T + "/records", {"values": {"code": "S.U 1"}})
    several = server.ok(
        "POST",
        T + "/attachments/match",
        {**asked, "names": ["su_1_north_1.jpg", "SU-1_north_1.jpg"]},
    ).json()
    assert (
        several["unmatched"][0]["reason"] == "several" and several["matched"][0]["key"] == 4
    ), several
    for change, field in [
        ({"pattern": "{view}.jpg"}, "pattern"),
        ({"pattern": "{code"}, "pattern"),
        ({"column": "none"}, "column"),
        ({"names": []}, "names"),
    ]:
        refused = server.post(T + "/attachments/match", {**asked, **change})
        assert refused.status in (400, 422) and refused.json()["field"] == field, refused


def test_refusals(server, story):
    photo = story.photo
    for what, status, field, answer in [
        ("no such record", 404, None, attach(server, 99, PHOTO)),
        ("nothing", 400, "body", attach(server, 1, b"")),
        ("a column of text", 422, "column", attach(server, 1, PHOTO, "?column=code")),
        ("no such column", 422, "column", attach(server, 1, PHOTO, "?column=none")),
        ("no picture", 422, "values.photos", attach(server, 1, PAPER, "?column=photos")),
        (
            "a name for several",
            422,
            "name",
            attach(
                server,
                1,
                b"".join(
                    b'--X\r\nContent-Disposition: form-data; name="f"; filename="%d"\r\n\r\nx\r\n'
                    % n
                    for n in (1, 2)
                )
                + b"--X--\r\n",
                "?name=one",
                {"Content-Type": "multipart/form-data; boundary=X"},
            ),
        ),
        (
            "a stale version",
            412,
            "If-Match",
            attach(server, 1, PHOTO, headers={"If-Match": '"v0"'}),
        ),
        ("no session", 401, None, attach(server, 1, PHOTO, token=False)),
        (
            "a file of nobody's",
            422,
            "values.photos",
            server.request("PATCH", T + "/records/1", {"values": {"photos": [4711]}}),
        ),
        (
            "a default",
            422,
            "default",
            server.post(T + "/columns", {"name": "x", "kind": "picture", "default": [photo["id"]]}),
        ),
        (
            "another kind",
            422,
            "maximum",
            server.post(T + "/columns", {"name": "x", "kind": "document", "maximum": 1}),
        ),
    ]:
        assert answer.status == status, f"{what}: {answer}"
        if status != 401 and field:
            assert answer.json()["field"] == field, f"{what}: {answer}"


def test_broken_off(server):
    uploads = os.path.join(server.data, "uploads")
    attach(server, 3, PAPER, "?name=before.pdf")
    count = len(cell(server, 3, "papers"))
    link = server.connect()
    link.putrequest("POST", f"/api/v1{T}/records/3/attachments")
    link.putheader("Authorization", "Bearer " + server.token)
    link.putheader("Content-Length", 1000000)
    link.endheaders(b"half")
    wait_for(lambda: os.listdir(uploads), "the upload to begin")
    link.close()
    wait_for(lambda: not os.listdir(uploads), "what was sent to go")
    assert len(cell(server, 3, "papers")) == count


def test_a_full_disk(server):
    uploads = os.path.join(server.data, "uploads")
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=1m,mode=777", "tmpfs", uploads],
        capture_output=True,
        check=False,
    )
    if mounted.returncode != 0:
        pytest.skip("no right to mount a small disk")
    try:
        count = len(cell(server, 3, "papers"))
        answer = attach(server, 3, b"%PDF-" + bytes(3 << 20))
        assert answer.status == 507 and answer.json()["title"] == "Disk full", answer
        form = (
            b'--X\r\nContent-Disposition: form-data; name="f"; filename="a"\r\n\r\n'
            + bytes(700 << 10)
            + b"\r\n--X--\r\n"
        )
        answer = attach(
            server, 3, form, headers={"Content-Type": "multipart/form-data; boundary=X"}
        )
        assert answer.status == 507, answer
        assert not os.listdir(uploads) and len(cell(server, 3, "papers")) == count
    finally:
        subprocess.run(["umount", uploads], check=True)


def test_a_gigabyte_in_little_memory(server):
    """A gigabyte is uploaded, as a body and in a form, and downloaded as streams. The server's
    memory hardly grows."""
    pieces = [hashlib.sha256(bytes([n])).digest() * (PIECE // 32) for n in range(256)]
    wanted = hashlib.sha256()
    for n in range(GIGABYTE // PIECE):
        wanted.update(pieces[n % 256])
    status_file = f"/proc/{server.process.pid}/status"

    def memory(line):
        with open(status_file, encoding="ascii") as file:
            return next(int(each.split()[1]) << 10 for each in file if each.startswith(line + ":"))

    def send(key, head, tail, headers):
        link = server.connect()
        link.putrequest("POST", f"/api/v1{T}/records/{key}/attachments?column=papers")
        for name, value in {
            "Authorization": "Bearer " + server.token,
            "Content-Length": len(head) + GIGABYTE + len(tail),
            **headers,
        }.items():
            link.putheader(name, value)
        link.endheaders(head)
        for n in range(GIGABYTE // PIECE):
            link.send(pieces[n % 256])
        link.send(tail)
        answer = link.getresponse()
        body = answer.read()
        link.close()
        assert answer.status == 201, body
        made = server.ok("GET", f"{T}/records/{key}/attachments").json()["attachments"][-1]
        assert made["sha256"] == wanted.hexdigest() and made["bytes"] == GIGABYTE, made
        return made

    with open(f"/proc/{server.process.pid}/clear_refs", "w", encoding="ascii") as file:
        file.write("5")  # resets the peak size to the current size
    before = memory("VmRSS")
    first = send(3, b"", b"", {})
    second = send(
        3,
        b'--XyZ\r\nContent-Disposition: form-data; name="file"; filename="tour.mp4"\r\n\r\n',
        b"\r\n--XyZ--\r\n",
        {"Content-Type": "multipart/form-data; boundary=XyZ"},
    )
    assert second["name"] == "tour.mp4" and second["id"] != first["id"]
    link = http.client.HTTPConnection(server.host, server.port, timeout=180)
    link.request(
        "GET",
        f"/api/v1/attachments/{second['id']}",
        headers={"Authorization": "Bearer " + server.token},
    )
    answer, read = link.getresponse(), hashlib.sha256()
    while piece := answer.read(PIECE):
        read.update(piece)
    link.close()
    assert read.hexdigest() == wanted.hexdigest()
    middle = server.request(
        "GET",
        f"/attachments/{first['id']}",
        headers={"Range": f"bytes={5 * PIECE - 2}-{5 * PIECE + 1}"},
    )
    assert middle.body == pieces[4][-2:] + pieces[5][:2], middle
    grown = memory("VmHWM") - before
    assert grown < LARGEST_GROWTH, f"the server grew by {grown >> 20} MiB"
    print(f"a gigabyte twice in and once out: the server grew by {grown >> 20} MiB")


def test_all_of_it_is_durable(server, story):
    assert server.stop() == 0
    server.start()
    assert server.ok("GET", f"/attachments/{story.photo['id']}").body == PHOTO


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
