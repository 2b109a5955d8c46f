#!/usr/bin/env python3
"""strata-bench atlas and sheet accept every format of an import, name the files that they cannot
read, and continue."""
import json
import os
import struct
import subprocess
import sys
import tempfile
import zipfile

BENCH = sys.argv[1]
# A box without a lid, 2 high along y.
CORNERS = [(x, y, z) for y in (0, 2) for z in (0, 1) for x in (0, 1)]
TRIANGLES = [
    (0, 1, 3),
    (0, 3, 2),
    (0, 5, 1),
    (0, 4, 5),
    (2, 3, 7),
    (2, 7, 6),
    (0, 2, 6),
    (0, 6, 4),
    (1, 5, 7),
    (1, 7, 3),
]


def stl():
    body = b"".join(
        struct.pack("<12fH", 0, 0, 0, *(n for corner in t for n in CORNERS[corner]), 0)
        for t in TRIANGLES
    )
    return b"solid".ljust(80) + struct.pack("<I", len(TRIANGLES)) + body


def obj():
    return (
        "mtllib box.mtl\n"
        + "".join("v %g %g %g\n" % c for c in CORNERS)
        + "vt 0 0\nusemtl paint\n"
        + "".join("f " + " ".join(f"{i + 1}/1" for i in t) + "\n" for t in TRIANGLES)
    ).encode()


def glb():
    data = b"".join(struct.pack("<3f", *c) for c in CORNERS) + b"".join(
        struct.pack("<3H", *t) for t in TRIANGLES
    )
    views = [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 60}]
    accessors = [
        {
            "bufferView": 0,
            "componentType": 5126,
            "count": 8,
            "type": "VEC3",
            "min": [0, 0, 0],
            "max": [1, 2, 1],
        },
        {"bufferView": 1, "componentType": 5123, "count": 30, "type": "SCALAR"},
    ]
    text = json.dumps(
        {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": len(data)}],
            "bufferViews": views,
            "accessors": accessors,
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "nodes": [{"mesh": 0}],
            "scenes": [{"nodes": [0]}],
            "scene": 0,
        }
    ).encode()
    text += b" " * (-len(text) % 4)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(data), 0x004E4942)
        + data
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def run(*arguments):
    return subprocess.run([BENCH, *arguments], capture_output=True, text=True, check=False)


def main():
    with tempfile.TemporaryDirectory(prefix="strata-sheet-") as folder:

        def put(name, content):
            path = os.path.join(folder, name)
            with open(path, "wb") as file:
                file.write(content)
            return path

        put("box.mtl", b"newmtl paint\nKd 1 0 0\n")
        good = [
            put("box.stl", stl()),
            put("box.obj", obj()),
            put("box.glb", glb()),
            os.path.join(folder, "box.zip"),
        ]
        with zipfile.ZipFile(good[3], "w") as archive:
            archive.writestr("scan/box.obj", obj())
            archive.writestr("scan/box.mtl", "newmtl paint\nKd 1 0 0\n")
        bad = put("cut.glb", glb()[:100])
        missing = os.path.join(folder, "nothing.ply")
        meshes = [good[0], bad, good[1], missing, *good[2:]]

        sheet = os.path.join(folder, "sheet.svg")
        drawn = run("sheet", *meshes, "--up", "x", "-o", sheet)
        assert drawn.returncode == 1, (drawn.returncode, drawn.stderr)
        with open(sheet, encoding="utf-8") as file:
            svg = file.read()
        assert svg.count("<image ") == 3 * len(good), "three pictures of each that can be read"
        for path in good:
            assert f'font-weight="bold">{os.path.basename(path)}</text>' in svg, path
        assert (
            svg.count("x up") == 3 and svg.count("1 × 2 × 1 m, y up") == 1
        ), "a GLB says that y is up, and the others follow --up"
        assert (
            "cut.glb is not shown: " in svg
            and "the file is incomplete" in svg
            and "nothing.ply is not shown: " in svg
        ), svg[-2000:]
        assert run("sheet", *good, "-o", sheet).returncode == 0
        assert run("sheet", good[0], "-o", os.path.join(folder, "no", "sheet.svg")).returncode == 1

        facts = os.path.join(folder, "atlas.json")
        told = run("atlas", *meshes, "--resolutions", "2048", "--json", facts)
        assert told.returncode == 1, (told.returncode, told.stderr)
        with open(facts, encoding="utf-8") as file:
            rows = {row["mesh"]: row for row in json.load(file)["results"]}
        for path in good:
            row = rows[os.path.basename(path)]
            assert (
                row["triangles"] == 10
                and row["resolutions"][0]["shared_texels"] == 0
                and abs(row["area"] - 9) < 1e-6
            ), row
        assert (
            "the file is incomplete" in rows["cut.glb"]["refused"]
            and "nothing.ply" in rows["nothing.ply"]["refused"]
        ), rows
        assert "cut.glb" in told.stdout and "refused" in told.stdout, told.stdout
    print("ok")


main()
