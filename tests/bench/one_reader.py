#!/usr/bin/env python3
"""Measures the effect of one reader's heavy queries on others, and how soon the server stops work
for closed connections.

    STRATA_BINARY=build/release/bin/strata tests/bench/one_reader.py [--json FILE] [--only NAME,…]

frame      seconds for a frame of 320 × 180 of one user: alone, and while another user requests
           three frames of 8192² (median and longest of several)
list       seconds for a condition of 1900 items over a filled layer of 4096²
leave      seconds from closing the connections until the server has used no processor for half a
           second: after long conditions, after large pictures
stop       seconds from SIGTERM to the end of the process, during long conditions and pictures
empty      memory for statistics of an empty layer of 16384²: the maximum, and afterward
points     seconds until the server refuses 1 200 000 points

Prints one line for each measurement. Needs only Python and the server.
"""
import argparse
import http.client
import json
import os
import socket
import statistics
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
from support.cameras import camera_from
from support.machine import machine, processor_seconds
from support.meshes import folded_grid
from support.process_memory import PeakGrowth
from support.strata_server import StrataServer

M = "/models/sheet"
LONG = " or ".join(["sin(n)>1"] * 340)
LIST = "k in (" + ",".join(["1"] * 1900) + ")"
LIST_F = "n in (" + ",".join(["1"] * 1900) + ")"


def begin(server, path, body, token):
    text = json.dumps(body).encode()
    link = socket.create_connection((server.host, server.port))
    link.sendall(
        (
            f"POST /api/v1{path} HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\n"
            f"Content-Length: {len(text)}\r\n\r\n"
        ).encode()
        + text
    )
    return link


def timed(server, path, body, token=None, headers=None):
    link = http.client.HTTPConnection(server.host, server.port, timeout=600)
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    start = time.monotonic()
    link.request(
        "POST",
        "/api/v1" + path,
        body=data,
        headers={
            "Authorization": "Bearer " + (token or server.token),
            "Content-Type": "application/json",
        },
    )
    answer = link.getresponse()
    answer.read()
    took = time.monotonic() - start
    link.close()
    return took, answer.status


def until_idle(server):
    """Returns the seconds until the process used almost no processor for half a second."""
    start, last = time.monotonic(), time.monotonic()
    used = processor_seconds(server.process.pid)
    while time.monotonic() - start < 300:
        time.sleep(0.1)
        now = processor_seconds(server.process.pid)
        if now - used > 0.01:
            last = time.monotonic()
        used = now
        if time.monotonic() - last > 0.5:
            return max(0.0, last - start)
    return float("inf")


def frame(site):
    model = site.get(M).json()
    large, small = (
        {"camera": camera_from(model, (0.2, -1, 0.6), *size)} for size in ((8192, 8192), (320, 180))
    )
    timed(site, M + "/frame", small)
    alone = [timed(site, M + "/frame", small)[0] for _ in range(10)]
    with PeakGrowth(site) as growth:
        links = [begin(site, M + "/frame", large, site.eve) for _ in range(3)]
        time.sleep(2)
        beside = [timed(site, M + "/frame", small)[0] for _ in range(10)]
        gone = leave(site, links)
    return {
        "alone_s": statistics.median(alone),
        "beside_s": statistics.median(beside),
        "beside_longest_s": max(beside),
        "memory_mb": growth.mb,
        "idle_after_leaving_s": gone,
    }


def listed(site):
    found = {}
    for name, where in (("u8", LIST), ("f32", LIST_F)):
        timed(site, M + "/select", {"where": where})
        found[name + "_s"] = min(timed(site, M + "/select", {"where": where})[0] for _ in range(3))
    return found


def leave(site, links):
    for link in links:
        link.close()
    return until_idle(site)


def leaving(site):
    links = [begin(site, M + "/select", {"where": LONG}, site.eve) for _ in range(3)]
    time.sleep(2)
    return {"conditions_s": leave(site, links)}


def empty(site):
    site.ok("POST", M + "/layers", {"name": "Vast", "type": "u8", "resolution": 16384})
    with PeakGrowth(site) as growth:
        start = time.monotonic()
        site.ok("GET", M + "/layers/vast/statistics")
        took = time.monotonic() - start
    return {"peak_mb": growth.mb, "after_mb": growth.after_mb, "s": took}


def points(site):
    body = b'{"points":[' + b"[1,2,3]," * 1_199_999 + b"[1,2,3]]}"
    timed(site, M + "/positions", body)
    used = processor_seconds(site.process.pid)
    took = [timed(site, M + "/positions", body) for _ in range(5)]
    return {
        "s": min(each for each, _ in took),
        "processor_s": (processor_seconds(site.process.pid) - used) / 5,
        "status": took[0][1],
    }


def stopping(site, body):
    links = [begin(site, M + path, body, site.eve) for path, body in body for _ in range(3)]
    time.sleep(2)
    start = time.monotonic()
    assert site.stop() == 0
    took = time.monotonic() - start
    for link in links:
        link.close()
    return took


class Site(StrataServer):
    def __enter__(self):
        super().__enter__()
        self.import_model(
            folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=4096
        )
        for name, kind in (("k", "u8"), ("n", "f32")):
            self.ok("POST", M + "/layers", {"name": name, "type": kind, "resolution": 4096})
            self.ok(
                "POST",
                f"{M}/layers/{name}/edits",
                {"op": "fill", "mode": "where", "where": "true", "value": 7},
            )
        self.eve = self.add_person("eve", "curator")
        return self


CASES = {"frame": frame, "list": listed, "leave": leaving, "empty": empty, "points": points}


def main():
    reads = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    reads.add_argument("--json")
    reads.add_argument("--only", default="frame,list,leave,empty,points,stop")
    asked = reads.parse_args()
    chosen = asked.only.split(",")
    found = {"machine": machine()}
    print(found["machine"], flush=True)
    with Site() as site:
        for name in chosen:
            if name in CASES:
                found[name] = CASES[name](site)
                print(name, json.dumps(found[name]), flush=True)
    if "stop" in chosen:
        found["stop"] = {}
        for name in ("conditions", "pictures"):
            with Site() as site:
                camera = camera_from(site.get(M).json(), (0.2, -1, 0.6), 8192, 8192)
                body = (
                    [("/select", {"where": LONG})]
                    if name == "conditions"
                    else [("/frame", {"camera": camera})]
                )
                found["stop"][name + "_s"] = stopping(site, body)
        print("stop", json.dumps(found["stop"]), flush=True)
    if asked.json:
        with open(asked.json, "w", encoding="utf-8") as file:
            json.dump(found, file, indent=1)


if __name__ == "__main__":
    main()
