"""Models of several scans: the tree of their parts, hidden parts in pictures, picks and strokes,
the stored files, and what is refused."""
import io
import json
import os
import pathlib
import subprocess
import uuid
import zipfile

import pytest
from support.cameras import camera_from
from support.live_client import LAST_RECTANGLE, LiveClient
from support.meshes import folded_grid, ply
from support.missing import missing
from support.pictures import png

DATA = pathlib.Path(__file__).resolve().parents[4] / "shared" / "data"
SCANS = (
    "statue_nefertiti_70k.ply",
    "gargoyle_3dhop_50k_colour_normals.ply",
    "vessel_lekythos_gigamesh_15k_vcolour.obj",
)
M = "/models/church"
SIDE = 10.0


def square(height, side=SIDE, cells=8):
    """Returns a horizontal square around the origin."""
    step = side / cells
    vertices = [
        (x * step - side / 2, y * step - side / 2, height)
        for y in range(cells + 1)
        for x in range(cells + 1)
    ]
    faces = []
    for y in range(cells):
        for x in range(cells):
            a = y * (cells + 1) + x
            faces += [(a, a + 1, a + cells + 2), (a, a + cells + 2, a + cells + 1)]
    return ply(vertices, faces)


FILES = {
    "Church/Roof.ply": square(9),
    "Church/Nave/Vault.ply": square(5),
    "Church/Nave/Floor.ply": square(0),
}


def zipped(files):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def form(files):
    """Returns the body and the headers of a form with these files."""
    boundary = uuid.uuid4().hex
    body = b"".join(
        f'--{boundary}\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n\r\n'.encode()
        + content
        + b"\r\n"
        for name, content in files.items()
    )
    return body + f"--{boundary}--\r\n".encode(), {
        "Content-Type": f"multipart/form-data; boundary={boundary}"
    }


def imported(server, query, body, headers=None):
    """Returns the job of an import when it has ended."""
    answer = server.ok("POST", "/models?" + query, body, headers=headers or {})
    return server.wait_for_job(answer.json()["id"])


@pytest.fixture(scope="module")
def model(server):
    body, headers = form(FILES)
    job = imported(server, "parts=true&unit=m&up=z", body, headers)
    assert job["state"] == "done", job
    server.ok("POST", M + "/layers", {"name": "Damp", "type": "u8", "resolution": 2048})
    return server.get(f"/models/{job['model']}").json()


@pytest.fixture(scope="module")
def from_above(model):
    return camera_from(model, (0, 0, 1), up=(0, 1, 0))


def stroke(camera, **more):
    middle = [camera["width"] / 2, camera["height"] / 2]
    return {
        "op": "stroke",
        "camera": camera,
        "path": [middle],
        "radius_px": 20,
        "value": 1,
        **more,
    }


def painted_heights(server):
    """Returns the heights at which the middle is painted, then clears the layer."""
    asked = {"points": [[0, 0, height] for height in (0, 5, 9)], "layers": ["damp"]}
    places = server.ok("POST", M + "/positions", asked).json()["positions"]
    server.ok("POST", M + "/layers/damp/undo")
    return [round(each["position"][2]) for each in places if each["values"]["damp"]["valid"]]


def test_parts_have_names_folders_and_areas(model):
    assert model["name"] == "Church" and model["slug"] == "church"
    parts = model["parts"]
    assert [(part["folder"], part["name"]) for part in parts] == [
        ("", "Roof"),
        ("Nave", "Floor"),
        ("Nave", "Vault"),
    ]
    for part, height in zip(parts, (9, 0, 5)):
        assert part["triangles"] == 128
        assert abs(part["area_m2"] - SIDE * SIDE) < 1e-6
        assert part["bounds"]["min"][2] == part["bounds"]["max"][2] == height
    assert abs(model["area_m2"] - 3 * SIDE * SIDE) < 1e-6


def test_an_archive_becomes_the_same_parts(server, model):
    other = server.import_model(zipped(FILES), "archive.zip", parts="true", unit="m", up="z")
    assert other["parts"] == model["parts"]
    assert other["name"] == "archive"


