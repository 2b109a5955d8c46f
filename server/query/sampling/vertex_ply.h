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

// A model as a binary little-endian PLY file with the values of layers at its vertices, for
// programs that support vertices but no textures. Positions are world coordinates: floats if these
// represent each position exactly, otherwise doubles. Colors are `colors` if given, otherwise the
// colors of the scan, if it has any. Each layer has a property with its name and type (float for
// f16), and a property `<layer>_valid`, 1 or 0. A name that has a meaning in PLY files (x, red)
// gets the prefix `layer_`. A vertex on a seam has one texel on each side, and the first valid
// texel is used.
class VertexPly {
 public:
  VertexPly(std::shared_ptr<const mesh::Geometry> geometry, std::vector<LayerView> layers,
            std::optional<VertexColors> colors = {});

  std::uint64_t bytes() const;  // size of the whole file
  // Writes the file in pieces. Stops and returns false when `sink` returns false.
  bool write(const std::function<bool(std::span<const std::uint8_t>)>& sink) const;

 private:
  std::string head() const;
  void append_vertex(std::uint32_t position, std::vector<std::uint8_t>& out) const;

  std::shared_ptr<const mesh::Geometry> geometry_;
  std::vector<LayerView> layers_;
  std::optional<VertexColors> colors_;
  bool has_doubles_ = false, has_colors_ = false;
  // Vertices by the position that they share. The vertices of position i are vertices_[first_[i]]
  // up to, but not including, vertices_[first_[i + 1]].
  std::vector<std::uint32_t> first_, vertices_;
};

}  // namespace strata::query
