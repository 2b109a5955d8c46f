"""Reads the server's PLY files as other programs do."""
import struct


def read_ply(content):
    """Returns the vertices as dictionaries, and the faces as triples."""
    head, _, body = content.partition(b"end_header\n")
    lines = head.decode("ascii").split("\n")
    assert lines[0] == "ply" and lines[1] == "format binary_little_endian 1.0"
    codes = {
        "float": "f",
        "double": "d",
        "uchar": "B",
        "char": "b",
        "ushort": "H",
        "short": "h",
        "uint": "I",
        "int": "i",
    }
    counts = {
        words[1]: int(words[2])
        for words in (line.split() for line in lines)
        if words[:1] == ["element"]
    }
    properties = [
        line.split()[1:] for line in lines if line.startswith("property") and "list" not in line
    ]
    vertex = struct.Struct("<" + "".join(codes[kind] for kind, _ in properties))
    size = vertex.size * counts["vertex"]
    vertices = [
        dict(zip([name for _, name in properties], values))
        for values in vertex.iter_unpack(body[:size])
    ]
    faces = list(struct.iter_unpack("<B3I", body[size:]))
    assert len(faces) == counts["face"] and all(
        face[0] == 3 and max(face[1:]) < len(vertices) for face in faces
    )
    return vertices, [face[1:] for face in faces], [name for _, name in properties]
