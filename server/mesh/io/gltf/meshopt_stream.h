#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace strata::mesh {

// What EXT_meshopt_compression and KHR_meshopt_compression say of a compressed buffer view, in
// their words.
struct MeshoptShape {
  std::string mode,
      // ATTRIBUTES, TRIANGLES or INDICES; NONE or empty, OCTAHEDRAL, QUATERNION, EXPONENTIAL, COLOR
      filter;
  std::uint64_t count = 0, stride = 0;
};

// The count × stride bytes of a compressed view. Or what is wrong with it, as the end of a
// sentence: damaged, of an unknown mode or filter, or more than `most_bytes`. Any thread.
tl::expected<std::vector<std::uint8_t>, std::string> decode_meshopt(
    std::span<const std::uint8_t> bytes, const MeshoptShape& shape, std::uint64_t most_bytes);

}  // namespace strata::mesh
