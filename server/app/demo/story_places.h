#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::app {

// Positions on the outside of the demo's pot. Angles are in degrees around the vertical axis, and
// -90 is the front. Heights are fractions of the height of the pot.
class StoryPlaces {
 public:
  struct Place {
    double angle = -90, height = 0.5;
  };

  explicit StoryPlaces(const mesh::Geometry& geometry);

  // Return the position on the outside in world coordinates, and the direction away from the axis.
  glm::dvec3 place(const Place& at) const;
  glm::dvec3 outward(const Place& at) const;
  // Returns the vertices of a line on the surface, about a millimeter apart, as a record stores
  // them.
  std::vector<glm::dvec3> line(const std::vector<Place>& path) const;

  // Returns the origin of model space in world coordinates.
  glm::dvec3 origin() const { return origin_; }
  bool is_outside(const glm::dvec3& point) const;  // `point` is on the outer side of the wall

 private:
  double outer_radius(double angle, double z) const;

  glm::dvec3 origin_{0};
  glm::dvec2 axis_{0};
  double bottom_ = 0, height_ = 1;
  std::vector<float> outer_;  // radius by degree and by millimeter of height
};

}  // namespace strata::app
