"""Cameras as the API wants them: column-major matrices, OpenGL clip space, world coordinates."""
import math


def _subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _unit(a):
    length = math.sqrt(_dot(a, a))
    return [x / length for x in a]


def look_at(eye, target, up):
    back = _unit(_subtract(eye, target))
    right = _unit(_cross(up, back))
    top = _cross(back, right)
    return [right[0], top[0], back[0], 0, right[1], top[1], back[1], 0, right[2], top[2], back[2], 0,
            -_dot(right, eye), -_dot(top, eye), -_dot(back, eye), 1]


def camera_from(model, direction, width=640, height=480, up=(0, 0, 1)):
    """Sees the whole model from a direction."""
    low, high = model["bounds"]["min"], model["bounds"]["max"]
    center = [(a + b) / 2 for a, b in zip(low, high)]
    radius = math.dist(low, high) / 2
    distance = 2.8 * radius
    eye = [c + distance * d for c, d in zip(center, _unit(direction))]
    near, far, focal = distance - 1.2 * radius, distance + 1.2 * radius, 1 / math.tan(math.radians(22.5))
    return {"view": look_at(eye, center, list(up)),
            "projection": [focal * height / width, 0, 0, 0, 0, focal, 0, 0, 0, 0, (far + near) / (near - far), -1,
                           0, 0, 2 * far * near / (near - far), 0],
            "width": width, "height": height}
