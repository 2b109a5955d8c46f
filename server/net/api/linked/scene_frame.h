#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>

#include "app/layers/feature_set.h"

namespace strata {
struct Model;
}  // namespace strata

namespace strata::net {

// The coordinates of the IIIF scene of a model: meters from the origin of the model, with +y up and
// the front of the model facing +z, as in the GLB files of the site (mesh/io/scene_model.h).
class SceneFrame {
 public:
  explicit SceneFrame(const Model& model);

  glm::dvec3 place(const glm::dvec3& world) const;
  glm::dvec3 direction(const glm::dvec3& world) const;  // of unit length, for one of unit length
  // The place of the world's origin, by which a GLB file must be moved.
  glm::dvec3 world_origin() const { return place(glm::dvec3(0)); }

 private:
  std::array<glm::dvec3, 3> axes_;  // the directions in the world that become +x, +y and +z
  glm::dvec3 origin_;
  double metres_;
};

// Returns the geometry of a feature in world coordinates as well-known text with heights (ISO
// 13249-3), in the coordinates of the scene: POINT Z, LINESTRING Z, POLYGON Z or MULTIPOLYGON Z. An
// empty text means no geometry. Lengths are rounded to a micrometer.
std::string scene_wkt(const app::Feature& feature, app::FeatureKind kind, const SceneFrame& frame);

}  // namespace strata::net
