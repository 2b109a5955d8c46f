#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/progress.h"
#include "mesh/io/scene_model.h"

namespace strata::mesh {

// Writes the model as a zip with the Wavefront files `name`.obj and `name`.mtl and the texture, and
// returns its size. `name` is also the name of the object and of its material, without blanks.
// Positions are world coordinates in meters, with as many decimals as 10⁻⁹ of the extent of the
// model needs, so large world coordinates lose no precision. Corners at the seams of the atlas
// share a position, so the mesh stays connected. OBJ has no materials without light, so `unlit` is
// the illumination model 0 (constant color). The file is written in small pieces.
//
// Returns `storage_full` if the file could not be written, and `cancelled`.
Result<std::uint64_t> write_obj(const SceneModel& model, const std::string& name,
                                const std::filesystem::path& file, Progress& progress);

}  // namespace strata::mesh
