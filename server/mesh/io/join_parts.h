#pragma once

#include <string>
#include <vector>

#include "mesh/io/load.h"

namespace strata::mesh {

// One of several scans with common coordinates, as `load_mesh` returns it.
struct LoadedPart {
  std::string filename;  // the user's name of the file, with folders if known
  LoadedMesh loaded;
};

// Joins scans into one mesh whose parts they are, in the order of their folders and names. The
// names and folders of the parts come from the file names, without the folders that all files have
// in common. Parts never share a position, even at equal coordinates.
//
// If files state different units, all coordinates are converted to the first stated unit. A file
// that states no unit, up direction or coordinate system has that of the others. If colors of
// vertices and materials occur together, both are kept where one mesh can express them: textures
// hide the vertex colors of their part.
//
// Fails with `invalid` if files state different up directions or coordinate systems, if scans are
// so far apart that they cannot have common coordinates, and if the scans have too many triangles
// or materials together.
Result<LoadedMesh> join_parts(std::vector<LoadedPart> parts);

}  // namespace strata::mesh
