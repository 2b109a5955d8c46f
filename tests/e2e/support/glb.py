"""Reads GLB files as other programs do, and validates them."""
import json
import os
import struct
import subprocess
import zlib

import numpy

from .contract import ROOT
from .missing import missing

FOLDER = os.path.join(ROOT, "tests", "e2e", "gltf")
TYPES = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
NUMBERS = {"FLOAT64": "<f8", "UINT8": "<u1", "UINT16": "<u2", "UINT32": "<u4", "UINT64": "<u8"}


def validate(path):
    """Returns the report of Khronos' validator. Extensions that the validator does not know are
    notes in it."""
    if not os.path.isdir(os.path.join(FOLDER, "node_modules")):
        missing("gltf-validator is not installed: npm ci in tests/e2e/gltf")
    ran = subprocess.run(
        ["node", os.path.join(FOLDER, "validate.mjs"), str(path)],
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(ran.stdout)


def read_png(content):
    """Returns the pixels of an 8-bit PNG of the server, as an array of height, width and channel.
    Much faster than pictures.pixels for large images, because it works on whole diagonals: a pixel
    depends only on the pixels to the left of it and above it."""
    width, height, depth, kind = struct.unpack(">IIBB", content[16:26])
    assert (depth, kind) == (8, 6), (depth, kind)
    at, data = 8, b""
    while at < len(content):
        size, name = struct.unpack(">I4s", content[at : at + 8])
        if name == b"IDAT":
            data += content[at + 8 : at + 8 + size]
        at += size + 12
    lines = numpy.frombuffer(zlib.decompress(data), numpy.uint8).reshape(height, 1 + 4 * width)
    filters, coded = lines[:, 0], lines[:, 1:].reshape(height, width, 4)
    pixels = numpy.zeros((height + 1, width + 1, 4), numpy.int16)  # with a border of zeros
    for diagonal in range(height + width - 1):
        y = numpy.arange(max(0, diagonal - width + 1), min(height, diagonal + 1))
        x = diagonal - y
        left, above, corner = pixels[y + 1, x], pixels[y, x + 1], pixels[y, x]
        far = [abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)]
        paeth = numpy.where(
            (far[0] <= far[1]) & (far[0] <= far[2]),
            left,
            numpy.where(far[1] <= far[2], above, corner),
        )
        guesses = [numpy.zeros_like(left), left, above, (left + above) // 2, paeth]
        guess = numpy.choose(filters[y][:, None], guesses)
        pixels[y + 1, x + 1] = (coded[y, x] + guess) & 255
    return pixels[1:, 1:].astype(numpy.uint8)


class Glb:
    """The content of a file with one node, one mesh and one primitive."""

    def __init__(self, content):
        magic, version, length = struct.unpack("<4sII", content[:12])
        assert (magic, version, length) == (b"glTF", 2, len(content)), (magic, version, length)
        size, kind = struct.unpack("<I4s", content[12:20])
        assert kind == b"JSON"
        self.json = json.loads(content[20 : 20 + size])
        bytes_at = 28 + size
        size, kind = struct.unpack("<I4s", content[bytes_at - 8 : bytes_at])
        assert kind == b"BIN\0" and bytes_at + size == len(content)
        assert bytes_at % 8 == 0, "64-bit properties need this alignment"
        self.binary = content[bytes_at:]
        self.primitive = self.json["meshes"][0]["primitives"][0]

    def view(self, index):
        view = self.json["bufferViews"][index]
        assert view["byteOffset"] % 8 == 0
        return self.binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        width, kind = WIDTHS[accessor["type"]], numpy.dtype(TYPES[accessor["componentType"]])
        stride = self.json["bufferViews"][accessor["bufferView"]].get(
            "byteStride", width * kind.itemsize
        )
        return numpy.ndarray(
            (accessor["count"], width),
            kind,
            self.view(accessor["bufferView"]),
            accessor.get("byteOffset", 0),
            (stride, kind.itemsize),
        )

    def attribute(self, name):
        return self.accessor(self.primitive["attributes"][name])

    def triangles(self):
        return self.accessor(self.primitive["indices"]).reshape(-1, 3)

    def places(self):
        """Returns the positions in the scene: meters, +y up."""
        matrix = numpy.array(self.json["nodes"][0]["matrix"]).reshape(4, 4).T
        positions = self.attribute("POSITION").astype(float)
        return positions @ matrix[:3, :3].T + matrix[:3, 3]

    def image(self, texture):
        return self.view(
            self.json["images"][self.json["textures"][texture]["source"]]["bufferView"]
        )

    def material(self):
        return self.json["materials"][self.primitive["material"]]

    def color_image(self):
        return self.image(self.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"])

    def feature_ids(self):
        """Returns the feature ids of all pixels, and the definition of the features."""
        (features,) = self.primitive["extensions"]["EXT_mesh_features"]["featureIds"]
        texture = features["texture"]
        sampler = self.json["samplers"][self.json["textures"][texture["index"]]["sampler"]]
        assert sampler["magFilter"] == sampler["minFilter"] == 9728, "NEAREST"
        pixels = read_png(self.image(texture["index"])).astype(numpy.uint32)
        ids = sum(
            pixels[:, :, channel] << (8 * place)
            for place, channel in enumerate(texture["channels"])
        )
        return ids, features

    def properties(self):
        """Returns the values of the properties, by id. A missing value is None."""
        extension = self.json["extensions"]["EXT_structural_metadata"]
        (table,) = extension["propertyTables"]
        described = extension["schema"]["classes"][table["class"]]["properties"]
        values = {}
        for name, stored in table["properties"].items():
            values[name] = self._values(extension, described[name], stored, table["count"])
            nothing = described[name].get("noData")
            if nothing is not None:
                values[name] = [None if each == nothing else each for each in values[name]]
        return values

    def _values(self, extension, described, stored, count):
        content = self.view(stored["values"])
        if described["type"] == "STRING":
            kind = NUMBERS[stored.get("stringOffsetType", "UINT32")]
            offsets = numpy.frombuffer(self.view(stored["stringOffsets"]), kind)
            assert len(offsets) == count + 1 and offsets[-1] == len(content)
            return [content[a:b].decode() for a, b in zip(offsets, offsets[1:])]
        if described["type"] == "BOOLEAN":
            bits = numpy.unpackbits(numpy.frombuffer(content, numpy.uint8), bitorder="little")
            assert len(content) == (count + 7) // 8 and not bits[count:].any()
            return [bool(bit) for bit in bits[:count]]
        if described["type"] == "ENUM":
            enum = extension["schema"]["enums"][described["enumType"]]
            names = {each["value"]: each["name"] for each in enum["values"]}
            assert len(set(names.values())) == len(enum["values"]) and all(names.values()), names
            numbers = numpy.frombuffer(content, NUMBERS[enum["valueType"]])
            assert len(numbers) == count
            return [names[number] for number in numbers]
        numbers = numpy.frombuffer(content, NUMBERS[described["componentType"]])
        assert described["type"] == "SCALAR" and len(numbers) == count
        return [float(number) for number in numbers]


def pixel_at(image, uv):
    """Returns the pixel that contains the texture coordinates, as a nearest filter does."""
    height, width = image.shape[:2]
    column = min(width - 1, max(0, int(uv[0] * width)))
    row = min(height - 1, max(0, int(uv[1] * height)))
    return image[row, column]
