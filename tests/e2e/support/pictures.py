"""Writes and reads PNG images, and writes TGA and BMP images."""
import struct
import zlib


def png(width, height, color):
    """Returns an image with the colors of `color(x, y)`: (r, g, b), (r, g, b, a) or (gray, a)."""
    kind = {2: 4, 3: 2, 4: 6}[len(color(0, 0))]
    rows = b"".join(
        b"\0" + b"".join(bytes(color(x, y)) for x in range(width)) for y in range(height)
    )

    def part(name, data):
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    head = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + part(b"IHDR", head)
        + part(b"IDAT", zlib.compress(rows))
        + part(b"IEND", b"")
    )


def tga(width, height, color, packed=False):
    """Returns an image with colors (r, g, b). With `packed`, each pixel is a separate run."""
    kind = 10 if packed else 2
    body = b"".join(
        (b"\x80" if packed else b"") + bytes(reversed(color(x, y)))
        for y in reversed(range(height))
        for x in range(width)
    )
    return struct.pack("<BBB5sHHHHBB", 0, 0, kind, bytes(5), 0, 0, width, height, 24, 0) + body


def bmp(width, height, color):
    """Returns an image with colors (r, g, b)."""
    pad = bytes(-3 * width % 4)
    rows = b"".join(
        b"".join(bytes(reversed(color(x, y))) for x in range(width)) + pad
        for y in reversed(range(height))
    )
    return (
        b"BM"
        + struct.pack(
            "<IIIIiiHHIIiiII",
            54 + len(rows),
            0,
            54,
            40,
            width,
            height,
            1,
            24,
            0,
            len(rows),
            0,
            0,
            0,
            0,
        )
        + rows
    )


def pixels(picture, shown=slice(0, 3)):
    """Returns rows of (r, g, b) of a PNG from the server, or of the given channels."""
    width, height, _, kind = struct.unpack(">IIBB", picture[16:26])
    channels = {2: 3, 6: 4}[kind]
    at, data = 8, b""
    while at < len(picture):
        size, name = struct.unpack(">I4s", picture[at : at + 8])
        if name == b"IDAT":
            data += picture[at + 8 : at + 8 + size]
        at += size + 12
    raw, rows, before = zlib.decompress(data), [], bytes(width * channels)
    for y in range(height):
        start = y * (width * channels + 1)
        line, out = raw[start + 1 : start + 1 + width * channels], bytearray(width * channels)
        for i, value in enumerate(line):
            a = out[i - channels] if i >= channels else 0
            b, c = before[i], before[i - channels] if i >= channels else 0
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            out[i] = (value + [0, a, b, (a + b) // 2, nearest][raw[start]]) & 255
        rows.append([tuple(out[x : x + channels][shown]) for x in range(0, len(out), channels)])
        before = bytes(out)
    return rows
