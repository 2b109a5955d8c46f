#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "domain/layers/palette.h"
#include "domain/layers/tile_mirror.h"
#include "media/picture.h"
#include "mesh/surface/geometry.h"

namespace strata::query {

// A layer with what it is drawn with.
struct DrawnLayer {
  TileMap tiles;
  int resolution = 0;
  ValueType type = ValueType::u8;
  // by the texel's value: never one that colours by a column
  std::shared_ptr<const Palette> palette;
  double opacity = 1;
};

// The colours of a model's vertices as pictures compose them without light
// (shaders/gbuffer_pass.frag, shade_pass.frag): over the colours of the scan lie its photos, and
// over these the layers, each by its opacity and the alpha of its palette. What depends on a screen
// is left out: hatch and dots are the full colour of their class, an outline colours nothing, and
// what waits for review has no mark.
class VertexColors {
 public:
  explicit VertexColors(std::shared_ptr<const mesh::Geometry> geometry)
      : geometry_(std::move(geometry)) {}

  // Over what there is; all photos before the first layer. A photo is read here and not kept.
  void add_photo(const Picture& photo, double opacity);
  void add_layer(DrawnLayer layer) { layers_.push_back(std::move(layer)); }

  // Red, green, blue of the place that these vertices of the geometry share: none is black. Of a
  // layer counts the first of them whose texel is valid.
  std::array<std::uint8_t, 3> at(std::span<const std::uint32_t> vertices) const;

 private:
  std::shared_ptr<const mesh::Geometry> geometry_;
  // by vertex; empty: no photo, so that the scan's colours are the base
  std::vector<std::array<std::uint8_t, 3>> base_;
  std::vector<DrawnLayer> layers_;  // bottom to top
};

}  // namespace strata::query
