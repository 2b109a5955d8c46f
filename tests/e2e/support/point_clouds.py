"""Point clouds as PLY and LAS files, written from the formats' specifications."""
import math
import struct


def sphere_points(count, radius=1.0, center=(0.0, 0.0, 0.0), above=-1.0):
    """Returns evenly spread points of a sphere, with z / radius of at least `above`."""
    golden = math.pi * (3 - math.sqrt(5))
    points = []
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        if z < above:
            continue
        r = math.sqrt(1 - z * z)
        unit = (r * math.cos(golden * i), r * math.sin(golden * i), z)
        points.append(tuple(c + radius * u for c, u in zip(center, unit)))
    return points


def ply_points(points, colors=None):
    channels = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty double x\n"
        f"property double y\nproperty double z\n{channels if colors else ''}end_header\n"
    )
    return head.encode() + b"".join(
        struct.pack("<3d", *point) + (bytes(colors[i]) if colors else b"")
        for i, point in enumerate(points)
    )


def las_points(points, epsg=None, compressed=False):
    """Returns LAS 1.2 with the point format 2 and millimeters."""
    keys = b""
    if epsg:
        content = struct.pack("<12H", 1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, epsg)
        keys = struct.pack("<H16sHH32s", 0, b"LASF_Projection", 34735, len(content), b"" * 32)
        keys += content
    origin = tuple(min(point[k] for point in points) for k in range(3))
    header = bytearray(227)
    header[0:4] = b"LASF"
    struct.pack_into("<BB", header, 24, 1, 2)
    struct.pack_into("<HII", header, 94, 227, 227 + len(keys), 1 if keys else 0)
    struct.pack_into("<BHI", header, 104, 2 | (0x80 if compressed else 0), 26, len(points))
    struct.pack_into("<6d", header, 131, 0.001, 0.001, 0.001, *origin)
    records = b"".join(
        struct.pack(
            "<3iHBBbBH3H",
            *(round((point[k] - origin[k]) * 1000) for k in range(3)),
            0,
            0,
            2,
            0,
            0,
            0,
            *(65535, 0, 0),
        )
        for point in points
    )
    return bytes(header) + keys + records
