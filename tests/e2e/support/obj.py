"""Reads zips with an OBJ file as other programs do."""
import io
import zipfile

import numpy


class Obj:
    """The content of a zip with one OBJ file, one material and one texture."""

    def __init__(self, content):
        with zipfile.ZipFile(io.BytesIO(content)) as file:
            assert file.testzip() is None
            files = {name: file.read(name) for name in file.namelist()}
        (name,) = (each for each in files if each.endswith(".obj"))
        self.name = name.removesuffix(".obj")
        self.comments, words = [], {}
        for line in files.pop(name).decode().splitlines():
            keyword, _, rest = line.partition(" ")
            if keyword == "#":
                self.comments.append(rest)
            else:
                words.setdefault(keyword, []).append(rest)
        (library,) = words["mtllib"]
        self.material = dict(
            line.split(" ", 1) for line in files.pop(library).decode().splitlines()
        )
        assert words["usemtl"] == [self.material["newmtl"]]
        self.image = files.pop(self.material["map_Kd"])
        assert not files, files.keys()
        numbers = {key: [each.split() for each in words[key]] for key in ("v", "vt", "vn")}
        self.places = numpy.array(numbers["v"], float)
        self.uvs = numpy.array(numbers["vt"], float)
        self.normals = numpy.array(numbers["vn"], float)
        corners = [[each.split("/") for each in face.split()] for face in words["f"]]
        self.corners = numpy.array(corners, int) - 1  # triangle, corner, (v, vt, vn)
