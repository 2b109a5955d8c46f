#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "media/photographs/camera.h"

namespace strata::mesh {
class SearchTree;
}

namespace strata::app {

// A point of the surface, in world coordinates, with the outward unit normal.
struct SeenPlace {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};
};

// How a photograph sees a place.
struct PlaceInPhotograph {
  glm::dvec2 pixel{0};         // of the original
  glm::dvec2 direction{0};     // (x, y, 1) in camera axes
  double units_per_pixel = 0;  // model units at the place, across the direction of view
  double cos_angle = 0;        // between the direction to the camera and the normal; above 0
  double distance = 0;         // from the camera in model units
  // Pixels per model unit of the surface, in the direction in which the view shortens it most. The
  // best photograph has the largest value.
  double resolution() const { return cos_angle / units_per_pixel; }
};

// Finds out which photographs of a model see a place, without the GPU.
class PlaceView {
 public:
  // `origin` and `diagonal` are those of the model's geometry and its box. The tree must outlive
  // this object.
  PlaceView(const mesh::SearchTree& tree, const glm::dvec3& origin, double diagonal,
            const SeenPlace& place)
      : tree_(tree), origin_(origin), diagonal_(diagonal), place_(place) {}

  // Cheap: the place is in front of the camera and its surface faces the camera.
  bool may_be_seen_from(const photo::Pose& pose) const;
  // Returns nothing if the place is outside the picture or the valid part of the lens, behind the
  // camera, on a surface that faces away, or hidden. The line from the camera to the place has a
  // tolerance of 0.0001 of its length and 0.00001 of the diagonal.
  std::optional<PlaceInPhotograph> in(const photo::Camera& camera, const photo::Pose& pose) const;

 private:
  bool is_hidden_from(const glm::dvec3& center, double distance) const;

  const mesh::SearchTree& tree_;
  const glm::dvec3 origin_;
  const double diagonal_;
  const SeenPlace place_;
};

}  // namespace strata::app
