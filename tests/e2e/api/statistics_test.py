"""A layer that is filled everywhere has the model's area, on generated and on real scans."""
import os

import pytest
from support.strata_server import StrataServer

DATA = os.environ.get("STRATA_TEST_DATA", "")


def check(server, model):
    path = f"/models/{model['id']}"
    server.ok("POST", path + "/layers", {"name": "Everywhere", "type": "u16"})
    edit = server.ok(
        "POST",
        path + "/layers/everywhere/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": 65535},
    ).json()
    statistics = server.ok("GET", path + "/layers/everywhere/statistics").json()
    share = statistics["area_m2"] / model["area_m2"]
    print(
        f"{model['name']}: {model['triangles']} triangles, {statistics['area_m2'] * 1e4:.2f} cm², {share:.6f} of the model's area",
        flush=True,
    )
    assert abs(share - 1) <= 0.001, (statistics["area_m2"], model["area_m2"])
    assert (
        edit["area_m2"] == statistics["area_m2"]
        or abs(edit["area_m2"] / statistics["area_m2"] - 1) < 1e-9
    ), (edit, statistics["area_m2"])
    assert edit["texels_changed"] == statistics["texels"], (edit, statistics["texels"])
    assert (statistics["min"], statistics["max"], statistics["std"]) == (
        65535,
        65535,
        0,
    ), statistics
    assert abs(statistics["root_mean_square"] - 65535) < 1e-6, statistics


def read(name):
    with open(os.path.join(DATA, name), "rb") as file:
        return file.read()


needs_scans = pytest.mark.skipif(
    not os.path.isdir(DATA), reason=f"there is no folder {DATA or '(STRATA_TEST_DATA is not set)'}"
)


@pytest.fixture(scope="module")
def server():
    with StrataServer(demo=True) as server:
        yield server


def test_of_the_demo(server):
    check(server, server.get("/models/demo-pot").json())


@needs_scans
def test_of_a_scan(server):
    check(
        server,
        server.import_model(
            read("statue_nefertiti_70k.ply"), "statue_nefertiti_70k.ply", unit="mm"
        ),
    )


@needs_scans
def test_of_a_scan_with_texture_coordinates_of_its_own(server):
    mask = server.import_model(read("mask_bali/mask.obj"), "mask.obj", unit="m")
    assert mask["atlas"]["source"] == "file", mask["atlas"]
    assert 0 <= mask["atlas"]["overlap"] < 0.005, mask["atlas"]
    check(server, mask)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
