"""Runs the tour with curl from docs/how-to/write-scripts.md unchanged, and compares its numbers
with one another."""
import json
import os
import re
import subprocess
import tempfile

import pytest
from support.meshes import bumpy_ball

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))


def tour_of_the_guide():
    with open(os.path.join(ROOT, "docs", "how-to", "write-scripts.md"), encoding="utf-8") as file:
        block = re.search(r"```\n(.*?)```", file.read(), re.S).group(1)
    kept = []
    for line in block.splitlines():
        # The server of this test already runs, so the lines that start it are omitted.
        if line.startswith(("export STRATA_OWNER_TOKEN=", "STRATA_NO_BROWSER=1 ./run")):
            continue
        kept.append(re.sub(r"^S=http://127.0.0.1:8080", "S=$STRATA_URL", line))
    assert any(line.startswith("S=$STRATA_URL") for line in kept), "the guide no longer sets S"
    return "set -euo pipefail\n" + "\n".join(kept) + "\n"


def json_values(text):
    """Returns the JSON values that follow one another in a text."""
    decoder, found, at = json.JSONDecoder(), [], 0
    while at < len(text):
        if text[at] in " \n":
            at += 1
            continue
        value, at = decoder.raw_decode(text, at)
        found.append(value)
    return found


@pytest.fixture(scope="module")
def folder():
    with tempfile.TemporaryDirectory() as folder:
        yield folder


def test_its_figures_agree_with_one_another(server, folder):
    with open(os.path.join(folder, "scan.ply"), "wb") as file:
        file.write(bumpy_ball())
    os.symlink(os.path.join(ROOT, "scripts"), os.path.join(folder, "scripts"))
    done = subprocess.run(
        ["bash", "-c", tour_of_the_guide()],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={**server.environment(), "STRATA_URL": server.url},
    )
    assert (
        done.returncode == 0
    ), f"the tour ended with {done.returncode}:\n{done.stdout}\n{done.stderr}"
    model, layer, edit, point, statistics = json_values(done.stdout)

    assert (model["slug"], model["unit"], model["unit_assumed"]) == ("scan", "mm", False), model
    assert (layer["slug"], layer["type"], layer["resolution"]) == ("cracks", "u8", 4096), layer
    assert edit["sequence"] == 1 and edit["texels_changed"] > 1000, edit
    assert point["hit"] and point["values"]["cracks"] == {"valid": True, "value": 7}, point
    assert abs(statistics["area_m2"] - edit["area_m2"]) <= 0.02 * edit["area_m2"], (
        statistics["area_m2"],
        edit,
    )
    assert statistics["texels"] == edit["texels_changed"], (statistics["texels"], edit)
    assert [key["key"] for key in statistics["keys"]] == [7] and statistics["mean"] == 7, statistics
    # A path of 80 pixels with a radius of 20 covers 4457 pixels of 0.21 mm on a surface that faces
    # the camera.
    assert 1.8e-4 < edit["area_m2"] < 2.2e-4, edit


def test_its_files_are_what_they_say(folder, server):
    with open(os.path.join(folder, "picture.png"), "rb") as file:
        picture = file.read()
    assert picture.startswith(b"\x89PNG\r\n") and len(picture) > 10000, picture[:20]
    with open(os.path.join(folder, "cracks.tif"), "rb") as file:
        raster = file.read()
    assert raster[:4] in (b"II*\0", b"MM\0*", b"II+\0"), raster[:8]
    for ending, magic in (("png", b"\x89PNG\r\n"), ("npy", b"\x93NUMPY")):
        answer = server.get(f"/models/scan/layers/cracks/texels.{ending}")
        assert answer.status == 200 and answer.body.startswith(magic), (ending, answer.status)
    again = server.request(
        "PUT",
        "/models/scan/layers/cracks/texels.tif",
        raster,
        headers={"Content-Type": "image/tiff"},
    )
    assert (
        again.status == 200 and again.json()["texels_changed"] == 0
    ), "what was exported changes nothing when it is imported"


def test_its_history_has_what_it_did(server):
    history = server.get("/models/scan/layers/cracks/edits").json()["edits"]
    assert [edit["op"] for edit in history] == ["import", "stroke"], history


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
