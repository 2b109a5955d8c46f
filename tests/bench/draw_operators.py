#!/usr/bin/env python3
"""Draws each operator on layers before and after, for a person to judge. This is not a test.

  STRATA_BINARY=build/release/bin/strata tests/bench/draw_operators.py FOLDER SCAN.ply[:unit[:up]] …

Imports each scan and computes layers to start from: numbers and classes in waves, readings in spots,
and the relief of the scan. Writes FOLDER/index.html and its pictures: the layer before, and the
layer after the operator, with the elapsed seconds. Lengths are shares of the side of a square with
the area of the surface.
"""
import argparse
import html
import os
import pathlib
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.strata_server import StrataServer

UP_NORMAL = {"x": "nx", "y": "ny", "z": "nz"}
LONG_S = 3600
SIZE = 460  # of a picture, in pixels
# The axes of the front view, as in server/domain/scene/up.h: to the right, and up.
AXES = {"x": ((0, 1, 0), (1, 0, 0)), "y": ((1, 0, 0), (0, 1, 0)), "z": ((1, 0, 0), (0, 0, 1))}


def camera_of(bounds, up):
    """Shows the box from the front, without perspective."""
    right, top = AXES[up[-1]]
    if up.startswith("-"):
        top = tuple(-c for c in top)
    back = (
        right[1] * top[2] - right[2] * top[1],
        right[2] * top[0] - right[0] * top[2],
        right[0] * top[1] - right[1] * top[0],
    )

    def extent(axis):
        sides = zip(bounds["min"], bounds["max"], axis)
        return sum((high - low) * abs(share) for low, high, share in sides) / 2

    middle = [(low + high) / 2 for low, high in zip(bounds["min"], bounds["max"])]
    half, deep = 1.05 * max(extent(right), extent(top)), 1.5 * extent(back)
    view = [c for n in range(3) for c in (right[n], top[n], back[n], 0)]
    view += [-sum(a * m for a, m in zip(axis, middle)) for axis in (right, top, back)] + [1]
    projection = [1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -1 / deep, 0, 0, 0, 0, 1]
    return {"view": view, "projection": projection, "width": SIZE, "height": SIZE}


def waves(length, phase):
    terms = [
        f"sin({a / length:.6g} * x + {b / length:.6g} * y + {c / length:.6g} * z + {phase * n})"
        for n, (a, b, c) in enumerate([(7, 2, 3), (-3, 6, 2), (1, -4, 7)], start=1)
    ]
    return " + ".join(terms)


def starting_layers(side):
    """Returns {name: (expression, type)}."""
    near = side * 0.01
    relief = " + ".join(f"n{a} * ({a} - focal_mean({a}, {near:.4g}))" for a in "xyz")
    spots = f"({waves(side / 9, 5)}) > 2.6"
    return {
        "Numbers": (waves(side / 4, 1), "f32"),
        "Classes": (
            f"case when {waves(side / 12, 2)} > 1.4 then null "
            f"when {waves(side / 4, 1)} > 0.7 then 3 "
            f"when {waves(side / 15, 3)} > 1.2 then 2 else 1 end",
            "u8",
        ),
        "Readings": (f"case when {spots} then round(10 * ({waves(side / 3, 1)})) / 10 end", "f32"),
        "Relief": (relief, "f32"),
    }


def expressions(side, up):
    """Returns [(layer before, expression)]."""
    near, far, thin = side * 0.006, side * 0.05, side * 0.002
    return [
        ("Classes", f"distance(classes = 3, {far:.4g})"),
        ("Classes", f"within(classes = 3, {far / 3:.4g})"),
        ("Readings", "nearest(readings)"),
        ("Numbers", f"focal_mean(numbers, {near:.4g})"),
        ("Numbers", f"focal_max(numbers, {near:.4g})"),
        ("Classes", f"focal_variety(classes, {near:.4g})"),
        ("Numbers", f"hot_spot(numbers, {near:.4g})"),
        ("Numbers", f"hot_spot_chance(numbers, {near:.4g}, 199)"),
        ("Relief", f"valley(relief, {thin:.4g})"),
        ("Relief", f"hysteresis(valley(relief, {thin:.4g}), {thin / 20:.4g}, {thin / 6:.4g})"),
        ("Numbers", "watershed(numbers, 0.4)"),
        ("Relief", f"run_off(max(0, {'-' if up.startswith('-') else ''}{UP_NORMAL[up[-1]]}))"),
        ("Readings", f"interpolated(readings, {side / 3:.4g})"),
        ("Readings", f"interpolation_error(readings, {side / 3:.4g})"),
    ]


def shapes(side, mm):
    """Returns [(words, recipe)], for layers from the shape."""
    rain = {
        "wind_shares": [10, 8, 6, 8, 14, 28, 18, 8],
        "wind_speed_m_s": 4.5,
        "rain_mm": 760,
        "north_deg": 0,
    }
    return [
        ("ambient occlusion", {"kind": "ambient_occlusion"}),
        ("mean curvature", {"kind": "mean_curvature", "radius_mm": side * mm * 0.01}),
        ("energy of the sun", {"kind": "sun_energy", "latitude_deg": 40, "north_deg": 0}),
        ("driving rain", {"kind": "driving_rain", **rain}),
    ]