def test_stored_files_keep_their_folders(server, model):
    assert [file["name"] for file in model["source_files"]] == list(FILES)
    path = f"/models/{model['id']}/source/Church%2FNave%2FFloor.ply"
    assert server.get(path).body == FILES["Church/Nave/Floor.ply"]
    job = imported(server, f"files_of={model['id']}&unit=m&name=Again", b"")
    again = server.get(f"/models/{job['model']}").json()
    assert again["parts"] == model["parts"]


def test_a_pick_passes_hidden_parts(server, from_above):
    def height(hidden):
        camera = {**from_above, "hidden_parts": hidden}
        found = server.ok("POST", M + "/pick", {"camera": camera, "x": 320, "y": 240}).json()
        return found["position"][2] if found["hit"] else None

    assert abs(height([]) - 9) < 1e-3
    assert abs(height([0]) - 5) < 1e-3
    assert abs(height([2, 0]) - 0) < 1e-3
    assert height([0, 1, 2, 77]) is None


def test_a_stroke_paints_visible_parts_only(server, from_above):
    edits = M + "/layers/damp/edits"
    server.ok("POST", edits, stroke(from_above))
    assert painted_heights(server) == [9]
    server.ok("POST", edits, stroke({**from_above, "hidden_parts": [0]}))
    assert painted_heights(server) == [5]
    server.ok("POST", edits, stroke({**from_above, "hidden_parts": [0]}, through=True))
    assert painted_heights(server) == [0, 5]


def test_a_view_and_a_figure_keep_hidden_parts(server, from_above):
    camera = {**from_above, "hidden_parts": [0, 2]}
    light = {"mode": "unlit", "direction": [0, 0, 1]}
    view = {"name": "Floor", "camera": camera, "light": light, "layers": []}
    server.ok("POST", M + "/views", view)
    assert server.get(M + "/views/floor").json()["camera"]["hidden_parts"] == [0, 2]
    edits = M + "/layers/damp/edits"
    server.ok("POST", edits, stroke(camera))
    figures = [
        server.ok(
            "POST", M + "/figures", {"format": "png", "dpi": 60, "legend": False, **more}
        ).body
        for more in ({"view": "floor"}, {"camera": camera, "light": light}, {"camera": from_above})
    ]
    assert figures[0] == figures[1] != figures[2]
    hidden = {**camera, "hidden_parts": [0, 1, 2]}
    refused = server.post(M + "/figures", {"format": "png", "camera": hidden})
    assert refused.status == 422 and refused.json()["field"] == "camera.hidden_parts"
    server.ok("POST", M + "/layers/damp/undo")


def test_a_layer_of_the_parts_divides_quantities(server):
    asked = {"name": "Part", "compute": {"kind": "part"}, "resolution": 2048}
    job = server.wait_for_job(server.ok("POST", M + "/layers", asked).json()["id"])
    assert job["state"] == "done", job
    layer = server.get(M + "/layers/part").json()
    assert layer["type"] == "u8"
    assert [point["label"] for point in layer["palette"]["points"]] == [
        "Roof",
        "Nave/Floor",
        "Nave/Vault",
    ]
    selected = {"where": "part = 2"}
    filled = {"op": "fill", "mode": "where", **selected, "value": 1}
    server.ok("POST", M + "/layers/damp/edits", filled)
    area = server.get(M + "/layers/damp/statistics").json()["area_m2"]
    assert abs(area - SIDE * SIDE) < 0.01 * SIDE * SIDE
    assert painted_heights(server) == [5]
    alone = server.import_model(folded_grid(), "single.ply")
    refused = server.post(f"/models/{alone['id']}/layers", asked)
    assert refused.status == 422 and refused.json()["field"] == "compute.kind"


def test_pictures_on_the_live_connection(server, from_above):
    with LiveClient(server, "church") as live:
        live.hello()

        def picture(seq, hidden):
            live.send({"op": "camera", "seq": seq, **from_above, "hidden_parts": hidden})
            while True:
                frame = live.receive_until("frame")
                if frame["flags"] & LAST_RECTANGLE and frame["camera_seq"] >= seq:
                    return

        picture(1, [])
        picture(2, [0, 1, 2])
        live.send({"op": "pick", "id": str(uuid.uuid4()), "camera": from_above, "x": 320, "y": 240})
        assert live.receive_until("picked")["hit"]


