"""Photographs with camera poses over HTTP: import of an export, images, the photographs that see a
place, pictures without distortion, roles, and deletion."""
import io
import math
import zipfile

import pytest
from support.addresses import query
from support.meshes import ply
from support.pictures import png

M = "/models/cube"
ALL = M + "/photographs"
POSES = M + "/photograph-poses"
WIDTH, HEIGHT, FOCAL = 96, 64, 100
DISTANCE = 300.0
# A cube with a side of 100 mm around the origin, whose faces point outwards.
CORNERS = [(x, y, z) for x in (-50.0, 50.0) for y in (-50.0, 50.0) for z in (-50.0, 50.0)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE = ply(CORNERS, [f for a, b, c, d in SIDES for f in ((a, b, c), (a, c, d))])
# The rotations from world to camera axes, as quaternions, of cameras that look at the origin:
# from +z, from -z, and from +x.
LOOKS = {
    "site/top.png": ((0, 1, 0, 0), (0, 0, DISTANCE)),
    "site/bottom.png": ((1, 0, 0, 0), (0, 0, -DISTANCE)),
    "site/right.png": ((0.5, 0.5, 0.5, -0.5), (DISTANCE, 0, 0)),
    "site/near_top.png": ((0, 1, 0, 0), (10, 0, DISTANCE / 2)),
}
K1 = -0.1


def export(looks=None, width=WIDTH, scale=1.0):
    """Returns a zip with the text files of COLMAP. The translation leads to camera axes, so a camera
    that looks at the origin from a distance d has (0, 0, d)."""
    cameras = f"1 SIMPLE_RADIAL {width} {HEIGHT} {FOCAL} {width / 2} {HEIGHT / 2} {K1}\n"
    images = ""
    for i, (name, (q, center)) in enumerate((looks or LOOKS).items()):
        w, x, y, z = q
        rows = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
        t = [-scale * sum(row[k] * center[k] for k in range(3)) for row in rows]
        images += f"{i + 1} {w} {x} {y} {z} {t[0]} {t[1]} {t[2]} 1 {name}\n\n"
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("sparse/0/cameras.txt", cameras)
        file.writestr("sparse/0/images.txt", images)
        file.writestr("images/top.png", b"not needed")
    return packed.getvalue()


def picture(width=WIDTH, height=HEIGHT, red=0):
    """A white square in the middle of a colored image."""
    return png(
        width,
        height,
        lambda x, y: (
            (255, 255, 255)
            if abs(x + 0.5 - width / 2) < 8 and abs(y + 0.5 - height / 2) < 8
            else (red, 80, 160)
        ),
    )


@pytest.fixture(scope="module")
def server(server):
    server.import_model(CUBE, "cube.ply", name="Cube", unit="mm")
    return server


@pytest.fixture(scope="module")
def ids(server):
    """The poses are imported, and their ids by name."""
    made = server.ok("POST", POSES, export()).json()
    assert (made["format"], made["added"], made["updated"]) == ("colmap", 4, 0), made
    assert made["refused"] == [] and made["total"] == 4, made
    listed = server.get(ALL).json()
    assert [p["name"] for p in listed["photographs"]] == sorted(LOOKS)
    assert (listed["total"], listed["with_picture"]) == (4, 0)
    return {p["name"]: p["id"] for p in listed["photographs"]}


def refused(answer, status, field=None):
    assert answer.status == status and answer.json()["detail"], answer
    if field:
        assert answer.json()["field"] == field, answer
    return answer.json()


def seeing(server, point, **more):
    return server.ok("POST", ALL + "/seeing", {"at": {"point": point}, **more}).json()


def in_window(camera, point):
    """The pixel of a point in the window of a camera. The matrices are column by column."""

    def times(matrix, vector):
        return [sum(matrix[4 * k + row] * vector[k] for k in range(4)) for row in range(4)]

    clip = times(camera["projection"], times(camera["view"], [*point, 1]))
    return [
        (clip[0] / clip[3] + 1) / 2 * camera["width"],
        (1 - clip[1] / clip[3]) / 2 * camera["height"],
    ]


def test_a_photograph_has_a_pinhole_camera(server, ids):
    one = server.get(f"{ALL}/{ids['site/right.png']}").json()
    assert one["center"] == pytest.approx([DISTANCE, 0, 0], abs=1e-9)
    assert (one["width"], one["height"], one["has_picture"]) == (WIDTH, HEIGHT, False)
    camera = one["camera"]
    assert in_window(camera, (50, 0, 0)) == pytest.approx(
        [camera["width"] / 2, camera["height"] / 2], abs=1e-6
    )
    middle = {"camera": camera, "x": camera["width"] / 2, "y": camera["height"] / 2}
    picked = server.ok("POST", M + "/pick", middle).json()
    assert picked["position"] == pytest.approx([50, 0, 0], abs=1e-3)


def test_pages_follow_each_other(server, ids):
    first = server.get(ALL + "?limit=3")
    assert len(first.json()["photographs"]) == 3
    following = first.headers["Link"].split(">")[0].split("<")[1]
    assert [p["name"] for p in server.get("/" + following).json()["photographs"]] == [
        "site/top.png"
    ]
    refused(server.get(ALL + "?after=WzFd"), 422, "after")


def test_a_list_can_be_of_some_photographs(server, ids):
    found = server.get(ALL + "?q=SITE/&has_picture=false&limit=1")
    assert found.json()["total"] == 4 and len(found.json()["photographs"]) == 1
    rest = server.get("/" + found.headers["Link"].split(">")[0].split("<")[1]).json()
    assert rest["total"] == 4
    assert server.get(ALL + "?q=top.").json()["total"] == 2
    assert server.get(ALL + "?has_picture=true").json()["photographs"] == []
    refused(server.get(ALL + "?has_picture=yes"), 422, "has_picture")
    refused(server.get(ALL + "?q=" + 201 * "a"), 422, "q")


def test_photographs_that_see_a_place_are_found(server, ids):
    found = seeing(server, [5, 3, 50])
    assert found["position"] == pytest.approx([5, 3, 50], abs=1e-4)
    assert found["normal"] == pytest.approx([0, 0, 1], abs=1e-5)
    assert [s["photograph"]["name"] for s in found["photographs"]] == [
        "site/near_top.png",
        "site/top.png",
    ]
    assert (found["total"], found["unknown_size"]) == (2, 0)
    top = found["photographs"][1]
    # The camera turns around x, so its y axis points to -y of the world. k1 of COLMAP bends x/z.
    x, y = 5 / 250, -3 / 250
    bent = 1 + K1 * (x * x + y * y)
    assert top["pixel"] == pytest.approx(
        [WIDTH / 2 + FOCAL * x * bent, HEIGHT / 2 + FOCAL * y * bent], abs=1e-3
    )
    assert top["undistorted_pixel"] == pytest.approx(
        in_window(top["photograph"]["camera"], found["position"]), abs=1e-3
    )
    distance = math.hypot(5, 3, 250)
    assert top["distance_m"] == pytest.approx(distance / 1000, rel=1e-5)
    assert top["angle"] == pytest.approx(math.degrees(math.acos(250 / distance)), abs=0.01)
    assert top["mm_per_pixel"] == pytest.approx(2.5, rel=0.01)
    assert seeing(server, [5, 3, 50], limit=1)["photographs"] == found["photographs"][:1]
    assert [s["photograph"]["name"] for s in seeing(server, [50, 0, 0])["photographs"]] == [
        "site/right.png"
    ]
    assert seeing(server, [-50, 0, 0])["total"] == 0
    assert seeing(server, [5, 3, 50], with_picture=True)["total"] == 0
    camera = top["photograph"]["camera"]
    x, y = top["undistorted_pixel"]
    same = server.ok("POST", ALL + "/seeing", {"at": {"camera": camera, "x": x, "y": y}}).json()
    assert same["position"] == pytest.approx(found["position"], abs=1e-2)
    nowhere = {"at": {"camera": camera, "x": -5, "y": 0}}
    assert server.ok("POST", ALL + "/seeing", nowhere).json() == {
        "photographs": [],
        "total": 0,
        "unknown_size": 0,
    }


def test_images_are_added_by_name(server, ids, story):
    name = "Photos/SITE/Top.PNG"
    one = server.ok("POST", query(ALL, filename=name), picture()).json()
    assert one["id"] == ids["site/top.png"] and one["has_picture"]
    assert one["media_type"] == "image/png" and one["bytes"] == len(picture())
    refused(server.post(query(ALL, filename="other.png"), picture()), 422, "filename")
    refused(server.post(ALL, picture()), 422, "filename")
    there = f"{ALL}/{ids['site/near_top.png']}/picture"
    assert server.ok("PUT", there, picture(WIDTH * 2, HEIGHT * 2)).json()["width"] == 2 * WIDTH
    assert server.get(ALL).json()["with_picture"] == 2


@pytest.mark.parametrize(
    "content,status",
    [
        (b"GIF89a" + bytes(60), 415),
        (picture()[:60], 422),
        (picture(HEIGHT, WIDTH), 422),
        (b"", 400),
    ],
)
def test_unsuitable_images_are_refused(server, ids, content, status):
    refused(server.request("PUT", f"{ALL}/{ids['site/bottom.png']}/picture", content), status)
    assert not server.get(f"{ALL}/{ids['site/bottom.png']}").json()["has_picture"]


def test_the_original_comes_back_unchanged(server, ids):
    there = f"{ALL}/{ids['site/top.png']}/picture"
    original = server.get(there)
    assert original.body == picture() and original.headers["Content-Type"] == "image/png"
    small = server.get(there + "?thumbnail=256")
    assert small.headers["Content-Type"] == "image/jpeg" and small.body[:2] == b"\xff\xd8"
    again = server.request("GET", there, headers={"If-None-Match": original.headers["ETag"]})
    assert again.status == 304
    refused(server.get(f"{ALL}/{ids['site/bottom.png']}/picture"), 404)


def test_the_undistorted_image_fits_the_camera(server, ids):
    there = f"{ALL}/{ids['site/top.png']}/undistorted"
    camera = server.get(f"{ALL}/{ids['site/top.png']}").json()["camera"]
    whole = server.get(there)
    assert whole.headers["Content-Type"] == "image/jpeg"
    assert jpeg_size(whole.body) == (camera["width"], camera["height"])
    assert jpeg_size(server.get(there + "?width=40").body)[0] == 40
    assert jpeg_size(server.get(there + "?width=4096").body)[0] == camera["width"]
    again = server.request("GET", there, headers={"If-None-Match": whole.headers["ETag"]})
    assert again.status == 304
    refused(server.get(there + "?width=9"), 422, "width")
    refused(server.get(f"{ALL}/{ids['site/bottom.png']}/undistorted"), 404)


def jpeg_size(body):
    """Returns width and height from the frame header of a JPEG."""
    at = 2
    while body[at + 1] not in (0xC0, 0xC1, 0xC2):
        at += 2 + int.from_bytes(body[at + 2 : at + 4], "big")
    height, width = (int.from_bytes(body[at + k : at + k + 2], "big") for k in (5, 7))
    return width, height


def test_poses_are_replaced_by_name(server, ids):
    moved = {"site/top.png": (LOOKS["site/top.png"][0], (0, 0, 400.0))}
    # In meters, of a model in millimeters.
    made = server.ok("POST", POSES + "?unit=m", export(moved, scale=0.001)).json()
    assert (made["added"], made["updated"], made["total"]) == (0, 1, 4), made
    top = server.get(f"{ALL}/{ids['site/top.png']}").json()
    assert top["center"] == pytest.approx([0, 0, 400], abs=1e-6) and top["has_picture"]
    made = server.ok("POST", POSES, export(moved, width=WIDTH // 2)).json()
    assert (made["updated"], made["refused_total"]) == (0, 1), made
    assert made["refused"][0]["name"] == "site/top.png"


def test_unsuitable_exports_are_refused(server, ids):
    refused(server.post(POSES, b"no poses"), 422, "body")
    refused(server.post(POSES + "?unit=ft", export()), 422, "unit")
    refused(server.post(POSES, export()[:-40]), 422, "body")
    assert server.get(ALL).json()["total"] == 4


def test_roles(server, ids):
    viewer = server.add_person("Vera", "viewer")
    annotator = server.add_person("Ada", "annotator")
    one = f"{ALL}/{ids['site/top.png']}"
    for path in (ALL, one, one + "/picture?thumbnail=64", one + "/undistorted?width=20"):
        server.ok("GET", path, token=viewer)
    server.ok("POST", ALL + "/seeing", {"at": {"point": [0, 0, 50]}}, token=viewer)
    assert server.get(one + "/picture", token=viewer).status == 403
    server.ok("GET", one + "/picture", token=annotator)
    for method, path, body in (
        ("POST", POSES, export()),
        ("POST", query(ALL, filename="top.png"), picture()),
        ("PUT", one + "/picture", picture()),
        ("DELETE", one, None),
        ("DELETE", ALL, None),
    ):
        assert server.request(method, path, body, token=annotator).status == 403, path


def test_a_repeated_request_gets_the_first_answer(server, ids):
    key = {"Idempotency-Key": "top again"}
    path = query(ALL, filename="top.png")
    first = server.request("POST", path, picture(red=9), headers=key)
    assert first.status == 200, first
    assert server.request("POST", path, picture(red=9), headers=key).body == first.body


def test_photographs_are_deleted(server, ids):
    one = f"{ALL}/{ids['site/top.png']}"
    assert server.request("DELETE", one).status == 204
    refused(server.get(one), 404)
    refused(server.request("DELETE", one), 404)
    assert server.request("DELETE", ALL).status == 204
    assert server.get(ALL).json() == {"photographs": [], "total": 0, "with_picture": 0}
    entries = server.get("/audit?limit=10").json()["entries"]
    deleted = [e for e in entries if e.get("subject_kind") == "photograph"]
    assert [e["details"]["photographs"] for e in deleted] == [3, 1], entries
