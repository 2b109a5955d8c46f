#!/usr/bin/env python3
"""camera.py MODEL_URL [WIDTH HEIGHT]: prints a camera that shows the whole model from the front, in
the format of the API.

Reads STRATA_OWNER_TOKEN. Matrices are column-major, OpenGL clip space, world coordinates."""
import json
import math
import os
import sys
import urllib.request


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def look_at(eye, target, up):
    forward = unit(subtract(target, eye))
    right = unit(cross(forward, up))
    top = cross(right, forward)
    back = [-x for x in forward]
    return [
        right[0],
        top[0],
        back[0],
        0,
        right[1],
        top[1],
        back[1],
        0,
        right[2],
        top[2],
        back[2],
        0,
        -dot(right, eye),
        -dot(top, eye),
        -dot(back, eye),
        1,
    ]


def perspective(angle, aspect, near, far):
    f = 1 / math.tan(angle / 2)
    return [
        f / aspect,
        0,
        0,
        0,
        0,
        f,
        0,
        0,
        0,
        0,
        (far + near) / (near - far),
        -1,
        0,
        0,
        2 * far * near / (near - far),
        0,
    ]


def camera_from(model, direction, width, height, up):
    """Returns a camera that shows the whole model from a direction."""
    low, high = model["bounds"]["min"], model["bounds"]["max"]
    center = [(a + b) / 2 for a, b in zip(low, high)]
    radius = math.dist(low, high) / 2
    distance = 2.7 * radius
    eye = [c + distance * d for c, d in zip(center, unit(direction))]
    return {
        "view": look_at(eye, center, up),
        "projection": perspective(
            math.radians(45), width / height, distance - 1.2 * radius, distance + 1.2 * radius
        ),
        "width": width,
        "height": height,
    }


def main():
    request = urllib.request.Request(
        sys.argv[1], headers={"Authorization": "Bearer " + os.environ["STRATA_OWNER_TOKEN"]}
    )
    model = json.load(urllib.request.urlopen(request))
    width, height = (int(sys.argv[2]), int(sys.argv[3])) if len(sys.argv) > 3 else (1280, 720)
    up = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}[model["up"]]
    front = [0, 0, 1] if model["up"] == "y" else [0, -1, 0]
    print(json.dumps(camera_from(model, front, width, height, up)))


if __name__ == "__main__":
    main()