@pytest.mark.parametrize("hidden", [[256], [-1], [0.5], ["Roof"], "0", [0] * 257])
def test_invalid_parts_are_refused(server, from_above, hidden):
    camera = {**from_above, "hidden_parts": hidden}
    answer = server.post(M + "/pick", {"camera": camera, "x": 320, "y": 240})
    assert answer.status == 422 and answer.json()["field"].startswith("camera.hidden_parts")


def test_several_scans_need_the_parameter(server):
    job = imported(server, "filename=a.zip", zipped(FILES))
    assert job["state"] == "failed" and job["problem"]["field"] == "parts", job
    assert "`parts=true`" in job["problem"]["detail"]
    body, headers = form(FILES)
    answer = server.post("/models", body, headers=headers)
    assert answer.status == 422 and answer.json()["field"] == "parts"
    answer = server.post("/models?parts=perhaps&filename=a.ply", FILES["Church/Roof.ply"])
    assert answer.status == 422 and answer.json()["field"] == "parts"


def test_a_damaged_scan_is_named(server):
    files = {"a/one.ply": square(0), "a/two.ply": square(1)[:200]}
    job = imported(server, "filename=a.zip&parts=true", zipped(files))
    assert job["state"] == "failed" and "a/two.ply: " in job["problem"]["detail"], job


def test_one_scan_has_no_parts(server):
    model = server.import_model(folded_grid(), "alone.ply", parts="true")
    assert "parts" not in model


def test_the_command_imports_a_folder(server, model, tmp_path):
    for name, content in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    (tmp_path / "Church" / "notes.txt").write_text("not a scan")
    for named in (["Church"], [str(tmp_path / name) for name in FILES]):
        done = subprocess.run(
            [os.environ["STRATA_BINARY"], "import", "--parts", *named, "--unit", "m", "--up", "z"]
            + ["--server", server.url, "--token", server.token],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        made = json.loads(done.stdout)
        assert made["parts"] == model["parts"] and made["name"] == "Church"
        # The folders of this machine are private.
        assert sorted(file["name"] for file in made["source_files"]) == sorted(FILES)


def test_the_command_sends_the_scans_before_their_pictures(server, tmp_path):
    wall = "mtllib Wall.mtl\nv 0 0 0\nv 9 0 0\nv 9 9 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/3\n"
    for folder in ("A", "B"):
        (tmp_path / "Site" / folder).mkdir(parents=True)
        (tmp_path / "Site" / folder / "Wall.obj").write_text(wall)
        (tmp_path / "Site" / folder / "Wall.mtl").write_text("newmtl a\nmap_Kd Photo.png\n")
        (tmp_path / "Site" / folder / "Photo.png").write_bytes(png(8, 8, lambda x, y: (200, 9, 9)))
    words = ["import", "--parts", "Site", "--server", server.url, "--token", server.token]
    done = subprocess.run(
        [os.environ["STRATA_BINARY"], *words],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    assert [part["folder"] for part in made["parts"]] == ["A", "B"]
    assert not any("texture" in repair["what"] for repair in made["repairs"]), made["repairs"]


def test_hidden_parts_of_a_model_without_parts_are_ignored(server):
    alone = server.import_model(square(0), "plain.ply", unit="m", up="z", name="Plain")
    path = f"/models/{alone['id']}/layers"
    server.ok("POST", path, {"name": "Dust", "type": "u8", "resolution": 2048})
    camera = {**camera_from(alone, (0, 0, 1), up=(0, 1, 0)), "hidden_parts": [0]}
    server.ok("POST", path + "/dust/edits", stroke(camera))
    assert server.get(path + "/dust/statistics").json()["texels"] > 0


def test_real_scans_are_the_same_alone_and_as_parts(server):
    files = {}
    for name in SCANS:
        if not (DATA / name).exists():
            missing(f"no scan at {DATA / name}")
        files[f"scans/{name}"] = (DATA / name).read_bytes()
    together = server.import_model(zipped(files), "scans.zip", parts="true", unit="mm", up="z")
    parts = {part["name"]: part for part in together["parts"]}
    for name in SCANS:
        alone = server.import_model((DATA / name).read_bytes(), name, unit="mm", up="z")
        part = parts[name.rsplit(".", 1)[0]]
        assert part["triangles"] == alone["triangles"]
        assert abs(part["area_m2"] / alone["area_m2"] - 1) < 1e-9
        assert part["bounds"] == alone["bounds"]
    assert together["triangles"] == sum(part["triangles"] for part in parts.values())
