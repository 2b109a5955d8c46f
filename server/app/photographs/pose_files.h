#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "domain/scene/model.h"
#include "media/photographs/posed_photographs.h"

namespace strata::app {

struct PoseUpload {
  std::filesystem::path path;
  std::string name;  // the user's name of the file
};

// Reads the camera poses of an export: its files, or one zip with them. Images in the zip are
// skipped. Converts positions from `unit` to the unit of the model. Fails like
// mesh::unpack_archive and photo::read_poses, and with `invalid` for geocentric poses. The field of
// these errors is `body`.
Result<photo::PosedPhotographs> read_pose_files(const std::vector<PoseUpload>& files,
                                                const std::filesystem::path& scratch, Unit unit,
                                                Unit model_unit);

}  // namespace strata::app
