"""Reads rasters in the format of `texels.npy` with the standard library only."""
import ast
import hashlib
import struct

_CODES = {"u1": "B", "u2": "H", "u4": "I", "i1": "b", "i2": "h", "i4": "i", "f2": "e", "f4": "f"}


class Raster:
    def __init__(self, content):
        assert content[:6] == b"\x93NUMPY", content[:20]
        size = struct.unpack("<H", content[8:10])[0]
        head = ast.literal_eval(content[10 : 10 + size].decode())
        (value, kind), (valid, flag) = head["descr"]
        assert (value, valid, flag[1:]) == ("value", "valid", "b1"), head
        self.height, self.width = head["shape"]
        self.texel = struct.Struct("<" + _CODES[kind[1:]] + "?")
        self.content = content[10 + size :]
        assert len(self.content) == self.width * self.height * self.texel.size
        self.digest = hashlib.sha256(self.content).hexdigest()

    def differences(self, other):
        """Returns (value, valid) of both rasters for every texel that differs."""
        row_size = self.width * self.texel.size
        found = []
        for start in range(0, len(self.content), row_size):
            here, there = (
                self.content[start : start + row_size],
                other.content[start : start + row_size],
            )
            if here != there:
                found += [
                    (a, b)
                    for a, b in zip(self.texel.iter_unpack(here), self.texel.iter_unpack(there))
                    if a != b
                ]
        return found
