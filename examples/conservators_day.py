#!/usr/bin/env python3
"""A conservator's day: a scan, a layer of damages, readings of moisture, and the areas at the end.

    STRATA_OWNER_TOKEN=… python3 examples/conservators_day.py http://127.0.0.1:8080 scan.ply
"""

import os
import sys

from strata import Strata

DAMAGES = [("Loss", "#c04020"), ("Flaking", "#e0a030"), ("Salts", "#f0f0e0")]


def main() -> int:
    if len(sys.argv) != 3 or "STRATA_OWNER_TOKEN" not in os.environ:
        print(__doc__)
        return 2
    site = Strata(sys.argv[1], os.environ["STRATA_OWNER_TOKEN"])

    # Nine o'clock: import the scan. If the file has no unit, the page asks for the unit.
    model = site.import_model(sys.argv[2], name="Wall", unit="mm")
    path = f"/models/{model['slug']}"
    low, high = model["bounds"]["min"], model["bounds"]["max"]
    size = max(b - a for a, b in zip(low, high))
    print(f"{model['name']}: {model['triangles']} triangles, {model['area_m2']:.4f} m²")

    # Create the layers: classes of damage, and moisture in percent.
    palette = {
        "mode": "categorical",
        "points": [
            {"at": key, "color": color, "label": name}
            for key, (name, color) in enumerate(DAMAGES, 1)
        ],
    }
    damage = site.post(
        f"{path}/layers",
        {"name": "Damage", "kind": "numeric", "type": "u8", "palette": palette},
    )
    moisture = site.post(
        f"{path}/layers", {"name": "Moisture", "kind": "numeric", "type": "f32", "unit": "%"}
    )

    # Until noon: import values at measured points, and paint each one on the surface around its
    # point.
    places = site.post(
        f"{path}/positions",
        {
            "points": [
                [low[k] + share * (high[k] - low[k]) for k in range(3)] for share in (0.3, 0.5, 0.7)
            ]
        },
    )
    spots = [point["position"] for point in places["positions"] if point["hit"]]
    for layer, values in ((damage, (1, 2, 3)), (moisture, (12.5, 18, 31.5))):
        lines = [f"{x},{y},{z},{value}" for (x, y, z), value in zip(spots, values)]
        site.post(
            f"{path}/layers/{layer['slug']}/readings?radius_mm={size / 10}&tolerance_mm={size}",
            "x,y,z,value\n" + "\n".join(lines) + "\n",
            "text/csv",
        )

    # In the evening: get the area of each class, and the wet area.
    statistics = site.get(f"{path}/layers/{damage['slug']}/statistics")
    for key in statistics["keys"]:
        name = DAMAGES[key["key"] - 1][0]
        print(f"{name}: {key['area_m2'] * 1e4:.2f} cm²")
    wet = site.post(f"{path}/select", {"where": "moisture > 15", "layers": [damage["slug"]]})
    print(f"Wetter than 15 %: {wet['area_m2'] * 1e4:.2f} cm²")
    return 0


if __name__ == "__main__":
    sys.exit(main())
