#!/usr/bin/env python3
"""Writes the seeds of the mesh fuzzers beside itself: one small file per feature of the formats."""
import pathlib
import struct

HERE = pathlib.Path(__file__).resolve().parent


def ply(name, order, elements, rows):
    """elements: header lines; rows: (struct format, values) in file order."""
    kind = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\nformat {kind} 1.0\ncomment seed\n" + "\n".join(elements) + "\nend_header\n"
    if order:
        body = b"".join(struct.pack(order + layout, *values) for layout, values in rows)
    else:
        body = "\n".join(" ".join(str(v) for v in values) for _, values in rows).encode() + b"\n"
    (HERE / "ply" / name).write_bytes(head.encode() + body)


XYZ = ["property float x", "property float y", "property float z"]
SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.5)]
for tag, order in (("ascii", ""), ("little", "<"), ("big", ">")):
    ply(f"{tag}_quad.ply", order, ["element vertex 4", *XYZ, "element face 1", "property list uchar int vertex_indices"],
        [("3f", p) for p in SQUARE] + [("B4i", (4, 0, 1, 2, 3))])
    ply(f"{tag}_colour_uv.ply", order,
        ["comment TextureFile a.png", "element vertex 4", "property double x", "property double y", "property short z",
         "property ushort red", "property ushort green", "property ushort blue", "property ushort alpha",
         "element face 1", "property list uchar uint vertex_index", "property list uchar float texcoord", "property int texnumber"],
        [("2dh4H", (*p[:2], int(p[2] * 2), 65535, 257, 0, 40000)) for p in SQUARE]
        + [("B3IB6fi", (3, 0, 1, 2, 6, 0, 0, .5, 0, .5, .5, 0))])
    ply(f"{tag}_strips.ply", order,
        ["element other 1", "property list uchar short junk", "element vertex 4", *XYZ, "property float s", "property float t",
         "property float red", "property float green", "property float blue", "element tristrips 1",
         "property list int int vertex_indices"],
        [("B2h", (2, 7, 8))] + [("8f", (*p, p[0], p[1], 1, .5, 0)) for p in SQUARE] + [("i6i", (6, 0, 1, 2, -1, 3, 1))])
    ply(f"{tag}_face_colour.ply", order,
        ["element vertex 4", *XYZ, "element face 2", "property list uchar int vertex_indices", "property uchar red",
         "property uchar green", "property uchar blue"],
        [("3f", p) for p in SQUARE] + [("B3i3B", (3, 0, 1, 2, 9, 8, 7)), ("B3i3B", (3, 0, 2, 3, 255, 0, 1))])

OBJ = {
    "plain.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "uv.obj": "mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/3/1\nf 1//1 3//1 2//1\n",
    "negative.obj": "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf -3 \\\r\n -2 -1\r\nl 1 2\r\n",
    "concave.obj": "v 0 0 5\nv 3 0 5\nv 3 1 5\nv 1 1 5\nv 1 3 5\nv 0 3 5\nf 6 5 4 3 2 1\n",
    "colour.obj": "g a\nv 0 0 0 16 19 15\nv 1e-3 +1.5 .25 1 .5 0\nv 0 1 -0 0 0 0 1\nv nan 0 inf\nf 1 2 3 # c\n",
}
for name, text in OBJ.items():
    (HERE / "obj" / name).write_bytes(text.encode())


def planes(values, size):
    """A column as the stored geometry has it: zigzag differences, byte plane by byte plane."""
    mask, before, codes = (1 << 8 * size) - 1, 0, []
    for value in values:
        step = (value - before) & mask
        codes.append(((step << 1) ^ (mask if step >> (8 * size - 1) else 0)) & mask)
        before = value
    return b"".join(bytes((code >> 8 * plane) & 255 for code in codes) for plane in range(size))


def bits(values, layout, whole):
    return [struct.unpack(whole, struct.pack(layout, v))[0] for v in values]


content = struct.pack("<3Q3d", 4, 4, 6, 0.5, 0.5, 0)
for axis in range(3):
    content += planes(bits([p[axis] for p in SQUARE], "<d", "<Q"), 8)
content += planes([0x1FF << 20] * 4, 4)
for axis in range(2):
    content += planes(bits([p[axis] for p in SQUARE], "<f", "<I"), 4)
content += planes([0xFFCFD3D6] * 4, 4) + planes([0, 1, 2, 3], 4) + planes([0, 1, 2, 0, 2, 3], 4)
(HERE / "geometry").mkdir(exist_ok=True)
(HERE / "geometry" / "square").write_bytes(content)
