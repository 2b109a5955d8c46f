#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// An image in the atlas of a model, as a PNG or JPEG file.
struct SceneImage {
  std::string media_type;  // "image/png" or "image/jpeg"
  std::vector<std::uint8_t> bytes;
};

// A model with its texture, for the files of other programs. In such files, lengths are in meters,
// +y is up, and the front of the model faces +z.
struct SceneModel {
  std::string name, copyright;
  std::shared_ptr<const Geometry> geometry;
  double metres_per_unit = 1;
  std::string up = "z";  // one of kUpDirections
  SceneImage color;      // base color, in the atlas
  // Show the base color without light.
  bool unlit = false;
};

// Returns the directions in the world that become +x, +y and +z in the file. They are the rows of a
// rotation.
std::array<glm::dvec3, 3> scene_axes(const SceneModel& model);

}  // namespace strata::mesh
