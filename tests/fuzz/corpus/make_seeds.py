#!/usr/bin/env python3
"""Writes the seeds of the fuzzers to the folder of this script: one small file for each feature of
the formats."""
import base64
import io
import json
import pathlib
import struct
import sys
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "e2e"))
from support import maps  # noqa: E402
from support.pictures import bmp, png, tga  # noqa: E402


def ply(name, order, elements, rows):
    """Writes a PLY file. elements: header lines; rows: (struct format, values) in file order."""
    kind = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\nformat {kind} 1.0\ncomment seed\n" + "\n".join(elements) + "\nend_header\n"
    if order:
        body = b"".join(struct.pack(order + layout, *values) for layout, values in rows)
    else:
        body = "\n".join(" ".join(str(v) for v in values) for _, values in rows).encode() + b"\n"
    (HERE / "ply" / name).write_bytes(head.encode() + body)


# Pictures of 8 × 8 pixels: a gray JPEG, and a progressive color JPEG with 4:2:0 subsampling.
GREY_JPEG = (
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDABsSFBcUERsXFhceHBsgKEIrKCUlKFE6PTBCYFVlZF9VXVtqeJmBanGQc1tdhbWGkJ6jq62rZ4C8ybqmx5moq6T/"
    "wAALCAAIAAgBAREA/8QAFAABAAAAAAAAAAAAAAAAAAAAAf/EABkQAQEAAwEAAAAAAAAAAAAAAAECAAMRBf/aAAgBAQAAPwA8PXMSXaTMnVXgGf/Z"
)
PROGRESSIVE_JPEG = (
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDABsSFBcUERsXFhceHBsgKEIrKCUlKFE6PTBCYFVlZF9VXVtqeJmBanGQc1tdhbWGkJ6jq62rZ4C8ybqmx5moq6T/"
    "2wBDARweHigjKE4rK06kbl1upKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKSkpKT/wgARCAAIAAgDASIAAhEBAxEB/8QA"
    "FAABAAAAAAAAAAAAAAAAAAAAAP/EABQBAQAAAAAAAAAAAAAAAAAAAAL/2gAMAwEAAhADEAAAAQK//8QAFhAAAwAAAAAAAAAAAAAAAAAAAQMh/9oACAEBAAEF"
    "Akwf/8QAFhEBAQEAAAAAAAAAAAAAAAAAAgAR/9oACAEDAQE/ASdv/8QAFREBAQAAAAAAAAAAAAAAAAAAAAH/2gAIAQIBAT8Br//EABUQAQEAAAAAAAAAAAAA"
    "AAAAAAAR/9oACAEBAAY/Aq//xAAXEAEBAQEAAAAAAAAAAAAAAAABEQAx/9oACAEBAAE/ISUcC7//2gAMAwEAAgADAAAAEP8A/8QAFhEBAQEAAAAAAAAAAAAA"
    "AAAAAQAh/9oACAEDAQE/ECG3/8QAGBEAAgMAAAAAAAAAAAAAAAAAAAERQZH/2gAIAQIBAT8QV04w/8QAGBABAAMBAAAAAAAAAAAAAAAAAQARIVH/2gAIAQEA"
    "AT8QV42jwJ//2Q=="
)
# More pictures of 8 × 8 pixels: a lossless WebP, a lossy WebP and a CMYK JPEG.
LOSSLESS_WEBP = (
    "UklGRjgAAABXRUJQVlA4TCsAAAAvB8ABEJkyRPQ/NhHR/zCYadsmSMof6K4x8HhMgkAgSXaqZScgK2oYwv0PAA=="
)
LOSSY_WEBP = (
    "UklGRnQAAABXRUJQVlA4WAoAAAAQAAAABwAABwAAQUxQSAwAAAABD/Cy/4iI0IOI/gdWUDggQgAAABACAJ0BKggACAACgEIlsAJ0ugACuX1cSgAA/vii8/UPrt/1+zf/GI"
    "MK/4Ydy//HJb/r/cdq8J4+m55FNvizMtAAAA=="
)
CMYK_JPEG = (
    "/9j/7gAOQWRvYmUAZAAAAAAC/9sAQwAGBAUGBQQGBgUGBwcGCAoQCgoJCQoUDg8MEBcUGBgXFBYWGh0lHxobIxwWFiAsICMmJykqKRkfLTAtKDAlKCko/9sAQwEHBwcKCA"
    "oTCgoTKBoWGigoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgo/8AAFAgACAAIBAERAAIRAQMRAQQRAP/EAB8AAAEFAQEBAQEBAAAA"
    "AAAAAAABAgMEBQYHCAkKC//EALUQAAIBAwMCBAMFBQQEAAABfQECAwAEEQUSITFBBhNRYQcicRQygZGhCCNCscEVUtHwJDNicoIJChYXGBkaJSYnKCkqNDU2Nzg5OkNERU"
    "ZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6g4SFhoeIiYqSk5SVlpeYmZqio6Slpqeoqaqys7S1tre4ubrCw8TFxsfIycrS09TV1tfY2drh4uPk5ebn6Onq8fLz9PX2"
    "9/j5+v/EAB8BAAMBAQEBAQEBAQEAAAAAAAABAgMEBQYHCAkKC//EALURAAIBAgQEAwQHBQQEAAECdwABAgMRBAUhMQYSQVEHYXETIjKBCBRCkaGxwQkjM1LwFWJy0QoWJD"
    "ThJfEXGBkaJicoKSo1Njc4OTpDREVGR0hJSlNUVVZXWFlaY2RlZmdoaWpzdHV2d3h5eoKDhIWGh4iJipKTlJWWl5iZmqKjpKWmp6ipqrKztLW2t7i5usLDxMXGx8jJytLT"
    "1NXW19jZ2uLj5OXm5+jp6vLz9PX29/j5+v/aAA4EAQACEQMRBAAAPwDrPFPxB+/++/Wvt8Fkvkc3E/D3xaHrn7Pn/Im3v/YQf/0XHX//2Q=="
)
XYZ = ["property float x", "property float y", "property float z"]
SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.5)]
for tag, order in (("ascii", ""), ("little", "<"), ("big", ">")):
    ply(
        f"{tag}_quad.ply",
        order,
        ["element vertex 4", *XYZ, "element face 1", "property list uchar int vertex_indices"],
        [("3f", p) for p in SQUARE] + [("B4i", (4, 0, 1, 2, 3))],
    )
    ply(
        f"{tag}_colour_uv.ply",
        order,
        [
            "comment TextureFile a.png",
            "element vertex 4",
            "property double x",
            "property double y",
            "property short z",
            "property ushort red",
            "property ushort green",
            "property ushort blue",
            "property ushort alpha",
            "element face 1",
            "property list uchar uint vertex_index",
            "property list uchar float texcoord",
            "property int texnumber",
        ],
        [("2dh4H", (*p[:2], int(p[2] * 2), 65535, 257, 0, 40000)) for p in SQUARE]
        + [("B3IB6fi", (3, 0, 1, 2, 6, 0, 0, 0.5, 0, 0.5, 0.5, 0))],
    )
    ply(
        f"{tag}_strips.ply",
        order,
        [
            "element other 1",
            "property list uchar short junk",
            "element vertex 4",
            *XYZ,
            "property float s",
            "property float t",
            "property float red",
            "property float green",
            "property float blue",
            "element tristrips 1",
            "property list int int vertex_indices",
        ],
        [("B2h", (2, 7, 8))]
        + [("8f", (*p, p[0], p[1], 1, 0.5, 0)) for p in SQUARE]
        + [("i6i", (6, 0, 1, 2, -1, 3, 1))],
    )
    ply(
        f"{tag}_face_colour.ply",
        order,
        [
            "element vertex 4",
            *XYZ,
            "element face 2",
            "property list uchar int vertex_indices",
            "property uchar red",
            "property uchar green",
            "property uchar blue",
        ],
        [("3f", p) for p in SQUARE]
        + [("B3i3B", (3, 0, 1, 2, 9, 8, 7)), ("B3i3B", (3, 0, 2, 3, 255, 0, 1))],
    )

