#!/usr/bin/env python3
"""A study, from scans to a table and figures: is the stone damper near cracks?

    STRATA_OWNER_TOKEN=… python3 examples/damp_study.py http://127.0.0.1:8080 north.ply south.ply
    STRATA_OWNER_TOKEN=… python3 examples/damp_study.py http://127.0.0.1:8080 --models north south

Imports each scan and paints cracks and moisture on it as an example. With --models, uses models of
the site that already have the layers `cracks` and `moisture`. Runs the same analysis on each model,
and writes table.csv and figures to the folder of --output.

Editors such as VS Code and Spyder can run the cells (`# %%`) one by one. Needs pandas. With
matplotlib, it also draws a chart of each model.
"""
import argparse
import io
import os
import pathlib
import urllib.parse

import numpy
import pandas
from strata import Strata

try:
    from matplotlib import pyplot
except ImportError:
    pyplot = None

# %% What to study, and where
arguments = argparse.ArgumentParser(
    description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
)
arguments.add_argument("address")
arguments.add_argument("scans", nargs="*", type=pathlib.Path)
arguments.add_argument("--models", nargs="*", default=[], help="slugs of models of the site")
arguments.add_argument("--direction", default="front", help="of the figures: top, front, left …")
arguments.add_argument("--output", type=pathlib.Path, default=pathlib.Path("damp-study"))
given = arguments.parse_args()
given.output.mkdir(parents=True, exist_ok=True)
site = Strata(given.address, os.environ["STRATA_OWNER_TOKEN"])
BANDS = 4  # of equal width, around the cracks
DAMP = 15  # percent


def size_of(model):
    """Returns the length of the longest side, in model units."""
    return max(numpy.subtract(model["bounds"]["max"], model["bounds"]["min"]))


def table_of(path, **query):
    """Reads a CSV file of the server."""
    text = site.request("GET", path + "?" + urllib.parse.urlencode(query))
    return pandas.read_csv(io.BytesIO(text), encoding="utf-8-sig")


# %% Import the scans, and paint on them. A real study paints by hand or imports readings.
def paint(path, model, layer, shares, values, radius):
    """Paints discs around points of the surface. Each share is a position along the diagonal."""
    low, high = numpy.array(model["bounds"]["min"]), numpy.array(model["bounds"]["max"])
    points = [list(low + share * (high - low)) for share in shares]
    found = site.post(f"{path}/positions", {"points": points})["positions"]
    lines = [
        ",".join(str(part) for part in (*point["position"], value))
        for point, value in zip(found, values)
        if point["hit"]
    ]
    asked = urllib.parse.urlencode({"radius_mm": radius, "tolerance_mm": size_of(model)})
    site.post(
        f"{path}/layers/{layer}/readings?{asked}", "\n".join(["x,y,z,value", *lines]), "text/csv"
    )


def import_and_paint(scan):
    model = site.import_model(scan, name=scan.stem, unit="mm")
    path = f"/models/{model['slug']}"
    size = size_of(model)
    site.post(f"{path}/layers", {"name": "Cracks", "type": "u8", "resolution": 2048})
    moisture = {"name": "Moisture", "type": "f32", "unit": "%", "resolution": 2048}
    site.post(f"{path}/layers", moisture)
    along = numpy.linspace(0.3, 0.7, 40)
    paint(path, model, "cracks", along, [1] * len(along), 0.01 * size)
    # the wettest readings last, because later discs cover earlier ones
    for radius, value in ((0.10, 8), (0.06, 14), (0.03, 22)):
        paint(path, model, "moisture", along, [value] * len(along), radius * size)
    return model["slug"]


slugs = [import_and_paint(scan) for scan in given.scans] + given.models


