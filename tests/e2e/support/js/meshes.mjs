// Meshes that tests import.

/** Returns a PLY file of a flat square with this side, in the unit of the file. */
export const square_ply = (side) =>
  [
    "ply",
    "format ascii 1.0",
    "element vertex 4",
    "property float x",
    "property float y",
    "property float z",
    "element face 2",
    "property list uchar int vertex_indices",
    "end_header",
    "0 0 0",
    `${side} 0 0`,
    `${side} ${side} 0`,
    `0 ${side} 0`,
    "3 0 1 2",
    "3 0 2 3",
    "",
  ].join("\n");
