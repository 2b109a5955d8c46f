#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace strata::mesh {

// The declaration of a compressed buffer view in EXT_meshopt_compression or
// KHR_meshopt_compression, with the names used there.
struct MeshoptShape {
  std::string mode,
      // mode: ATTRIBUTES, TRIANGLES or INDICES; filter: NONE or empty, OCTAHEDRAL, QUATERNION,
      // EXPONENTIAL, COLOR
      filter;
  std::uint64_t count = 0, stride = 0;
};

// Returns the count × stride bytes of a compressed view. On failure, returns the fault as the end
// of a sentence: damaged data, an unknown mode or filter, or more than `most_bytes` bytes. Can be
// called on any thread.
tl::expected<std::vector<std::uint8_t>, std::string> decode_meshopt(
    std::span<const std::uint8_t> bytes, const MeshoptShape& shape, std::uint64_t most_bytes);

}  // namespace strata::mesh