ply(
    "ascii_surplus.ply",
    "",
    ["element vertex 4", *XYZ, "element face 1", "property list uchar int vertex_indices"],
    [("", (*p, 255)) for p in SQUARE] + [("", (4, 0, 1, 2, 3, 9, 1))],
)

OBJ = {
    "plain.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "uv.obj": "mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/3/1\nf 1//1 3//1 2//1\n",
    "negative.obj": "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf -3 \\\r\n -2 -1\r\nl 1 2\r\n",
    "concave.obj": "v 0 0 5\nv 3 0 5\nv 3 1 5\nv 1 1 5\nv 1 3 5\nv 0 3 5\nf 6 5 4 3 2 1\n",
    "colour.obj": "g a\nv 0 0 0 16 19 15\nv 1e-3 +1.5 .25 1 .5 0\nv 0 1 -0 0 0 0 1\nv nan 0 inf\nf 1 2 3 # c\n",
}
OBJ["absent.obj"] = "v 0 0 0\rv 1 0 0\rv 0 1 0\rvn 0 0 1\rf 1/1/1 2/2/2 3/3/-2\r"
for name, text in OBJ.items():
    (HERE / "obj" / name).write_bytes(text.encode())
for name, encoding in (("little_utf16.obj", "utf-16-le"), ("big_utf16.obj", "utf-16-be")):
    (HERE / "obj" / name).write_bytes(("\ufeff# \U0001f3fa\n" + OBJ["plain.obj"]).encode(encoding))


