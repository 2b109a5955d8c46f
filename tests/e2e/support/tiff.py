"""Reads TIFF images in the server's format: RGB8 in strips, deflate, horizontal differences."""
import struct
import zlib

import numpy


def read(content):
    """Returns the pixels as rows × columns × 3, and the tags by number."""
    order = {b"II*\0": "<", b"MM\0*": ">"}[content[:4]]
    at = struct.unpack(order + "I", content[4:8])[0]
    count = struct.unpack(order + "H", content[at : at + 2])[0]
    tags = {}
    for entry in range(count):
        tag, kind, number = struct.unpack(
            order + "HHI", content[at + 2 + 12 * entry : at + 10 + 12 * entry]
        )
        field = content[at + 10 + 12 * entry : at + 14 + 12 * entry]
        letter, size = {1: ("B", 1), 2: ("s", 1), 3: ("H", 2), 4: ("I", 4), 5: ("II", 8)}[kind]
        if size * number > 4:
            start = struct.unpack(order + "I", field)[0]
            field = content[start : start + size * number]
        if kind == 2:
            tags[tag] = field[:number].rstrip(b"\0").decode()
        else:
            tags[tag] = struct.unpack(order + letter * number, field[: size * number])
    width, height = tags[256][0], tags[257][0]
    assert tags[259] == (8,) and tags[262] == (2,) and tags[277] == (3,) and tags[317] == (2,), tags
    data = b"".join(
        zlib.decompress(content[start : start + size]) for start, size in zip(tags[273], tags[279])
    )
    return (
        numpy.cumsum(
            numpy.frombuffer(data, numpy.uint8).reshape(height, width, 3), axis=1, dtype=numpy.uint8
        ),
        tags,
    )
