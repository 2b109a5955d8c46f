"""The study of the examples runs unchanged, for two scans and then for models of the site. Its table
agrees with the statistics of the server."""
import os
import re
import subprocess
import sys

import pytest
from support.meshes import folded_grid
from support.missing import missing

try:
    import pandas
except ImportError as error:
    missing(f"{error}; ./test installs python3-pandas")

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
STUDY = os.path.join(ROOT, "examples", "damp_study.py")


def study(server, folder, *arguments):
    told = subprocess.run(
        [sys.executable, STUDY, server.url, *arguments]
        + ["--direction", "top", "--output", str(folder)],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "STRATA_OWNER_TOKEN": server.token},
    )
    assert told.returncode == 0, told.stderr
    return told.stdout, pandas.read_csv(folder / "table.csv")


def check(server, folder, told, table, slugs):
    assert table["model"].unique().tolist() == slugs and len(table) == 4 * len(slugs), table
    for slug, rows in table.groupby("model"):
        # wetter near the cracks, as painted
        assert rows["mean_moisture"].is_monotonic_decreasing, rows
        assert (rows["nearest"].iloc[1:].values >= rows["farthest"].iloc[:-1].values - 1e-6).all()
        for row in rows.itertuples():
            path = f"/models/{slug}/layers/moisture/statistics?where=bands%20%3D%20{row.bands}"
            held = server.ok("GET", path).json()
            assert row.area_m2 == pytest.approx(held["area_m2"], rel=1e-5)
            assert row.mean_moisture == pytest.approx(held["mean"], rel=1e-5)
        damp = server.ok("GET", f"/models/{slug}/layers/damp-near-cracks/statistics").json()
        assert rows["damp_m2"].sum() == pytest.approx(damp["area_m2"], rel=1e-5)
        area = re.search(rf"^{slug}: ([\d.]+) cm² damp near cracks", told, re.M).group(1)
        assert float(area) == pytest.approx(damp["area_m2"] * 1e4, abs=0.006)
        assert float(re.search(rf"^{slug}: r = (-[\d.]+) ", told, re.M).group(1)) < -0.5, told
        assert (folder / f"{slug}-map.png").read_bytes().startswith(b"\x89PNG")
        layer = server.get(f"/models/{slug}/layers/bands").json()
        assert (layer["analysis"]["name"], layer["analysis"]["step"]) == ("Damp study", 2)


def test_two_scans_become_a_table_and_figures(server, tmp_path):
    for name in ("north", "south"):
        (tmp_path / f"{name}.ply").write_bytes(folded_grid(fold=0.001))
    scans = [str(tmp_path / f"{name}.ply") for name in ("north", "south")]
    told, table = study(server, tmp_path, *scans)
    check(server, tmp_path, told, table, ["north", "south"])


def test_models_of_the_site_are_studied_without_an_import(server, tmp_path):
    for slug in ("north", "south"):
        for layer in ("damp-near-cracks", "bands", "distance-to-cracks"):
            server.ok("DELETE", f"/models/{slug}/layers/{layer}")
    told, table = study(server, tmp_path, "--models", "south", "north")
    check(server, tmp_path, told, table, ["south", "north"])
    assert server.get("/models").json()["total"] == 2


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
