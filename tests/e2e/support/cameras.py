"""Cameras for the tests, made with the module of scripts/ in their own window."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import camera  # noqa: E402


def camera_from(model, direction, width=640, height=480, up=(0, 0, 1)):
    return camera.camera_from(model, direction, width, height, list(up))
