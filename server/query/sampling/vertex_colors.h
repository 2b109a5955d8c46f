#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "media/picture.h"
#include "mesh/surface/geometry.h"
#include "query/sampling/drawn_layer.h"

namespace strata::query {

// The colors of the vertices of a model, composed as in frames but without light
// (shaders/gbuffer_pass.frag, shade_pass.frag). The colors of the scan are at the bottom. Its
// photos follow, and then the layers, each with its opacity and the alpha of its palette. Effects
// that depend on a screen are left out. Hatches and dots have the full color of their class, an
// outline has no color, and values that wait for review have no mark.
class VertexColors {
 public:
  explicit VertexColors(std::shared_ptr<const mesh::Geometry> geometry)
      : geometry_(std::move(geometry)) {}

  // Adds a photo over the current colors. Add all photos before the first layer. The photo is not
  // kept.
  void add_photo(const Picture& photo, double opacity);
  void add_layer(DrawnLayer layer) { layers_.push_back(std::move(layer)); }

  // Returns the red, green and blue of the position that these vertices of the geometry share, or
  // black without vertices. A layer contributes the value of the first vertex with a valid texel.
  std::array<std::uint8_t, 3> at(std::span<const std::uint32_t> vertices) const;

 private:
  std::shared_ptr<const mesh::Geometry> geometry_;
  // colors by vertex; empty if there is no photo, because the base then has the scan's colors
  std::vector<std::array<std::uint8_t, 3>> base_;
  std::vector<DrawnLayer> layers_;  // bottom to top
};

}  // namespace strata::query
