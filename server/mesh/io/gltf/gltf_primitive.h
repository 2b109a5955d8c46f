#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/io/gltf/gltf_document.h"
#include "mesh/io/gltf/gltf_materials.h"

namespace strata::mesh {

enum GltfMode : std::uint64_t { kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

// The decompressed content of one primitive. Each vertex that the triangles use appears in it once,
// in the order of first use.
struct GltfPrimitive {
  GltfDocument::Values positions, uvs, colors;  // uvs and colors: one per position, or empty
  std::vector<std::uint32_t> indices;           // into these vertices
  std::uint64_t mode = kTriangles;

  bool has_uvs() const { return uvs.components == 2; }
  bool has_colors() const { return colors.components != 0; }
  glm::dvec3 position(std::size_t i) const {
    return {positions.numbers[3 * i], positions.numbers[3 * i + 1], positions.numbers[3 * i + 2]};
  }
  // Includes triangles of a strip that only connect other triangles and may be dropped later.
  std::uint64_t most_triangles() const {
    if (indices.size() < 3) return 0;
    return mode == kTriangles ? indices.size() / 3 : indices.size() - 2;
  }
};

// Counts of values read in a changed form and of content that was not read.
struct GltfRemarks {
  std::uint64_t points_and_lines = 0, without_positions = 0, colors_taken_as_normalized = 0;
};

// Returns nothing for a primitive without triangles, which is counted. Fails like `refuse_file` for
// content that glTF and KHR_mesh_quantization do not allow and that has no clear meaning. Also
// fails for counts that differ, indices out of range, and more vertices than max_triangles can use.
Result<std::optional<GltfPrimitive>> read_gltf_primitive(GltfDocument& document,
                                                         const nlohmann::json& source,
                                                         const GltfMaterial& material,
                                                         std::size_t max_triangles,
                                                         GltfRemarks& remarks);

}  // namespace strata::mesh