def planes(values, size):
    """A column in the format of stored geometry: zigzag differences, byte plane by byte plane."""
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

facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
STL = {
    "binary.stl": b"solid binary".ljust(80) + struct.pack("<I", 2) + 2 * facet,
    "text.stl": b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e0 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n",
    "capitals.stl": b"\xef\xbb\xbf# made\rSOLID A\rFACET NORMAL 0 0 1\rOUTER LOOP\rVERTEX 0 0 0 // v\rVERTEX 1 0 0\rVERTEX 0 1 0\rENDLOOP\rENDFACET\rENDSOLID\r",
}


def gltf(name, change, binary, glb=True):
    """A square of two triangles; `change` edits the JSON."""
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1, 2, 3]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": len(binary)}],
    }
    change(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    if glb:
        text = (
            b"glTF"
            + struct.pack("<2I", 2, 28 + len(text) + len(binary))
            + struct.pack("<I", len(text))
            + b"JSON"
            + text
            + struct.pack("<I", len(binary))
            + b"BIN\0"
            + binary
        )
    GLTF[name] = text


GLTF = {}
square = b"".join(struct.pack("<3f", *p) for p in SQUARE) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
uvs = struct.pack("<8H", 0, 0, 65535, 0, 65535, 65535, 0, 65535)


def rich(d):
    d["bufferViews"] += [{"buffer": 0, "byteOffset": 60, "byteLength": 16, "byteStride": 4}]
    d["accessors"] += [
        {"bufferView": 2, "componentType": 5123, "normalized": True, "count": 4, "type": "VEC2"}
    ]
    d["meshes"][0]["primitives"][0] |= {
        "material": 0,
        "attributes": {"POSITION": 0, "TEXCOORD_1": 2, "COLOR_0": 0},
    }
    d["materials"] = [
        {
            "pbrMetallicRoughness": {
                "baseColorFactor": [1, 0.5, 0, 1],
                "baseColorTexture": {
                    "index": 0,
                    "texCoord": 1,
                    "extensions": {
                        "KHR_texture_transform": {
                            "offset": [0, 0.5],
                            "scale": [2, 2],
                            "rotation": 1,
                        }
                    },
                },
            }
        }
    ]
    d["textures"] = [{"source": 0, "sampler": 0}]
    d["samplers"] = [{"wrapS": 33071, "wrapT": 33648}]
    d["images"] = [{"uri": "data:image/png;base64,iVBORw0KGgo="}]
    d["nodes"] = [
        {"mesh": 0, "scale": [-1, 1, 1], "children": [1]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 5, 5, 1]},
    ]
    d["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": 1, "componentType": 5123},
        "values": {"bufferView": 0},
    }


def compressed(d):
    d["bufferViews"][1]["extensions"] = {
        "EXT_meshopt_compression": {
            "buffer": 0,
            "byteOffset": 60,
            "byteLength": 24,
            "byteStride": 2,
            "count": 6,
            "mode": "TRIANGLES",
        }
    }
    d["extensionsRequired"] = ["EXT_meshopt_compression"]


def draco(d):
    d["meshes"][0]["primitives"][0]["extensions"] = {
        "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}
    }


def beside(d):
    d["buffers"][0]["uri"] = "a.bin"
    d["meshes"][0]["primitives"][0]["mode"] = 5


gltf("plain.glb", lambda d: None, square)
gltf("rich.glb", rich, square + uvs)
gltf("meshopt.glb", compressed, square + b"\xe1\xf0\x10\xfe\x10" + bytes(16) + b"\x00\x76\x87")
gltf("draco.glb", draco, b"DRACO\x02\x02\x01\x01\x00\x00" + square[11:])
gltf("beside.gltf", beside, square, glb=False)


