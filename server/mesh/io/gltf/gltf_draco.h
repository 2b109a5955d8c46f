#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/io/gltf/gltf_document.h"

namespace strata::mesh {

// A primitive of KHR_draco_mesh_compression: its triangles and the requested attributes by their
// glTF names.
struct DracoPrimitive {
  std::uint64_t points = 0;
  std::vector<std::uint32_t> indices;
  std::map<std::string, GltfDocument::Values> attributes;
};

struct DracoRequest {
  std::uint32_t id = 0;  // of the attribute in the stream
  // The form of the attribute's accessor, which defines the numbers of the stream. Encoders do not
  // set the stream's own flag reliably. Empty if no accessor exists. The stream then defines the
  // numbers.
  std::optional<GltfDocument::Form> form;
  bool normalize = false;  // independent of the accessor
};

// Fails like `refuse_file` if the stream is damaged, has more than `most_triangles` triangles, or
// lacks an attribute.
Result<DracoPrimitive> decode_draco(std::span<const std::uint8_t> bytes,
                                    const std::map<std::string, DracoRequest>& requests,
                                    std::uint64_t most_triangles);

}  // namespace strata::mesh
