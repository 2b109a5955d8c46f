"""The examples run unchanged, and their output agrees with the server's data."""
import os
import re
import subprocess
import sys

import pytest
from support.meshes import folded_grid

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
EXAMPLES = os.path.join(ROOT, "examples")


def test_a_conservators_day_ends_with_the_areas_that_the_server_tells(server, tmp_path):
    (tmp_path / "wall.ply").write_bytes(folded_grid(fold=0.001))
    told = subprocess.run(
        [
            sys.executable,
            os.path.join(EXAMPLES, "conservators_day.py"),
            server.url,
            str(tmp_path / "wall.ply"),
        ],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "STRATA_OWNER_TOKEN": server.token},
    )
    assert told.returncode == 0, told.stderr
    areas = dict(re.findall(r"^(\w+): ([\d.]+) cm²$", told.stdout, re.M))
    assert list(areas) == ["Loss", "Flaking", "Salts"], told.stdout
    statistics = server.get("/models/wall/layers/damage/statistics").json()
    held = {key["key"]: key["area_m2"] * 1e4 for key in statistics["keys"]}
    for key, area in enumerate(areas.values(), 1):
        assert float(area) > 0
        assert abs(float(area) - held[key]) < 0.006, (key, area, held)
    wet = float(re.search(r"Wetter than 15 %: ([\d.]+)", told.stdout).group(1))
    # two of the three readings exceed the limit; each disc has the area of a damage
    assert abs(wet - (held[2] + held[3])) < 0.05 * wet, (wet, held)


def test_the_client_tells_what_was_refused_and_reads_lists_whole(server, monkeypatch):
    monkeypatch.syspath_prepend(EXAMPLES)
    from strata import Problem, Strata

    site = Strata(server.url, server.token)
    assert [layer["slug"] for layer in site.all("/models/wall/layers", "layers")] == [
        "damage",
        "moisture",
    ]
    assert len(site.all("/models/wall/layers", "layers", page=1)) == 2, "from two pages"
    with pytest.raises(Problem) as refused:
        site.get("/models/no-such-model")
    assert (refused.value.status, refused.value.type) == (404, "/problems#not_found")
    with pytest.raises(Problem) as refused:
        site.post("/models/wall/layers", {"name": ""})
    assert (refused.value.status, refused.value.field) == (422, "name")