# %% Run the same analysis on each model, as one job for each
def steps_for(path, model):
    limit = 0.08 * size_of(model)
    cases = [
        f"when distance-to-cracks <= {limit * n / BANDS:.6g} then {n}" for n in range(1, BANDS)
    ]
    # Without a distance, a place is in no band: the sum with an unknown number is unknown.
    bands = f"case {' '.join(cases)} else {BANDS} end + 0 * distance-to-cracks"
    resolution = site.get(f"{path}/layers/moisture")["resolution"]
    computed = [
        {"name": "Distance to cracks", "expression": f"distance(cracks, {limit:.6g})"},
        {"name": "Bands", "type": "u8", "expression": bands},
        {"name": "Damp near cracks", "expression": f"valid(bands) and moisture > {DAMP}"},
    ]
    measured = [
        {"layer": "moisture", "where": f"bands = {band}"} for band in range(1, BANDS + 1)
    ] + [{"layer": "damp-near-cracks", "include": ["pieces"]}]
    return [{"layer": {**layer, "resolution": resolution}} for layer in computed] + [
        {"statistics": each} for each in measured
    ]


def analyse(slug):
    path = f"/models/{slug}"
    steps = steps_for(path, site.get(path))
    job = site.post(f"{path}/analysis", {"name": "Damp study", "steps": steps})
    report = site.wait_for(job["id"])["analysis"]
    pieces = report["steps"][-1]["statistics"]
    print(f"{slug}: {pieces['area_m2'] * 1e4:.2f} cm² damp near cracks, {pieces['pieces']} pieces")
    return report


reports = {slug: analyse(slug) for slug in slugs}


# %% Read the texels as tables, and summarize each band
def texels_of(slug):
    """Returns one row for each texel near a crack that has a moisture."""
    layers = f"/models/{slug}/layers"
    places = ["x", "y", "z", "area_m2"]
    rows = table_of(f"{layers}/distance-to-cracks/texels.csv", where="valid(moisture)")
    rows = rows.rename(columns={"value": "distance"})
    for layer in ("moisture", "bands"):
        values = table_of(f"{layers}/{layer}/texels.csv", where="valid(bands) and valid(moisture)")
        rows = rows.merge(values.rename(columns={"value": layer}), on=places, validate="1:1")
    return rows


def summary_of(slug, rows):
    rows = rows.assign(
        damp_m2=rows["area_m2"].where(rows["moisture"] > DAMP, 0),
        weighted=rows["moisture"] * rows["area_m2"],
    )
    bands = rows.groupby("bands").agg(
        nearest=("distance", "min"),
        farthest=("distance", "max"),
        area_m2=("area_m2", "sum"),
        damp_m2=("damp_m2", "sum"),
        weighted=("weighted", "sum"),
    )
    bands["mean_moisture"] = bands.pop("weighted") / bands["area_m2"]
    bands["damp_share"] = bands["damp_m2"] / bands["area_m2"]
    return bands.reset_index().assign(model=slug)


texels = {slug: texels_of(slug) for slug in slugs}
table = pandas.concat([summary_of(slug, rows) for slug, rows in texels.items()])
table = table[["model", *table.columns.drop("model")]]
table.to_csv(given.output / "table.csv", index=False)
print(table.to_string(index=False, float_format=lambda number: f"{number:.4g}"))

# %% The correlation of distance and moisture, weighted by area
for slug, rows in texels.items():
    covariance = numpy.cov(rows["distance"], rows["moisture"], aweights=rows["area_m2"])
    r = covariance[0, 1] / numpy.sqrt(covariance[0, 0] * covariance[1, 1])
    print(f"{slug}: r = {r:.3f} over {len(rows)} texels")

# %% A figure to scale of each model, and a chart if matplotlib is installed
for slug in slugs:
    shown = [
        {"layer": layer["slug"], "visible": layer["slug"] in ("cracks", "damp-near-cracks")}
        for layer in site.all(f"/models/{slug}/layers", "layers")
    ]
    figure = {"direction": given.direction, "layers": shown, "format": "png", "dpi": 150}
    figure["caption"] = "Cracks, and damp stone near cracks"
    path = f"/models/{slug}/figures"
    (given.output / f"{slug}-map.png").write_bytes(site.request("POST", path, figure))
    if pyplot:
        bands = table[table["model"] == slug]
        chart, axes = pyplot.subplots()
        axes.bar(bands["nearest"], bands["mean_moisture"], bands["farthest"].iloc[0], align="edge")
        axes.set(xlabel="Distance to the nearest crack", ylabel="Moisture, %", title=slug)
        chart.savefig(given.output / f"{slug}-chart.png")
        pyplot.close(chart)
