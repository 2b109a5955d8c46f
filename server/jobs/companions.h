#pragma once

#include <filesystem>
#include <vector>

#include "mesh/io/input_files.h"

namespace strata::jobs {

// Returns a mesh on this machine with the files that it names: an OBJ's material libraries and
// their textures, a PLY's `comment TextureFile`, a glTF's buffers and images. Names are looked up
// in the mesh's folder and below, never elsewhere; missing files are left out, and the import
// reports them if they are needed. The mesh comes first.
std::vector<mesh::InputFile> with_companions(const std::filesystem::path& mesh);

}  // namespace strata::jobs
