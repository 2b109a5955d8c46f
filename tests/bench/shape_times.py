#!/usr/bin/env python3
"""Seconds that layers computed from a shape take, and a transfer, from the request to the durable layer.

    STRATA_BINARY=build/release/bin/strata tests/bench/shape_times.py SCAN.ply [--unit mm] [--resolution 4096] [--from OTHER.ply]

Each is done once after one that is not counted, which opens the model and maps its surface. Beside the seconds on the clock stand
those of the server's processors: they are what to compare where others use the machine, too.
"""
import argparse
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.strata_server import StrataServer, wait_for

KINDS = ["height", "slope", "azimuth", "mean_curvature", "gaussian_curvature", "roughness", "ambient_occlusion", "boundary_distance"]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def processor_seconds(server):
    with open(f"/proc/{server.process.pid}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(server, what, path, body):
    """One line of the table; the job."""
    start, used = time.monotonic(), processor_seconds(server)
    job_id = server.ok("POST", path, body).json()["id"]
    job = wait_for(lambda: over(server.ok("GET", f"/jobs/{job_id}").json()), what, limit_s=3600)
    said = "" if job["state"] == "done" else f" ({job['problem']['title']})"
    print(f"{what:20} {time.monotonic() - start:6.1f} s   {processor_seconds(server) - used:6.1f} s of processors{said}", flush=True)
    return job


def over(job):
    return None if job["state"] in ("queued", "running") else job


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
        measure(server, "the first, uncounted", path + "/layers", {"name": "first", "resolution": asked.resolution, "compute": {"kind": "height"}})
        kinds = [{"kind": kind} for kind in KINDS]
        if asked.other:
            other = server.import_model(read(asked.other), os.path.basename(asked.other), name="Other", unit=asked.unit)
            kinds.append({"kind": "model_distance", "model": str(other["id"])})
        for recipe in kinds:
            measure(server, recipe["kind"], path + "/layers", {"name": recipe["kind"], "resolution": asked.resolution, "compute": recipe})
        if asked.other:
            diagonal_mm = sum((high - low) ** 2 for low, high in zip(model["bounds"]["min"], model["bounds"]["max"])) ** 0.5 * {"mm": 1, "cm": 10, "m": 1000}[asked.unit]
            job = measure(server, "transfer, one layer", f"/models/{other['id']}/transfer",
                          {"from": str(model["id"]), "tolerance_mm": diagonal_mm / 500, "layers": ["first"]})
            print(job.get("report"))


main()