def cleanups(side, mm):
    """Returns [(words, body)], for the layer of classes."""
    width, cm2 = side * 0.03 * mm, (side * mm / 10) ** 2 * 1.5e-3
    return [
        ("remove small regions", {"operation": "sieve", "area_cm2": cm2}),
        ("fill small holes", {"operation": "fill-holes", "area_cm2": cm2}),
        ("smooth by majority", {"operation": "majority", "radius_mm": width / 2}),
        ("remove narrow parts of 3", {"operation": "open", "of": 3, "width_mm": width}),
        ("close narrow gaps of 3", {"operation": "close", "of": 3, "width_mm": width}),
        (
            "paint the border of 3",
            {"operation": "border", "of": 3, "width_mm": width / 3, "value": 2},
        ),
    ]


class Sheet:
    def __init__(self, folder, server, scan, model, resolution):
        self.folder, self.server, self.scan = folder, server, pathlib.Path(scan).name
        self.path, self.resolution = f"/models/{model['id']}", resolution
        self.camera = camera_of(model["bounds"], model["up"])
        self.rows = []
        self.count = 0

    def ended(self, job):
        done = self.server.wait_for_job(job["id"], LONG_S)
        assert done["state"] == "done", done
        return done

    def add_layer(self, name, **body):
        """Returns the slug, and the seconds until the layer is durable."""
        start = time.monotonic()
        body = {"name": name, "resolution": self.resolution, **body}
        answer = self.server.ok("POST", self.path + "/layers", body).json()
        if "state" in answer:
            job = self.ended(answer)
            slug = self.server.get(f"{self.path}/layers/{job['layers'][0]}").json()["slug"]
        else:
            slug = answer["slug"]
        return slug, time.monotonic() - start

    def clean_up(self, slug, body):
        start = time.monotonic()
        self.server.ok("PATCH", f"{self.path}/layers/{slug}", {"locked": False})
        job = self.server.ok("POST", f"{self.path}/layers/{slug}/cleanup", body).json()
        assert self.ended(job)["cleanup"]["texels"] > 0, f"{body} changed nothing"
        return time.monotonic() - start

    def picture(self, slug):
        self.count += 1
        name = f"{pathlib.Path(self.scan).stem}-{self.count:02}.png"
        body = {"camera": self.camera, "layers": [slug], "format": "png", "samples": 4}
        answer = self.server.ok("POST", self.path + "/frame", body)
        (self.folder / name).write_bytes(answer.body)
        return name

    def add_row(self, before, after, title, seconds):
        self.rows.append((before, after, title, seconds))
        print(f"{self.scan}: {title}: {seconds:.1f} s", flush=True)


def draw(server, folder, given, resolution):
    scan, unit, up = (given.split(":") + ["mm", "z"])[:3] if ":" in given else (given, "mm", "z")
    content = pathlib.Path(scan).read_bytes()
    model = server.import_model(content, pathlib.Path(scan).name, unit=unit)
    model = server.ok("PATCH", f"/models/{model['id']}", {"up": up}).json()
    mm = {"mm": 1, "cm": 10, "m": 1000}[unit]
    side = model["area_m2"] ** 0.5 * 1000 / mm
    sheet = Sheet(folder, server, scan, model, resolution)
    before = {}
    for name, (expression, kind) in starting_layers(side).items():
        slug, _ = sheet.add_layer(name, type=kind, expression=expression)
        before[name] = sheet.picture(slug)
    for number, (name, expression) in enumerate(expressions(side, up)):
        slug, seconds = sheet.add_layer(f"After {number}", expression=expression)
        sheet.add_row(before[name], sheet.picture(slug), expression, seconds)
    for words, recipe in shapes(side, mm):
        slug, seconds = sheet.add_layer(words, compute=recipe)
        sheet.add_row(before["Relief"], sheet.picture(slug), words, seconds)
    for words, body in cleanups(side, mm):
        slug, _ = sheet.add_layer(words, type="u8", expression="classes")
        seconds = sheet.clean_up(slug, body)
        sheet.add_row(before["Classes"], sheet.picture(slug), words, seconds)
    return sheet


def page_of(sheets):
    parts = ["<!doctype html><meta charset=utf-8><title>Operators</title><style>"]
    parts.append(
        "body{font:14px sans-serif}figure{display:inline-block;margin:4px}img{width:230px}"
    )
    parts.append("figcaption{width:460px}</style>")
    for sheet in sheets:
        parts.append(f"<h1>{html.escape(sheet.scan)}, {sheet.resolution}²</h1>")
        for before, after, title, seconds in sheet.rows:
            pictures = "".join(f'<img src="{name}">' for name in (before, after))
            caption = f"<figcaption>{html.escape(title)}: {seconds:.1f} s</figcaption>"
            parts.append(f"<figure>{pictures}{caption}</figure>")
    return "\n".join(parts)


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    reads.add_argument("folder", type=pathlib.Path)
    reads.add_argument("scans", nargs="+")
    reads.add_argument("--resolution", type=int, default=2048)
    asked = reads.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    with StrataServer() as server:
        sheets = [draw(server, asked.folder, scan, asked.resolution) for scan in asked.scans]
    (asked.folder / "index.html").write_text(page_of(sheets), encoding="utf-8")


if __name__ == "__main__":
    main()
