#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/surface/geometry.h"
#include "query/sampling/values.h"
#include "query/sampling/vertex_colors.h"

namespace strata::query {

// A model as a binary little-endian PLY with what layers hold at its vertices, for programs that
// know vertices and no textures. Places are world coordinates, as floats where these hold every one
// exactly, otherwise as doubles; colours are `colors`, or without them those of the scan, where it
// has some.
// Of each layer there is a property of its name and type (f16: float) and `<layer>_valid`, 1 or 0;
// a name that means something in a PLY (x, red) gets `layer_` before it. A vertex on a seam has one
// texel on each side: the first that is valid counts.
class VertexPly {
 public:
  VertexPly(std::shared_ptr<const mesh::Geometry> geometry, std::vector<LayerView> layers,
            std::optional<VertexColors> colors = {});

  std::uint64_t bytes() const;  // of the whole file
  // In pieces; false where `sink` said so, which ends it.
  bool write(const std::function<bool(std::span<const std::uint8_t>)>& sink) const;

 private:
  std::string head() const;
  void append_vertex(std::uint32_t position, std::vector<std::uint8_t>& out) const;

  std::shared_ptr<const mesh::Geometry> geometry_;
  std::vector<LayerView> layers_;
  std::optional<VertexColors> colors_;
  bool has_doubles_ = false, has_colors_ = false;
  // Vertices by the position that they share: those of position i are vertices_[first_[i]] to
  // before vertices_[first_[i + 1]].
  std::vector<std::uint32_t> first_, vertices_;
};

}  // namespace strata::query