def instanced(d):
    d["bufferViews"] += [
        {"buffer": 0, "byteOffset": 60, "byteLength": 24},
        {"buffer": 0, "byteOffset": 84, "byteLength": 16},
    ]
    d["accessors"] += [
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"},
        {"bufferView": 3, "componentType": 5122, "normalized": True, "count": 2, "type": "VEC4"},
    ]
    d["nodes"][0]["extensions"] = {
        "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2, "ROTATION": 3, "SCALE": 2}}
    }
    d["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]


def second_version(d):
    """Eight vertices of 12 bytes, all zero except for a step: control modes 0 and 2, channels of
    bytes, shorts and words."""
    d["accessors"][0]["count"] = 8
    d["bufferViews"][0] |= {
        "byteLength": 96,
        "byteStride": 12,
        "buffer": 1,
        "extensions": {
            "KHR_meshopt_compression": {
                "buffer": 0,
                "byteOffset": 60,
                "byteLength": len(SECOND),
                "byteStride": 12,
                "count": 8,
                "mode": "ATTRIBUTES",
                "filter": "EXPONENTIAL",
            }
        },
    }
    d["extensionsRequired"] = ["KHR_meshopt_compression"]
    d["textures"] = [{}]
    d["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    d["meshes"][0]["primitives"][0]["material"] = 0


SECOND = (
    b"\xa1"
    + bytes((0b10101001, 0b10101000, 0b10101011))
    + bytes((1, 0x55, 0xAA))
    + bytes((1, 0xF0, 0x0F, 9, 9, 9, 9, 9, 9, 9, 9))
    + bytes(range(8))
    + bytes(9)
    + bytes(12)
    + bytes((0, 1, 0x42))
)
gltf(
    "instanced.glb",
    instanced,
    square
    + struct.pack("<6f", 1, 2, 3, 4, 5, 6)
    + struct.pack("<8h", 0, 0, 0, 32767, 0, 0, 23170, 23170),
)
gltf("meshopt_second.glb", second_version, square + SECOND)
MTL = {
    "options.mtl": b"newmtl m\r\nKd .5 .25 0\nmap_Kd -s 2 2 1 -o .5 -clamp on a.png\nnewmtl n o\nd .5\nmap_Kd -mm 0 1 \\\n skin.<UDIM>.jpg\n",
    "plain.mtl": b"newmtl m\nKd 1 0 0\nTr 0.5\nmap_Kd a.png\n",
    "carriage.mtl": "\ufeffnewmtl m\rKd 1 0 0\rmap_Kd a.png\r".encode("utf-16-le"),
    "picture.jpg": b"\xff\xd8\xff\xe0\x00\x10JFIF\x00\x01",
}
ZIP = {}
for method, tag in ((zipfile.ZIP_STORED, "stored"), (zipfile.ZIP_DEFLATED, "deflated")):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, content in (
            ("../a/pot.obj", OBJ["uv.obj"]),
            ("a/a.mtl", MTL["plain.mtl"]),
            ("readme.txt", b"text"),
        ):
            archive.writestr(zipfile.ZipInfo(name), content, method)
    ZIP[tag + ".zip"] = packed.getvalue()
SHP = maps.shp([[maps.square(0, 0, 10), maps.square(2, 2, 3)], [maps.square(20, 0, 5)]])
AREAS = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"id": 1, "what": "salt", "seen": True},
            "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4]]]},
        },
        {
            "type": "Feature",
            "properties": None,
            "geometry": {
                "type": "MultiPolygon",
                "coordinates": [[[[0, 0, 1], [4, 0, 1], [4, 4, 1]]]],
            },
        },
    ],
}
MAP = {
    "bare.shp": SHP,
    "table.shp": SHP
    + maps.dbf(
        [
            ("ID", "N", 6, ["1", "-2.5"]),
            ("WHAT", "C", 8, ["salt", "Gr\xfcn"]),
            ("SEEN", "L", 1, ["T", "n"]),
        ]
    ),
    "numbers.tif": maps.tiff(
        4, 3, lambda x, y: x - y / 2, nodata="-9999", scale=0.5, origin=(10, 20), epsg=25830
    ),
    "bands.tif": maps.tiff(3, 2, lambda x, y: (x, y), kind="h", samples=2),
    "colours.tif": maps.tiff(3, 2, lambda x, y: (255, x, y, 255 * (x > 0)), kind="B", samples=4),
    "areas.geojson": json.dumps(AREAS).encode(),
}
FORM_TYPE = b"multipart/form-data; boundary=XyZ\n"
FORM = {
    "files": FORM_TYPE
    + maps.form(**{"scan/a_obj": b"v 0 0 0", "scan/../b_mtl": b"", "c_png": b"\r\n--Xy\r\n"})[0],
    "field": b'multipart/form-data; charset=x; boundary="a b"\n--a b\r\n\r\nno head\r\n--a b\r\ncontent-disposition: form-data; '
    b'name="f; filename=x"; filename="C:\\d\\e;.ply"; size=1\r\nX: y\r\n\r\nply\r\n--a b--\r\n',
    "twice": FORM_TYPE
    + maps.form(a_obj=b"1")[0].replace(
        b"--XyZ--", b"--XyZ\r\nContent-Disposition: a;filename=a.obj\r\n\r\n\r\n--XyZ--"
    ),
}
TEXT = {
    "target": b"/api/v1/models/a%20b/layers/%E2%98%83?limit=10&offset=20&name=M%C3%BCll+1&empty",
    "cookie": b'theme=dark; strata_session="0123456789abcdef"; other=',
    "origins": b"https://site.example:8443site.example:8443",
    "point": b"POINT Z(1.5 -2e3 +.25)",
    "uuid": b"123e4567-e89b-12d3-a456-426614174000",
    "world": b"0.5\n0\n0\n-0.5\n4000000.25\n8e5\n",
    "colors": b'{"#c02020": 1, "#2040c0ff": 2.5}',
    "readings_comma.csv": b"x,y,z,value\n1,2,3,4\n-1e3,+.5,0,1e-9\n",
    "readings_quoted.csv": b'\xef\xbb\xbf"Value";"Z";"note";"Y";"X"\r\n"1";2;"a";3;4\r\n\r\n5;6;;7;8',
    "range": b"bytes=10-500",
    "accept": b"text/csv;q=0.5, application/json, */*;q=0.1",
    "traceparent": b"00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01",
    "time": b"2026-11-28T09:30:15.250+01:00",
    "levels": b"warning,store=debug,net=info",
    "pattern": b"{code}_{view}-{n}.jpgWall-03_west_front-12.jpg",
    "lines": b"3 LINESTRING Z (0 0 1, 2.5 0 1)",
    "points": b"3 POINT Z (1 2 3); 4 POINT Z (-1e3 .5 0)",
    "url": b"http://127.0.0.1:8080/a",
}
EXPRESSION = {
    "condition": b'0.3 <= depth * 2 and not (valid("2020 survey") or salt-2 <> 4e-1)',
    "number": b"if(a > 1 or true, max(a, -b, .5), abs(a - b / 3)) + min(a, 2)",
    "names": b'A == "and" AND b_1-c != 2',
    "focal": b"focal_mean(a - b, 2.5) > focal_max(a, 1e3) or focal_variety(a.b, 5) = focal_min(3, 0) or hot_spot(a, 2) > 1.96 and hot_spot_chance(a, 2, 999) < 0.05 and watershed(a, 0.5) = run_off(b)",
    "lines": b"hysteresis(valley(a - b, 2.5) + ridge(a.b, 1e3), -0.1, 0.3) or not hysteresis(a, 0, 0)",
    "cleanups": b"majority(sieve(a, 4) + fill_holes(b, 1e3), 2) > 1 or closing(opening(sieve(a > 1, 3), 2), 5) and fill_holes(b is null, 4)",
    "interpolated": b"interpolated(round(a * 10), 80) + 2 * interpolation_error(a.b, 2.5) > focal_mean(c, 1)",
    "surface": b"within(distance(salt) < 5 or a.b, 2.5) and nearest(a.c, 1e3) + distance(valid(b)) > 1",
}
PICTURE = {
    "rgba.png": png(5, 3, lambda x, y: (40 * x, 80 * y, 9, 60 * x)),
    "rgb.png": png(2, 7, lambda x, y: (255 * x, 30 * y, 0)),
    "grey.jpg": base64.b64decode(GREY_JPEG),
    "progressive.jpg": base64.b64decode(PROGRESSIVE_JPEG),
    "cmyk.jpg": base64.b64decode(CMYK_JPEG),
    "lossless.webp": base64.b64decode(LOSSLESS_WEBP),
    "lossy.webp": base64.b64decode(LOSSY_WEBP),
    "rgb.bmp": bmp(5, 3, lambda x, y: (40 * x, 80 * y, 9)),
    "rgb.tga": tga(5, 3, lambda x, y: (40 * x, 80 * y, 9)),
    "packed.tga": tga(5, 3, lambda x, y: (40 * x, 80 * y, 9), packed=True),
    "grey.tif": maps.tiff(5, 3, lambda x, y: 40 * x + y, kind="B"),
    "deep.tif": maps.tiff(
        5, 3, lambda x, y: (9000 * x, 80 * y, 9), kind="H", samples=3, deflated=True
    ),
    "alpha.tif": maps.tiff(3, 2, lambda x, y: (255, x, y, 255 * (x > 0)), kind="B", samples=4),
    "numbers.tif": maps.tiff(3, 2, lambda x, y: x / 3),
}
# Exif with the orientation 6, in the byte order of Motorola, after the first marker of a JPEG.
EXIF = b"\xff\xe1\0\x22Exif\0\0MM\0*\0\0\0\x08\0\1\1\x12\0\3\0\0\0\1\0\6\0\0\0\0\0\0"
ATTACHMENT = {
    "rgba.png": PICTURE["rgba.png"],
    "progressive.jpg": PICTURE["progressive.jpg"],
    "turned.jpg": PICTURE["grey.jpg"][:2] + EXIF + PICTURE["grey.jpg"][2:],
    "lossy.webp": PICTURE["lossy.webp"],
    "grey.tif": PICTURE["grey.tif"],
    "report.pdf": b"%PDF-1.4\n1 0 obj\n<<>>\nendobj\ntrailer\n<<>>\n%%EOF\n",
    "page.html": b"<!DOCTYPE html><html><script>1</script></html>",
    "drawing.svg": b'<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg"/>',
    "notes.txt": "Risse in der Südwand\n".encode(),
    "parts.zip": b"PK\3\4" + bytes(26),
    "film.mp4": b"\0\0\0\x18ftypisom\0\0\2\0isommp42",
}
stripes = lambda x, y: (x, (y // 40) % 2)
numpy_head = b"{'descr': [('value', '<f4'), ('valid', '|b1')], 'fortran_order': False, 'shape': (128, 128), }\n"
RASTER = {  # a byte for the layer's type, then the file
    "u8.tif": b"\0" + maps.tiff(128, 128, stripes, kind="B", samples=2, deflated=True),
    "i16.tif": b"\4" + maps.tiff(128, 128, stripes, kind="h", samples=2, deflated=True),
    "f32.tif": b"\7" + maps.tiff(128, 128, stripes, kind="f", samples=2, deflated=True),
    "u8.png": b"\0" + png(128, 128, lambda x, y: (x, 255 * (y % 2))),
    "f32.npy": b"\7\x93NUMPY\1\0"
    + struct.pack("<H", len(numpy_head))
    + numpy_head
    + struct.pack("<fB", 1.5, 1),
}
REVISION = {
    "u8": b"\0\1\0\xff",
    "f32": b"\7" + struct.pack("<2f", 1, -2.5),
    "stored": b"\3\1\1(\xb5/\xfd\x20\x04\x21\0\0abcd",
}
CSV = {
    "comma": b'\xef\xbb\xbfkey,name\r\n1,"a ""b""\nc"\r\n\r\n2,\r\n',
    "semicolon": b"sep=;\nkey;depth\n1;3,5\n2;'=1+1",
    "tab": b'key\tname\r1\t"x"\r',
}
EDTF = {
    name: text.encode()
    for name, text in {
        "day": "1560-04-12?",
        "season": "2001-21~",
        "digits": "156X",
        "month": "1560-02-XX",
        "far": "Y-17000%",
        "range": "-0043~/0100-12?",
        "open": "../1560",
    }.items()
}
COLUMN_VALUE = {
    name: bytes((kind, flags)) + text.encode()
    for name, kind, flags, text in (
        ("text", 0, 0, '"\'=1+1"'),
        ("integer", 1, 1, "-42"),
        ("numeric", 2, 2, "3,5"),
        ("boolean", 3, 0, "Yes"),
        ("date", 4, 0, "2024-02-29"),
        ("timestamp", 5, 0, "2024-02-29 12:30:15.123-01:30"),
        ("period", 6, 0, "1560~/.."),
        ("choice", 7, 1, '"=b"'),
        ("url", 8, 0, "https://example.org/"),
        ("term", 9, 0, "4294967295"),
        ("relation", 10, 0, "[3, 1, 3]"),
        ("keys", 10, 1, "3; 1 2"),
    )
}
# The first byte selects the reader of fuzz_sign_on.cpp. The token is the example in RFC 7515, A.3.
SIGN_ON = {
    "token": b"\0eyJhbGciOiJFUzI1NiJ9.eyJpc3MiOiJqb2UiLA0KICJleHAiOjEzMDA4MTkzODAsDQogImh0dHA6Ly9leGFt"
    b"cGxlLmNvbS9pc19yb290Ijp0cnVlfQ.DtEhU3ljbEg8L38VWAfUAqOyKAM6-Xx-F4GawxaepmXFCgfTjDxw5djxLa8IS"
    b"lSApmWQxfKTUJqPP3-Kg6NU1Q",
    "keys": b'\1{"keys":[{"kty":"RSA","kid":"a","use":"sig","alg":"RS256","n":"AQAB","e":"AQAB"},'
    b'{"kty":"EC","crv":"P-256","x":"f83OJ3D2xF1Bg8vub9tLe1gHMzV76e8Tus9uPHvRVEU",'
    b'"y":"x_FEzRu9m36HLN_tue659LNpXW6pCyStikYjKIWI5a0"}]}',
    "configuration": b'\2{"providers":[{"id":"museum","name":"Museum","issuer":"https://a.example",'
    b'"client_id":"strata","accounts":{"claim":"/a/b","values":["c"]},"roles":{"claim":"r","map":'
    b'{"s":"curator"}},"groups":{"claim":"g","map":{"h":"Students"}}}]}',
}
PROVIDER = {  # the first byte selects the status of the replies, and each line is a reply
    "sign_in": b"\0"
    b'{"issuer":"https://a.example","authorization_endpoint":"https://a.example/auth",'
    b'"token_endpoint":"https://a.example/token","jwks_uri":"https://a.example/keys",'
    b'"token_endpoint_auth_methods_supported":["client_secret_post"]}\n'
    b'{"id_token":"eyJhbGciOiJFUzI1NiJ9.eyJpc3MiOiJqb2UifQ.AAAA","access_token":"b",'
    b'"token_type":"Bearer"}\n'
    b'{"keys":[{"kty":"EC","crv":"P-256","x":"f83OJ3D2xF1Bg8vub9tLe1gHMzV76e8Tus9uPHvRVEU",'
    b'"y":"x_FEzRu9m36HLN_tue659LNpXW6pCyStikYjKIWI5a0"}]}\n',
    "error": b'\1{"error":"invalid_grant","error_description":"expired"}',
    "claims": b'\0{"sub":"1","preferred_username":"ada","a":{"b":["c"]},"r":["s"],"g":"h"}',
}
STORED = {
    "list.xml": b'<?xml version="1.0"?><ListBucketResult><IsTruncated>true</IsTruncated><Contents>'
    b"<Key>site/" + b"ab/" * 2 + b"ab" * 32 + b"</Key><LastModified>2026-11-28T09:30:15.000Z"
    b"</LastModified><Size>12</Size></Contents></ListBucketResult>",
    "refused.xml": b"<Error><Code>AccessDenied</Code><Message>no</Message></Error>",
    "mark": b'{"format":1,"id":"123e4567-e89b-12d3-a456-426614174000","owner":"7/16384"}',
    "segment": b"000000010000000A000000FF",
    "backup_label": b"START WAL LOCATION: 0/2000060 (file 000000010000000000000002)\n",
    "bucket": b"museum/stratahttps://s3.example:9000",
    "manifest": b'{"format":1,"made":"2026-11-28T09:30:15.000Z","schema_version":70,'
    b'"postgresql":"15.1","dump":{"bytes":3,"sha256":"00"},"tables":{"public.edits":{"rows":1,'
    b'"digest":"1"}},"sequences":{"public.ids":2},"files":{"count":1,"bytes":2,"place":"/f"}}',
}
TERMS = {  # the first byte selects the format
    "turtle": b"\0@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n"
    b"@prefix t: <https://terms.example/stone/> .\n"
    b't:loss a skos:Concept ; skos:prefLabel "Loss"@en, "P\xc3\xa9rdida"@es .\n'
    b't:worn skos:notation "W1" ; skos:prefLabel "Worn" ; skos:broader t:loss .\n',
    "rdf_xml": b'\1<?xml version="1.0"?><!DOCTYPE rdf:RDF [<!ENTITY skos '
    b'"http://www.w3.org/2004/02/skos/core#">]>'
    b'<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:skos="&skos;">'
    b'<skos:Concept rdf:about="https://terms.example/loss"><skos:prefLabel xml:lang="en">Loss'
    b"</skos:prefLabel></skos:Concept></rdf:RDF>",
    "csv": b"\2code,parent,label,label-es,definition,uri,color,pattern\n"
    b"loss,,Loss,P\xc3\xa9rdida,Missing.,https://terms.example/loss,#C02,hatch\n"
    b"worn,loss,Worn,,,,,\n",
}
VERTICES = {  # the first byte selects the file
    "numbers.csv": b"\0quality\n1\n\n3,5\n",
    "scan.ply": b"\1ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    b"property float z\nproperty float quality\nend_header\n0 0 0 1\n1 0 0 nan\n0 1 0 3.5\n",
    "scan.obj": b"\1v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
}
RECORDS = {
    "comma.csv": b"key,text,integer,numeric,boolean,date,enumeration,period\n"
    b'1,"a ""b""",-3,1.5,true,2026-11-28,one,2026~\n,=1,,,no,,two,\n',
    "semicolon.csv": b"\xef\xbb\xbfkey;version;numeric;relation;line;point;url;timestamp\r\n"
    b"2;1;1,5;1 2;3 LINESTRING Z (0 0 1, 2.5 0 1);3 POINT Z (1 2 3);https://a.example;"
    b"2026-11-28T09:30:15Z\r\n",
}
PERSON = (
    b'{"session":"d3b07384-d9a0-4c9b-8f2e-6f1f7f0c1a03","name":"ada","color":"#d55e00",'
    b'"full_name":"Ada Lovelace","pointer":{"position":[1.5,-2,88],"radius":0.25},"leading":true,'
    b'"following":"6f9619ff-8b86-4d01-b42d-00cf4fc964ff","camera":{"view":['
    b"1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1" + b'],"projection":['
    b"1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1" + b'],"width":640,"height":480}}'
)
PRESENCE = {
    name: b'{"node":"6f9619ff-8b86-4d01-b42d-00cf4fc964ff","model":12,"part":0,"parts":1,"users":['
    + users
    + b"]}"
    for name, users in (("person", PERSON), ("empty", b""))
}
COLMAP_IMAGE = struct.pack("<I7dI", 1, 1, 0, 0, 0, 0, 0, 5, 1) + b"a.jpg\0" + struct.pack("<Q", 1)
POSES = {  # the first byte selects the names; a line of %% is between two files
    "colmap.txt": b"\0"
    b"1 OPENCV 40 30 35 35 20 15 -0.05 0.02 0.003 -0.002\n\n%%\n"
    b"1 0.9 0.1 0 0 0 0 5 1 a.jpg\n1 2 3\n",
    "colmap.bin": b"\1"
    + struct.pack("<QIiQQ12d", 1, 1, 6, 40, 30, 35, 35, 20, 15, 0.1, 0, 0, 0, 0, 0.1, 0, 0)
    + b"\n%%\n"
    + struct.pack("<Q", 1)
    + COLMAP_IMAGE
    + struct.pack("<ddQ", 1, 2, 3),
    "bundle.out": b"\0# Bundle file v0.3\n1 0\n35 -0.1 0.02\n1 0 0\n0 1 0\n0 0 1\n0 0 -5\n"
    b"\n%%\na.jpg 0 35\n",
    "metashape.xml": b'\0<document><chunk><sensors><sensor id="0"><calibration class="adjusted">'
    b'<resolution width="40" height="30"/><f>35</f><cx>1</cx><b1>.5</b1><k1>.1</k1><p1>.01</p1>'
    b'</calibration></sensor></sensors><components active_id="0"><component id="0"><transform>'
    b"<rotation>1 0 0 0 1 0 0 0 1</rotation><translation>1 2 3</translation><scale>2</scale>"
    b'</transform></component></components><cameras><group><camera sensor_id="0" label="a">'
    b"<transform>1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1</transform></camera></group></cameras>"
    b"<reference>LOCAL_CS[]</reference></chunk></document>",
    "cameras.csv": b"\0#cameras 1\n#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n"
    b"a.jpg,1,2,3,40,50,60,18,0.01,0,-0.2,0.05,0,0,0.001,0\n",
    "camera.xmp": b"\0<x:xmpmeta><rdf:RDF><rdf:Description "
    b'xcr:DistortionModel="division" xcr:FocalLength35mm="18" xcr:Position="1 2 3"><xcr:Rotation>'
    b"0 1 0 1 0 0 0 0 -1</xcr:Rotation><xcr:DistortionCoeficients>0.2 0 0 0 0 0"
    b"</xcr:DistortionCoeficients></rdf:Description></rdf:RDF></x:xmpmeta>",
}
BILL = {  # the first byte selects the reader
    "formula": b"\0(2 * 1,20 + 3.5\xc2\xb2) x 0,85 : 2 - 1^3=",
    "tender.x83": b'\1<GAEB xmlns="http://www.gaeb.de/GAEB_DA_XML/DA83/3.3"><PrjInfo><Cur>EUR</Cur>'
    b"</PrjInfo><Award><DP>83</DP><BoQ><BoQInfo><Name>B</Name></BoQInfo><BoQBody>"
    b'<BoQCtgy RNoPart="01"><LblTx><p><span>Stone</span></p></LblTx><BoQBody><Remark><p>Note</p>'
    b'</Remark><Itemlist><Item RNoPart="0010" RNoIndex="A"><Qty>1.5</Qty><QU>m2</QU><UP>2,5</UP>'
    b"<Description><CompleteText><DetailTxt><Text><p>Long<br/>text</p></Text></DetailTxt>"
    b"<OutlineText><OutlTxt><TextOutlTxt><p>Short</p></TextOutlTxt></OutlTxt></OutlineText>"
    b"</CompleteText></Description></Item></Itemlist></BoQBody></BoQCtgy></BoQBody></BoQ></Award>"
    b"</GAEB>",
}
for folder, seeds in (
    ("bill", BILL),
    ("poses", POSES),
    ("presence", PRESENCE),
    ("sign_on", SIGN_ON),
    ("provider", PROVIDER),
    ("stored", STORED),
    ("terms", TERMS),
    ("vertices", VERTICES),
    ("records", RECORDS),
    ("stl", STL),
    ("gltf", GLTF),
    ("mtl", MTL),
    ("zip", ZIP),
    ("map", MAP),
    ("form", FORM),
    ("text", TEXT),
    ("expression", EXPRESSION),
    ("picture", PICTURE),
    ("attachment", ATTACHMENT),
    ("raster", RASTER),
    ("revision", REVISION),
    ("csv", CSV),
    ("edtf", EDTF),
    ("column_value", COLUMN_VALUE),
):
    (HERE / folder).mkdir(exist_ok=True)
    for name, content in seeds.items():
        (HERE / folder / name).write_bytes(content)
