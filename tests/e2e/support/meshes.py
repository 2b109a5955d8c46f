"""Generated scans as PLY files, so no test depends on a downloaded scan."""
import math
import struct


def ply(vertices, faces, colors=None):
    """`colors` are red, green and blue of each vertex, 0 to 255."""
    channels = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
        f"property float z\n{channels if colors else ''}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()
    return (
        head
        + b"".join(
            struct.pack("<3f", *v) + (bytes(colors[i]) if colors else b"")
            for i, v in enumerate(vertices)
        )
        + b"".join(struct.pack("<B3i", 3, *f) for f in faces)
    )


def _grid_faces(rows, columns):
    faces = []
    for i in range(rows):
        for j in range(columns):
            a, b = i * (columns + 1) + j, (i + 1) * (columns + 1) + j
            faces += [(a, b, b + 1), (a, b + 1, a + 1)]
    return faces


def folded_grid(cells=20, size=100.0, fold=1.0, color_at=None):
    """Returns a sheet with folds that hide one another from the side. With a small `fold` the sheet
    is nearly flat. `color_at(x, y)` returns the color of a vertex."""
    step = size / cells
    vertices = [
        (j * step, i * step, fold * (12 * math.sin(j * 0.9) + 4 * math.cos(i * 0.7)))
        for i in range(cells + 1)
        for j in range(cells + 1)
    ]
    colors = [color_at(x, y) for x, y, _ in vertices] if color_at else None
    return ply(vertices, [(a, c, b) for a, b, c in _grid_faces(cells, cells)], colors)


def bumpy_ball(rows=40, columns=80, radius=50.0):
    """Returns a closed ball with waves, whose faces point outwards."""
    vertices = [(0.0, 0.0, radius)]
    for i in range(1, rows):
        for j in range(columns):
            polar, around = math.pi * i / rows, 2 * math.pi * j / columns
            r = radius * (1 + 0.04 * math.sin(6 * polar) * math.cos(5 * around))
            vertices.append(
                (
                    r * math.sin(polar) * math.cos(around),
                    r * math.sin(polar) * math.sin(around),
                    r * math.cos(polar),
                )
            )
    vertices.append((0.0, 0.0, -radius))
    at = lambda i, j: 1 + (i - 1) * columns + j % columns
    faces = [(0, at(1, j), at(1, j + 1)) for j in range(columns)]
    for i in range(1, rows - 1):
        for j in range(columns):
            faces += [
                (at(i, j), at(i + 1, j), at(i + 1, j + 1)),
                (at(i, j), at(i + 1, j + 1), at(i, j + 1)),
            ]
    faces += [(len(vertices) - 1, at(rows - 1, j + 1), at(rows - 1, j)) for j in range(columns)]
    return ply(vertices, faces)


def pillar(width=60.0, depth=40.0, height=80.0, rows=8):
    """Returns the walls of a pillar around the z axis, from z = 0 to `height`, whose faces point
    outwards."""
    x, y = width / 2, depth / 2
    vertices = [
        (*corner, height * i / rows)
        for i in range(rows + 1)
        for corner in ((x, -y), (x, y), (-x, y), (-x, -y))
    ]
    faces = []
    for i in range(rows):
        for j in range(4):
            a, b = 4 * i + j, 4 * i + (j + 1) % 4
            faces += [(a, b, b + 4), (a, b + 4, a + 4)]
    return ply(vertices, faces)


def vessel(radius=40.0, slope=0.0, height=80.0, around=180, rows=60):
    """Returns the wall of a vessel around the z axis, from z = 0 to `height`, whose faces point
    outwards. Its radius is `radius` + `slope` · z."""
    vertices = []
    for i in range(rows + 1):
        z = height * i / rows
        r = radius + slope * z
        vertices += [
            (r * math.cos(2 * math.pi * j / around), r * math.sin(2 * math.pi * j / around), z)
            for j in range(around)
        ]
    at = lambda i, j: i * around + j % around
    faces = []
    for i in range(rows):
        for j in range(around):
            faces += [
                (at(i, j), at(i, j + 1), at(i + 1, j + 1)),
                (at(i, j), at(i + 1, j + 1), at(i + 1, j)),
            ]
    return ply(vertices, faces)
