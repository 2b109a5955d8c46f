#!/usr/bin/env python3
"""Seconds that layers computed from a shape take, and a transfer, from the request to the durable layer.

    STRATA_BINARY=build/release/bin/strata tests/bench/shape_times.py SCAN.ply [--unit mm] [--resolution 4096] [--from OTHER.ply]

Each is done once after one that is not counted, which opens the model and maps its surface.
"""
import argparse
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.strata_server import StrataServer

KINDS = ["height", "slope", "azimuth", "mean_curvature", "gaussian_curvature", "roughness", "ambient_occlusion", "boundary_distance"]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def seconds_of(server, path, body):
    start = time.monotonic()
    job = server.wait_for_job(server.ok("POST", path, body).json()["id"])
    said = "" if job["state"] == "done" else f" ({job['problem']['title']})"
    return time.monotonic() - start, said, job


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scan")
    parser.add_argument("--unit", default="mm")
    parser.add_argument("--resolution", type=int, default=4096)
    parser.add_argument("--from", dest="other", help="another version of the scan: the distance to it, and a transfer of all layers to it")
    asked = parser.parse_args()
    with StrataServer() as server:
        model = server.import_model(read(asked.scan), os.path.basename(asked.scan), name="Model", unit=asked.unit)
        print(f"{asked.scan}: {model['triangles']} triangles, {asked.resolution}² texels")
        path = f"/models/{model['id']}"
        seconds_of(server, path + "/layers", {"name": "first", "resolution": asked.resolution, "compute": {"kind": "height"}})
        kinds = [{"kind": kind} for kind in KINDS]
        if asked.other:
            other = server.import_model(read(asked.other), os.path.basename(asked.other), name="Other", unit=asked.unit)
            kinds.append({"kind": "model_distance", "model": str(other["id"])})
        for recipe in kinds:
            seconds, said, _ = seconds_of(server, path + "/layers", {"name": recipe["kind"], "resolution": asked.resolution, "compute": recipe})
            print(f"{recipe['kind']:20} {seconds:6.1f} s{said}", flush=True)
        if asked.other:
            diagonal_mm = sum((high - low) ** 2 for low, high in zip(model["bounds"]["min"], model["bounds"]["max"])) ** 0.5 * {"mm": 1, "cm": 10, "m": 1000}[asked.unit]
            seconds, said, job = seconds_of(server, f"/models/{other['id']}/transfer",
                                            {"from": str(model["id"]), "tolerance_mm": diagonal_mm / 500, "layers": ["first"]})
            print(f"{'transfer, one layer':20} {seconds:6.1f} s{said}  {job.get('report')}")


main()
