"""Generated maps: shapefiles and TIFF files, byte by byte."""
import io
import struct
import zipfile
import zlib


def square(x, y, size):
    return [(x, y), (x, y + size), (x + size, y + size), (x + size, y), (x, y)]


def shp(polygons):
    """Returns a shapefile. Each polygon is a list of rings."""
    body = b""
    for number, rings in enumerate(polygons):
        points = [point for ring in rings for point in ring]
        xs, ys = [x for x, _ in points], [y for _, y in points]
        starts, begin = b"", 0
        for ring in rings:
            starts += struct.pack("<i", begin)
            begin += len(ring)
        record = (
            struct.pack("<i4d2i", 5, min(xs), min(ys), max(xs), max(ys), len(rings), len(points))
            + starts
        )
        record += b"".join(struct.pack("<2d", *point) for point in points)
        body += struct.pack(">2i", number + 1, len(record) // 2) + record
    head = struct.pack(">i20xi", 9994, (100 + len(body)) // 2) + struct.pack("<2i64x", 1000, 5)
    return head + body


def dbf(fields):
    """Returns an attribute table. A field is (name, type, width, values as text)."""
    rows = len(fields[0][3])
    head = b"".join(
        name.encode()[:10].ljust(11, b"\0")
        + kind.encode()
        + b"\0" * 4
        + bytes([width, 0])
        + b"\0" * 14
        for name, kind, width, _ in fields
    )
    out = (
        struct.pack(
            "<4BIHH20x", 3, 124, 1, 1, rows, 33 + len(head), 1 + sum(field[2] for field in fields)
        )
        + head
        + b"\r"
    )
    for row in range(rows):
        out += b" "
        for _, kind, width, values in fields:
            text = values[row].encode()
            out += text.rjust(width) if kind == "N" else text.ljust(width)
    return out + b"\x1a"


def packed(**files):
    """Returns a zip file. The last `_` in a name stands for the dot."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(".".join(name.rsplit("_", 1)), content)
    return out.getvalue()


def form(**files):
    """Returns (body, headers) of a form with files. The last `_` in a name stands for the dot."""
    body = b"".join(
        b'--XyZ\r\nContent-Disposition: form-data; name="file"; filename="%s"\r\n\r\n%s\r\n'
        % (".".join(name.rsplit("_", 1)).encode(), content)
        for name, content in files.items()
    )
    return body + b"--XyZ--\r\n", {"Content-Type": "multipart/form-data; boundary=XyZ"}


def tiff(
    width,
    height,
    value,
    kind="f",
    samples=1,
    nodata=None,
    scale=None,
    origin=None,
    epsg=None,
    deflated=False,
):
    """Returns a TIFF, row by row from the top. `kind` is a struct letter. `value(x, y)` is a
    number, or a number for each sample."""
    bits = 8 * struct.calcsize(kind)
    pixels = b""
    for y in range(height):
        for x in range(width):
            numbers = value(x, y)
            pixels += struct.pack(f"<{samples}{kind}", *(numbers if samples > 1 else (numbers,)))
    if deflated:
        pixels = zlib.compress(pixels)
    tags = [
        (256, 4, [width]),
        (257, 4, [height]),
        (258, 3, [bits] * samples),
        (259, 3, [8 if deflated else 1]),
        (262, 3, [2 if samples > 2 else 1]),
        (273, 4, [0]),
        (277, 3, [samples]),
        (278, 4, [height]),
        (279, 4, [len(pixels)]),
        (284, 3, [1]),
    ]
    if samples == 4:
        tags.append((338, 3, [2]))
    tags.append((339, 3, [3 if kind in "fd" else 2 if kind in "bhi" else 1] * samples))
    if scale:
        tags += [(33550, 12, [scale, scale, 0.0]), (33922, 12, [0.0, 0.0, 0.0, *origin, 0.0])]
    if epsg:
        tags.append((34735, 3, [1, 1, 0, 1, 3072, 0, 1, epsg]))
    if nodata is not None:
        tags.append((42113, 2, nodata))
    at, held, entries = 8 + 2 + 12 * len(tags) + 4, b"", []
    for tag, form_of, values in tags:
        data = (
            (values.encode() + b"\0")
            if form_of == 2
            else struct.pack("<%d%s" % (len(values), {3: "H", 4: "I", 12: "d"}[form_of]), *values)
        )
        count = len(data) if form_of == 2 else len(values)
        if len(data) > 4:
            place = struct.pack("<I", at + len(held))
            held += data + b"\0" * (len(data) % 2)
            data = place
        entries.append([tag, form_of, count, data.ljust(4, b"\0")])
    for entry in entries:
        if entry[0] == 273:
            entry[3] = struct.pack("<I", at + len(held))
    return (
        b"II*\0"
        + struct.pack("<IH", 8, len(tags))
        + b"".join(struct.pack("<HHI4s", *entry) for entry in entries)
        + struct.pack("<I", 0)
        + held
        + pixels
    )
