#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/io/gltf/gltf_document.h"
#include "mesh/io/gltf/gltf_materials.h"

namespace strata::mesh {

enum GltfMode : std::uint64_t { kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

// What one primitive holds, wherever it was compressed: the vertices that its triangles name, each
// once, in the order in which they are first named.
struct GltfPrimitive {
  GltfDocument::Values positions, uvs, colors;  // uvs and colours: as many as positions, or none
  std::vector<std::uint32_t> indices;           // of those vertices
  std::uint64_t mode = kTriangles;

  bool has_uvs() const { return uvs.components == 2; }
  bool has_colors() const { return colors.components != 0; }
  glm::dvec3 position(std::size_t i) const {
    return {positions.numbers[3 * i], positions.numbers[3 * i + 1], positions.numbers[3 * i + 2]};
  }
  // Triangles that a strip may lose again where it only joins others.
  std::uint64_t most_triangles() const {
    if (indices.size() < 3) return 0;
    return mode == kTriangles ? indices.size() / 3 : indices.size() - 2;
  }
};

// What was read otherwise than a file says, or not at all.
struct GltfRemarks {
  std::uint64_t points_and_lines = 0, without_positions = 0, colors_taken_as_normalized = 0;
};

// Nothing: it holds no triangles, which is counted. Refused as by `refuse_file`: what glTF or
// KHR_mesh_quantization do not allow and has no plain meaning, counts that differ, indices out of
// range, more vertices than max_triangles have.
Result<std::optional<GltfPrimitive>> read_gltf_primitive(GltfDocument& document,
                                                         const nlohmann::json& source,
                                                         const GltfMaterial& material,
                                                         std::size_t max_triangles,
                                                         GltfRemarks& remarks);

}  // namespace strata::mesh
