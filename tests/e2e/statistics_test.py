#!/usr/bin/env python3
"""A layer that is filled everywhere has the model's area, on generated and on real scans."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
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


def read(name):
    with open(os.path.join(DATA, name), "rb") as file:
        return file.read()


def main():
    has_scans = os.path.isdir(DATA)
    with StrataServer(demo=True) as server:
        check(server, server.get("/models/demo-pot").json())
        if has_scans:
            check(
                server,
                server.import_model(
                    read("statue_nefertiti_70k.ply"), "statue_nefertiti_70k.ply", unit="mm"
                ),
            )
            mask = server.import_model(read("mask_bali/mask.obj"), "mask.obj", unit="m")
            # its own texture coordinates are kept
            assert mask["atlas"]["source"] == "file", mask["atlas"]
            assert 0 <= mask["atlas"]["overlap"] < 0.005, mask["atlas"]
            check(server, mask)
        assert server.stop() == 0
        server.assert_clean_log()
    if not has_scans:
        print(
            f"SKIPPED the real scans: there is no folder {DATA or '(STRATA_TEST_DATA is not set)'}"
        )


main()
