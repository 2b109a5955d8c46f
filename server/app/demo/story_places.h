#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::app {

// Places on the outside of the demo's pot. Angles are around the vertical axis in degrees (-90 is
// the front), heights are shares of the pot's height.
class StoryPlaces {
 public:
  struct Place {
    double angle = -90, height = 0.5;
  };

  explicit StoryPlaces(const mesh::Geometry& geometry);

  // The point of the outside there, in world coordinates, and the direction away from the axis.
  glm::dvec3 place(const Place& at) const;
  glm::dvec3 outward(const Place& at) const;
  // Points of a line on the surface, about a millimeter apart, as records keep them.
  std::vector<glm::dvec3> line(const std::vector<Place>& path) const;

  // In model space.
  glm::dvec3 origin() const { return origin_; }
  bool is_outside(const glm::dvec3& point) const;  // on the outer side of the pot's wall

 private:
  double outer_radius(double angle, double z) const;

  glm::dvec3 origin_{0};
  glm::dvec2 axis_{0};
  double bottom_ = 0, height_ = 1;
  std::vector<float> outer_;  // by degree and millimeter of height
};

}  // namespace strata::app
