#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "store/journal/journal.h"

namespace strata::app {

// Paints the demo's strokes on the outside of its pot, on the CPU. Angles are around the vertical
// axis in degrees (-90 is the front), heights are shares of the pot's height. Deterministic.
class StoryBrush {
 public:
  struct Place {
    double angle = -90, height = 0.5;
  };
  struct Stroke {
    std::vector<Place> path;
    double radius_mm = 5;
  };
  using Content = std::map<TileAddress, TileData>;  // of a layer

  StoryBrush(const mesh::Geometry& geometry, const mesh::SurfaceMap& map);

  // The point of the outside there, in world coordinates, and the direction away from the axis.
  glm::dvec3 place(const Place& at) const;
  glm::dvec3 outward(const Place& at) const;
  // Points of a line on the surface, about a millimeter apart, as records keep them.
  std::vector<glm::dvec3> line(const std::vector<Place>& path) const;

  // Writes a value (nothing: erases) into `content`, and returns the revisions and the answer of
  // the edit. The border is ragged, as a hand paints.
  store::JournalEntry paint(const Layer& layer, Content& content, const Stroke& stroke,
                            std::optional<std::uint32_t> value, double metres_per_unit) const;

 private:
  double outer_radius(double angle, double z) const;  // model space

  const mesh::SurfaceMap& map_;
  glm::dvec3 origin_{0};
  glm::dvec2 axis_{0};
  double bottom_ = 0, height_ = 1;
  std::vector<float> outer_;  // by degree and millimeter of height
};

}  // namespace strata::app
