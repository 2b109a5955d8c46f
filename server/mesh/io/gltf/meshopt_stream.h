#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace strata::mesh {

// The declaration of a compressed buffer view by EXT_meshopt_compression or
// KHR_meshopt_compression, with their names.
struct MeshoptShape {
  std::string mode,
      // ATTRIBUTES, TRIANGLES or INDICES; NONE or empty, OCTAHEDRAL, QUATERNION, EXPONENTIAL, COLOR
      filter;
  std::uint64_t count = 0, stride = 0;
};

// Returns the count × stride bytes of a compressed view. Otherwise the fault, as the end of a
// sentence: damaged, unknown mode or filter, or more than `most_bytes`. Any thread.
tl::expected<std::vector<std::uint8_t>, std::string> decode_meshopt(
    std::span<const std::uint8_t> bytes, const MeshoptShape& shape, std::uint64_t most_bytes);

}  // namespace strata::mesh
