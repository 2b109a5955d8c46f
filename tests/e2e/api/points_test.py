"""Import of point clouds: the surface, its facts, another surface from the stored file, and what is
refused."""
import math
import pathlib

import pytest
from support.meshes import folded_grid
from support.missing import missing
from support.point_clouds import las_points, ply_points, sphere_points

NEFERTITI = (
    pathlib.Path(__file__).resolve().parents[4] / "shared" / "data" / "statue_nefertiti_70k.ply"
)
AREA = 4 * math.pi


def started(server, content, filename, **query):
    """Returns the job of an import when it has ended."""
    asked = "&".join(f"{name}={value}" for name, value in query.items())
    answer = server.ok("POST", f"/models?filename={filename}&{asked}", content)
    return server.wait_for_job(answer.json()["id"])


@pytest.fixture(scope="module")
def model(server):
    points = sphere_points(6000)
    colors = [(250, 20, 20) if z > 0 else (20, 20, 250) for _, _, z in points]
    return server.import_model(ply_points(points, colors), "ball.ply", unit="m")


def test_points_become_a_surface_near_them(model):
    facts = model["from_points"]
    assert facts["points"] == facts["used"] == 6000
    spacing = math.sqrt(AREA / 6000)
    assert abs(facts["point_spacing_m"] - spacing) < 0.2 * spacing
    assert facts["distance_95_m"] < 0.3 * spacing
    assert abs(model["area_m2"] - AREA) < 0.02 * AREA
    assert model["open_edges"]["loops"] == 0
    assert model["source_files"][0]["name"] == "ball.ply"


def test_layers_can_be_painted_on_it(server, model):
    path = f"/models/{model['id']}/layers"
    server.ok("POST", path, {"name": "dust", "type": "u8"})
    filled = {"op": "fill", "mode": "where", "where": "z > 0", "value": 3}
    server.ok("POST", path + "/dust/edits", filled)
    quantities = server.ok("GET", path + "/dust/statistics").json()
    assert quantities


def test_las_with_its_coordinate_system(server):
    place = (691_000.0, 5_335_000.0, 515.0)
    content = las_points(sphere_points(4000, 2.0, place), epsg=25832)
    model = server.import_model(content, "ball.las")
    assert model["crs"] == "EPSG:25832" and model["unit"] == "m" and not model["unit_assumed"]
    assert abs(model["area_m2"] - 4 * AREA) < 0.03 * 4 * AREA
    for k in range(3):
        assert abs(model["bounds"]["min"][k] - (place[k] - 2)) < 0.05
        assert abs(model["bounds"]["max"][k] - (place[k] + 2)) < 0.05


def test_the_surface_can_be_made_again_from_the_stored_file(server, model):
    job = server.ok("POST", f"/models?files_of={model['id']}&cell=0.03&name=fine&unit=m", b"")
    job = server.wait_for_job(job.json()["id"])
    assert job["state"] == "done", job
    fine = server.ok("GET", f"/models/{job['model']}").json()
    assert fine["name"] == "fine" and fine["id"] != model["id"]
    assert fine["from_points"]["cell_m"] <= 0.03 < model["from_points"]["cell_m"]
    assert fine["triangles"] > 3 * model["triangles"]
    assert fine["source_files"] == model["source_files"]


def test_a_wide_gap_stays_open_unless_it_should_be_closed(server):
    content = ply_points(sphere_points(6000, above=-0.98))
    open_model = server.import_model(content, "bowl.ply", gap=0.1)
    assert open_model["open_edges"]["loops"] == 1
    job = server.ok("POST", f"/models?files_of={open_model['slug']}&gap=0.8", b"").json()["id"]
    closed = server.ok("GET", f"/models/{server.wait_for_job(job)['model']}").json()
    assert closed["open_edges"]["loops"] == 0


@pytest.mark.parametrize(
    "content,filename,says",
    [
        (ply_points(sphere_points(40)), "few.ply", "40 vertices but no triangle"),
        (ply_points([(1, 2, 3)] * 500), "place.ply", "no surface could be made"),
        (las_points(sphere_points(500), compressed=True), "a.las", "compressed (LAZ)"),
        (las_points(sphere_points(500))[:-100], "cut.las", "cut off"),
        (b"ASTM-E57" + b"x" * 400, "scan.ply", "E57 point cloud"),
    ],
)
def test_what_is_no_surface_is_refused_with_advice(server, content, filename, says):
    job = started(server, content, filename)
    assert job["state"] == "failed" and job["problem"]["status"] == 422
    assert says in job["problem"]["detail"]


@pytest.mark.parametrize("ending", ["e57", "laz", "pts", "xyz"])
def test_other_formats_of_scanners_are_refused_before_the_upload(server, ending):
    answer = server.request("POST", f"/models?filename=scan.{ending}", b"x" * 100)
    assert answer.status == 415 and "CloudCompare" in answer.json()["detail"]


def test_wrong_lengths_are_refused(server):
    for query in ("cell=-1", "cell=wide", "gap=-0.5", "gap=nan", "cell=1e300"):
        answer = server.request("POST", "/models?filename=a.ply&" + query, b"x")
        assert answer.status in (400, 422), query
        assert answer.json().get("field", "").split("/")[-1] in ("cell", "gap"), answer.json()


def test_files_of_is_a_model_of_the_same_project(server, model):
    server.ok("POST", "/projects", {"name": "Other"})
    for query in ("files_of=nothing", f"files_of={model['id']}&project=other"):
        answer = server.request("POST", "/models?" + query, b"")
        assert answer.status == 422 and answer.json()["field"] == "files_of"
    both = server.request("POST", f"/models?files_of={model['id']}", folded_grid(4))
    assert both.status == 422 and both.json()["field"] == "files_of"


def test_a_mesh_can_also_be_imported_again(server):
    model = server.import_model(folded_grid(6), "sheet.ply")
    assert "from_points" not in model
    job = server.ok("POST", f"/models?files_of={model['id']}&resolution=4096", b"").json()["id"]
    again = server.ok("GET", f"/models/{server.wait_for_job(job)['model']}").json()
    assert again["default_resolution"] == 4096 and again["triangles"] == model["triangles"]


def test_a_canceled_import_leaves_nothing(server):
    content = ply_points(sphere_points(60_000))
    before = server.ok("GET", "/models").json()["models"]
    job = server.ok("POST", "/models?filename=large.ply", content).json()["id"]
    server.request("DELETE", f"/jobs/{job}")
    assert server.wait_for_job(job)["state"] == "cancelled"
    assert server.ok("GET", "/models").json()["models"] == before


def test_a_real_scan(server):
    if not NEFERTITI.exists():
        missing(f"no scan at {NEFERTITI}")
    mesh = server.import_model(NEFERTITI.read_bytes(), "nefertiti.ply", unit="mm")
    data = NEFERTITI.read_bytes()
    head = data.index(b"end_header\n") + 11
    points = data[head : head + 12 * 35002]
    cloud = (
        b"ply\nformat binary_little_endian 1.0\nelement vertex 35002\nproperty float x\n"
        b"property float y\nproperty float z\nend_header\n" + points
    )
    model = server.import_model(cloud, "points.ply", unit="mm")
    assert model["triangles"] < 200_000
    assert abs(model["area_m2"] - mesh["area_m2"]) < 0.03 * mesh["area_m2"]
    assert model["from_points"]["distance_median_m"] < 0.0003
