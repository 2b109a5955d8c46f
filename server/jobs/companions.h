#pragma once

#include <filesystem>
#include <vector>

#include "mesh/io/input_files.h"

namespace strata::jobs {

// Returns a mesh on this machine and the files that it refers to: an OBJ's material libraries and
// their textures, a PLY's `comment TextureFile`, a glTF's buffers and images. Searches only the
// mesh's folder and its subfolders. Omits missing files. The import reports them if it needs them.
// The mesh is the first file.
std::vector<mesh::InputFile> with_companions(const std::filesystem::path& mesh);

}  // namespace strata::jobs
