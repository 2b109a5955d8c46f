#!/usr/bin/env pvpython
"""paraview_frames.py MESH.ply [--size 1280x720] [--quality 80] [--seconds 10] [--screen-pid PID]:
makes pictures of a turning camera with ParaView's web engine,
vtkPVWebApplication.StillRenderToBuffer, as its server (pvpython -m paraview.apps.…) does for a
page: a JPEG for each camera. Prints one line, "figures: " and JSON.

A picture is complete when the engine returns its own JPEG. The engine encodes while it draws, and
returns the JPEG of the previous picture while `GetHasImagesBeingProcessed` is true. The times
include no socket. Needs a display (Xvfb) and Debian's packages paraview and python3-paraview."""
import argparse
import json
import math
import os
import statistics
import time

from paraview import simple
from paraview.modules.vtkPVClientWeb import vtkPVWebApplication

TURN_RAD = 0.008  # for each frame, the rotation of Strata's viewers
WARM_S = 1.0
TICKS = os.sysconf("SC_CLK_TCK")


def seconds_of(pid):
    """Returns the user and system time of a process, in seconds."""
    with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def show(path, width, height):
    mesh = simple.OpenDataFile(path)
    view = simple.CreateRenderView(ViewSize=[width, height], OrientationAxesVisibility=0)
    shown = simple.Show(mesh, view)
    if mesh.PointData.GetArray("RGB"):
        simple.ColorBy(shown, ("POINTS", "RGB"))
        shown.MapScalars = 0  # the values are colors
    simple.Render(view)
    low_x, high_x, low_y, high_y, low_z, high_z = mesh.GetDataInformation().GetBounds()
    low, high = (low_x, low_y, low_z), (high_x, high_y, high_z)
    center = [(a + b) / 2 for a, b in zip(low, high)]
    return mesh, view, center, math.dist(low, high) / 2


def look(view, center, radius, angle):
    """Returns the same camera as `look_at` of the bench: 45°, at the distance where the mesh fills
    the window."""
    direction = (math.cos(angle), math.sin(angle), 0.4)
    length = math.hypot(*direction)
    view.CameraViewAngle = 45
    view.CameraViewUp = [0, 0, 1]
    view.CameraFocalPoint = center
    view.CameraPosition = [c + 2.4 * radius * d / length for c, d in zip(center, direction)]


def picture(app, view, quality):
    """Returns the bytes of the JPEG of the current camera."""
    app.InvalidateCache(view.SMProxy)
    image = app.StillRenderToBuffer(view.SMProxy, 0, quality)
    while image is None or app.GetHasImagesBeingProcessed(view.SMProxy):
        time.sleep(0.0005)
        image = app.StillRenderToBuffer(view.SMProxy, 0, quality) or image
    return bytes(memoryview(image))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--quality", type=int, default=80)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--screen-pid", type=int)
    asked = parser.parse_args()
    width, height = map(int, asked.size.split("x"))
    mesh, view, center, radius = show(asked.mesh, width, height)
    app = vtkPVWebApplication()
    app.SetImageEncoding(0)  # bytes, not base64
    used = lambda: seconds_of(os.getpid()) + (
        seconds_of(asked.screen_pid) if asked.screen_pid else 0
    )
    angle, times, sizes, begun, used_before = 0.7, [], [], None, 0.0
    first = time.monotonic()
    while begun is None or time.monotonic() - begun < asked.seconds:
        if begun is None and time.monotonic() - first > WARM_S:
            begun, used_before, times, sizes = time.monotonic(), used(), [], []
        asked_at = time.monotonic()
        angle += TURN_RAD
        look(view, center, radius, angle)
        jpeg = picture(app, view, asked.quality)
        assert jpeg[:2] == b"\xff\xd8", "no JPEG came"
        times.append(1000 * (time.monotonic() - asked_at))
        sizes.append(len(jpeg))
    seconds, cores = time.monotonic() - begun, (used() - used_before) / (time.monotonic() - begun)
    times.sort()
    print(
        "figures: "
        + json.dumps(
            {
                "seconds": seconds,
                "frames_per_s": len(times) / seconds,
                "cores": cores,
                "frames_per_cpu_s": len(times) / seconds / cores,
                "bytes_a_frame": statistics.median(sizes),
                "triangles": mesh.GetDataInformation().GetNumberOfCells(),
                "paraview": str(simple.GetParaViewVersion()),
                "renderer": str(
                    view.GetRenderWindow()
                    .ReportCapabilities()
                    .split("OpenGL renderer string:")[1]
                    .split("\n")[0]
                    .strip()
                ),
                "camera_to_picture": {
                    "ms_median": statistics.median(times),
                    "ms_min": times[0],
                    "ms_max": times[-1],
                    "ms_p95": times[min(len(times) - 1, int(0.95 * len(times)))],
                    "runs": len(times),
                },
            }
        ),
        flush=True,
    )


main()
