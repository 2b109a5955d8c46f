#!/usr/bin/env python3
"""Measures layers computed from a shape, and a transfer, from the request to the durable layer.

  STRATA_BINARY=build/release/bin/strata tests/bench/shape_times.py SCAN.ply [--unit mm] \
    [--resolution 4096] [--from OTHER.ply] [--kinds slope,…] [--cancel] [--json FILE]

Computes each layer once. The first layer is not counted, because its job also opens the model and
makes the surface map. Prints the elapsed seconds, the processor seconds of the server, the peak
memory of the server (without its PostgreSQL), and the longest time without a change in the job's
visible progress. If other programs use the machine too, compare the processor seconds. With
--cancel, also starts each job again, cancels it after a quarter, half and most of its time, and
prints the times from the request to cancel to the end of the job.
"""
import argparse
import json
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.machine import machine, processor_seconds
from support.strata_server import StrataServer, wait_for

KINDS = [
    "height",
    "slope",
    "azimuth",
    "mean_curvature",
    "gaussian_curvature",
    "roughness",
    "ambient_occlusion",
    "boundary_distance",
]
COMPARISONS = ["model_distance", "change", "significant_change"]
CANCELLED_AFTER = (0.25, 0.5, 0.85)
LONG_S = 3600


def read(path):
    with open(path, "rb") as file:
        return file.read()


def peak_mib(server):
    with open(f"/proc/{server.process.pid}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmHWM"))


def forget_peak(server):
    with open(f"/proc/{server.process.pid}/clear_refs", "w", encoding="ascii") as file:
        file.write("5")


def follow(server, job_id, what):
    """Returns the ended job, and the longest time without new progress."""
    seen, since, silence = None, time.monotonic(), 0

    def ended():
        nonlocal seen, since, silence
        job = server.ok("GET", f"/jobs/{job_id}").json()
        now = time.monotonic()
        silence = max(silence, now - since)
        if (job["progress"], job["message"]) != seen:
            seen, since = (job["progress"], job["message"]), now
        return None if job["state"] in ("queued", "running") else job

    job = wait_for(ended, what, limit_s=LONG_S)
    return job, silence


def measure(server, what, path, body):
    """Prints one line of the table; returns the figures and the job."""
    forget_peak(server)
    start, used = time.monotonic(), processor_seconds(server.process.pid)
    job, silence = follow(server, server.ok("POST", path, body).json()["id"], what)
    figures = {
        "what": what,
        "seconds": time.monotonic() - start,
        "cpu_seconds": processor_seconds(server.process.pid) - used,
        "peak_mib": peak_mib(server),
        "silence_s": silence,
    }
    if job["state"] != "done":
        figures["refused"] = job["problem"]["title"]
    print(
        f"{what:20} {figures['seconds']:6.1f} s   {figures['cpu_seconds']:6.1f} s of processors   {figures['peak_mib']:6.0f} MiB   "
        f"silent for {silence:4.1f} s{' (' + figures['refused'] + ')' if 'refused' in figures else ''}",
        flush=True,
    )
    return figures, job


def seconds_to_cancel(server, path, body, after):
    """Returns the time from the request to cancel to the job's end; None if the job had ended
    before."""
    job_id = server.ok("POST", path, body).json()["id"]
    time.sleep(after)
    asked = time.monotonic()
    server.request("DELETE", f"/jobs/{job_id}")
    job, _ = follow(server, job_id, "the end of a cancelled job")
    for layer in job.get("layers", []):
        server.ok("DELETE", f"{path}/{layer}")
    return time.monotonic() - asked if job["state"] == "cancelled" else None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scan")
    parser.add_argument("--unit", default="mm")
    parser.add_argument("--resolution", type=int, default=4096)
    parser.add_argument(
        "--from",
        dest="other",
        help="another version of the scan: the distance to it, and a transfer of all layers to it",
    )
    parser.add_argument("--kinds", help="only these, separated by commas")
    parser.add_argument(
        "--cancel", action="store_true", help="how soon a job ends that is cancelled, too"
    )
    parser.add_argument("--json", help="write the figures here")
    asked = parser.parse_args()
    rows = []
    with StrataServer() as server:
        model = server.import_model(
            read(asked.scan), os.path.basename(asked.scan), name="Model", unit=asked.unit
        )
        print(f"{asked.scan}: {model['triangles']} triangles, {asked.resolution}² texels")
        path = f"/models/{model['id']}"
        measure(
            server,
            "the first, uncounted",
            path + "/layers",
            {"name": "first", "resolution": asked.resolution, "compute": {"kind": "height"}},
        )
        kinds = [{"kind": kind} for kind in (asked.kinds.split(",") if asked.kinds else KINDS)]
        if asked.other:
            other = server.import_model(
                read(asked.other), os.path.basename(asked.other), name="Other", unit=asked.unit
            )
            kinds += [{"kind": kind, "model": str(other["id"])} for kind in COMPARISONS]
        for recipe in kinds:
            body = {"name": recipe["kind"], "resolution": asked.resolution, "compute": recipe}
            figures, job = measure(server, recipe["kind"], path + "/layers", body)
            if asked.cancel and job["state"] == "done":
                times = [
                    seconds_to_cancel(
                        server,
                        path + "/layers",
                        {**body, "name": "never"},
                        share * figures["seconds"],
                    )
                    for share in CANCELLED_AFTER
                ]
                figures["cancel_s"] = max((t for t in times if t is not None), default=None)
                print(
                    f"{'':20} cancelled, it ended after "
                    + ", ".join("(was done)" if t is None else f"{t:.1f} s" for t in times),
                    flush=True,
                )
            for layer in job.get("layers", []):
                # Delete the layers, so each measurement starts with only the first layer.
                server.ok("DELETE", f"{path}/layers/{layer}")
            rows.append(figures)
        if asked.other:
            diagonal_mm = (
                sum(
                    (high - low) ** 2
                    for low, high in zip(model["bounds"]["min"], model["bounds"]["max"])
                )
                ** 0.5
                * {"mm": 1, "cm": 10, "m": 1000}[asked.unit]
            )
            figures, job = measure(
                server,
                "transfer, one layer",
                f"/models/{other['id']}/transfer",
                {"from": str(model["id"]), "tolerance_mm": diagonal_mm / 500, "layers": ["first"]},
            )
            print(job.get("report"))
            rows.append(figures)
    if asked.json:
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump(
                {
                    "machine": machine(),
                    "scan": os.path.basename(asked.scan),
                    "triangles": model["triangles"],
                    "resolution": asked.resolution,
                    "results": rows,
                },
                file,
                indent=1,
            )
            file.write("\n")


main()
