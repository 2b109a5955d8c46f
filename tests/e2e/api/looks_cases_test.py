"""Surface images (looks), light, sections and scans of several files, over HTTP and from the
command line."""
import math
import os
import subprocess
import tempfile

import pytest
from support.cameras import camera_from
from support.maps import tiff
from support.meshes import bumpy_ball
from support.pictures import bmp, pixels, png, tga
from support.strata_server import LONG_S

M = "/models/ball"


def frame(server, **request):
    answer = server.ok("POST", M + "/frame", {"format": "png", **request})
    return pixels(answer.body)


RED = {"Content-Type": "image/png"}


@pytest.fixture(scope="module", autouse=True)
def camera(server):
    model = server.import_model(bumpy_ball(), "ball.ply", unit="mm", name="Ball")
    return camera_from(model, (0, -1, 0))


@pytest.fixture
def folder():
    with tempfile.TemporaryDirectory() as folder:
        yield folder


def test_looks(server, camera):
    picture = png(64, 32, lambda x, y: (255, 0, 0))
    assert server.get(M + "/looks").json() == {"looks": [], "total": 0}
    made = server.ok(
        "POST",
        M + "/looks?name=UV+light&description=365+nm",
        picture,
        headers={**RED, "Idempotency-Key": "uv"},
    )
    look = made.json()
    assert made.status == 201 and made.headers["Location"] == f"/api/v1{M}/looks/uv-light", made
    assert (look["width"], look["height"], look["media_type"], look["visible"]) == (
        64,
        32,
        "image/png",
        False,
    ), look
    again = server.ok(
        "POST",
        M + "/looks?name=UV+light&description=365+nm",
        picture,
        headers={**RED, "Idempotency-Key": "uv"},
    )
    assert again.json()["id"] == look["id"] and server.get(M + "/looks").json()["total"] == 1

    assert server.ok("GET", M + "/looks/uv-light/picture").body == picture
    small = server.ok("GET", M + "/looks/uv-light/picture?thumbnail=16")
    assert small.headers["Content-Type"] == "image/jpeg" and small.body[:2] == b"\xff\xd8"

    center = lambda rows: rows[len(rows) // 2][len(rows[0]) // 2]
    plain = center(frame(server, camera=camera, light={"mode": "unlit"}))
    assert max(plain) - min(plain) < 30, "hidden until it is chosen"
    assert center(
        frame(server, camera=camera, light={"mode": "unlit"}, looks=[{"look": "uv-light"}])
    ) == (255, 0, 0)
    half = center(
        frame(
            server,
            camera=camera,
            light={"mode": "unlit"},
            looks=[{"look": look["id"], "opacity": 0.5}],
        )
    )
    assert abs(half[1] - plain[1] / 2) < 3, (half, plain)

    changed = server.ok(
        "PATCH",
        M + "/looks/uv-light",
        {"visible": True, "name": "Ultraviolet"},
        headers={"If-Match": made.headers["ETag"]},
    )
    assert changed.json()["name"] == "Ultraviolet" and changed.json()["slug"] == "uv-light"
    assert (
        server.request(
            "PATCH", M + "/looks/uv-light", {"order": 3}, headers={"If-Match": made.headers["ETag"]}
        ).status
        == 412
    )
    assert center(frame(server, camera=camera, light={"mode": "unlit"})) == (
        255,
        0,
        0,
    ), "now everyone sees it"
    assert center(frame(server, camera=camera, light={"mode": "unlit"}, looks=[])) == plain

    for what, method, path, body, headers, status in [
        ("no picture", "POST", M + "/looks?name=x", b"hello", RED, 415),
        ("a picture that ends early", "POST", M + "/looks?name=x", picture[:60], RED, 422),
        ("nothing", "POST", M + "/looks?name=x", b"", RED, 400),
        ("no name", "POST", M + "/looks", picture, RED, 422),
        ("neither true nor false", "POST", M + "/looks?name=x&visible=maybe", picture, RED, 422),
        ("unknown model", "POST", "/models/none/looks?name=x", picture, RED, 404),
        ("unknown look", "GET", M + "/looks/none", None, {}, 404),
        ("unknown look's picture", "GET", M + "/looks/none/picture", None, {}, 404),
        (
            "a thumbnail too large",
            "GET",
            M + "/looks/uv-light/picture?thumbnail=100000",
            None,
            {},
            422,
        ),
        ("an empty change", "PATCH", M + "/looks/uv-light", {}, {}, 422),
        ("too opaque", "PATCH", M + "/looks/uv-light", {"opacity": 2}, {}, 422),
        (
            "an unknown look in a frame",
            "POST",
            M + "/frame",
            {"camera": camera, "looks": [{"look": "none"}]},
            {},
            404,
        ),
        (
            "a look twice in a frame",
            "POST",
            M + "/frame",
            {"camera": camera, "looks": [{"look": "uv-light"}] * 2},
            {},
            422,
        ),
        (
            "five looks in a frame",
            "POST",
            M + "/frame",
            {"camera": camera, "looks": [{"look": 1}] * 5},
            {},
            422,
        ),
        (
            "unknown light",
            "POST",
            M + "/frame",
            {"camera": camera, "light": {"mode": "disco"}},
            {},
            422,
        ),
        (
            "light from nowhere",
            "POST",
            M + "/frame",
            {"camera": camera, "light": {"mode": "raking", "direction": [0, 0, 0]}},
            {},
            422,
        ),
        (
            "too much exposure",
            "POST",
            M + "/frame",
            {"camera": camera, "light": {"mode": "museum", "exposure": 3.5}},
            {},
            422,
        ),
        (
            "a cut without a direction",
            "POST",
            M + "/section",
            {"section": [[0, 0, 1, 0], [0, 0, 0, 1]]},
            {},
            422,
        ),
        ("no cut", "POST", M + "/section", {"section": []}, {}, 422),
        (
            "seven planes",
            "POST",
            M + "/frame",
            {"camera": {**camera, "section": [[0, 0, 1, 0]] * 7}},
            {},
            422,
        ),
        (
            "a plane without a direction",
            "POST",
            M + "/frame",
            {"camera": {**camera, "section": [[0, 0, 0, 1]]}},
            {},
            422,
        ),
    ]:
        answer = server.request(method, path, body, headers=headers)
        assert answer.status == status, f"{what}: {answer}"

    # other formats are stored as a PNG of their pixels, and a frame shows them
    blue = lambda x, y: (0, 0, 255)
    for name, kind, other in (
        ("tga", "image/x-tga", tga(8, 4, blue)),
        ("bmp", "image/bmp", bmp(8, 4, blue)),
        ("tiff", "image/tiff", tiff(8, 4, blue, kind="B", samples=3)),
    ):
        made = server.ok(
            "POST", M + f"/looks?name={name}", other, headers={"Content-Type": kind}
        ).json()
        assert (made["width"], made["height"], made["media_type"]) == (8, 4, "image/png"), made
        assert set(sum(pixels(server.ok("GET", M + f"/looks/{name}/picture").body), [])) == {
            (0, 0, 255)
        }
        assert center(
            frame(server, camera=camera, light={"mode": "unlit"}, looks=[{"look": name}])
        ) == (0, 0, 255)
        assert (
            server.request(
                "POST", M + "/looks?name=x", other[:-20], headers={"Content-Type": kind}
            ).status
            == 422
        )
        server.ok("DELETE", M + f"/looks/{name}")
    dds = server.request("POST", M + "/looks?name=x", b"DDS " + bytes(200), headers=RED)
    assert dds.status == 415 and "DDS" in dds.json()["detail"], dds

    assert server.request("DELETE", M + "/looks/uv-light").status == 204
    assert server.get(M + "/looks/uv-light").status == 404
    assert center(frame(server, camera=camera, light={"mode": "unlit"})) == plain


def test_raking(server, camera):
    left, right = (
        frame(server, camera=camera, light={"mode": "raking", "direction": [x, 0, 0.3]})
        for x in (-1, 1)
    )
    row = len(left) // 2
    at = lambda rows, share: sum(rows[row][int(len(rows[0]) * share)])
    assert at(left, 0.42) > at(left, 0.58) + 60 and at(right, 0.58) > at(right, 0.42) + 60


def test_exposure_and_fill(server, camera):
    center = lambda rows: rows[len(rows) // 2][len(rows[0]) // 2]
    brightness = lambda **light: sum(center(frame(server, camera=camera, light=light)))
    plain = brightness(mode="museum")
    assert brightness(mode="museum", exposure=-2) < plain * 0.6
    assert plain < brightness(mode="museum", exposure=2) <= 3 * 255
    side = {"mode": "raking", "direction": [1, 0, 0.3]}
    dark, filled = (frame(server, camera=camera, light={**side, "fill": fill}) for fill in (0, 0.5))
    row = len(dark) // 2
    at = lambda rows: sum(rows[row][int(len(rows[0]) * 0.4)])
    assert at(filled) > at(dark) + 60
    light = {"mode": "raking", "direction": [-1, 0, 0.5], "exposure": 0.5, "fill": 0.25}
    made = server.ok(
        "POST",
        M + "/views",
        {
            "name": "Raking",
            "camera": camera,
            "layers": [],
            "light": {**light, "layer_opacity": 0.5},
        },
    )
    assert made.json()["light"] == {**light, "layer_opacity": 0.5}


def test_area_of_a_section(server):
    area = lambda *planes: [
        cut.get("area_m2")
        for cut in server.ok("POST", M + "/section", {"section": planes}).json()["cuts"]
    ]
    circle = math.pi * 0.05**2  # a ball with waves of 4 % of its radius
    (whole,) = area([0, 0, 1, 0])
    assert abs(whole - circle) < 0.02 * circle, whole
    half, other = area([0, 0, 2, 0], [1, 0, 0, 0])
    assert abs(half - circle / 2) < 0.03 * circle and abs(other - circle / 2) < 0.03 * circle
    assert area([0, 0, 1, -1000]) == [0]


def test_section(server, camera):
    """The record of a stroke contains its section. The removed part gets no paint, and a repeat
    gets the same response."""
    server.ok("POST", M + "/layers", {"name": "Inside", "type": "u8", "resolution": 2048})
    # keeps the half with y above 0, which is on the far side
    cut = {**camera, "section": [[0, 1, 0, 0]]}
    stroke = {
        "op": "stroke",
        "value": 1,
        "camera": cut,
        "radius_px": 400,
        "path": [[320, 240]],
        "through": True,
    }
    painted = server.ok("POST", M + "/layers/inside/edits", stroke).json()
    whole = server.ok("GET", M).json()["area_m2"]
    assert 0.48 < painted["area_m2"] / whole < 0.52, (painted, whole)
    seen = {**stroke, "camera": cut, "through": False, "radius_px": 40, "value": 2}
    assert (
        server.ok("POST", M + "/layers/inside/edits", seen).json()["texels_changed"] == 0
    ), "a solid's inside takes no paint"
    assert not server.ok("POST", M + "/pick", {"camera": cut, "x": 320, "y": 240}).json()["hit"]
    hit = server.ok("POST", M + "/pick", {"camera": camera, "x": 320, "y": 240}).json()
    assert hit["hit"] and hit["position"][1] < 0 and not hit["values"]["inside"]["valid"]


OBJ = b"mtllib scan.mtl\nv 0 0 0\nv 90 0 0\nv 0 90 0\nv 0 0 90\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\nf 3/1 1/2 4/3\n"
MTL = b"newmtl a\nmap_Kd color.png\n"


def test_several_files(server, folder):
    texture = png(16, 16, lambda x, y: (0, 200, 0))
    files = {"scan.obj": OBJ, "scan.mtl": MTL, "color.png": texture}
    form = (
        b"".join(
            b'--B\r\nContent-Disposition: form-data; name="files"; filename="%s"\r\n\r\n%s\r\n'
            % (name.encode(), content)
            for name, content in files.items()
        )
        + b"--B--\r\n"
    )
    job = server.ok(
        "POST",
        "/models?name=Form",
        form,
        headers={"Content-Type": "multipart/form-data; boundary=B"},
    ).json()
    done = server.wait_for_job(job["id"])
    assert done["state"] == "done", done
    model = server.ok("GET", "/models/form").json()
    assert sorted(each["name"] for each in model["source_files"]) == sorted(files), model[
        "source_files"
    ]
    for name, content in files.items():
        assert server.ok("GET", f"/models/form/source/{name}").body == content
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)
    # the command finds the files next to the mesh, and accepts files by name
    for more in ([], ["scan.mtl", "color.png"]):
        words = [
            server.binary,
            "import",
            "scan.obj",
            *more,
            "--name",
            f"Command {len(more)}",
            "--server",
            server.url,
            "--token",
            server.token,
        ]
        ran = subprocess.run(
            words, capture_output=True, text=True, check=False, timeout=LONG_S, cwd=folder
        )
        assert ran.returncode == 0, ran.stderr
        names = [
            each["name"]
            for each in server.ok("GET", f"/models/command-{len(more)}").json()["source_files"]
        ]
        assert sorted(names) == sorted(files), names
    assert not os.listdir(os.path.join(server.data, "uploads"))
    two = form.replace(b"scan.mtl", b"other.obj")
    assert (
        server.post(
            "/models", two, headers={"Content-Type": "multipart/form-data; boundary=B"}
        ).status
        == 422
    )
    assert not os.listdir(os.path.join(server.data, "uploads"))


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
