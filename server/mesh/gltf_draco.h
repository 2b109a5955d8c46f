#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/problem.h"

namespace strata::mesh {

// A primitive of KHR_draco_mesh_compression: its triangles and the attributes asked for, by their glTF names.
struct DracoPrimitive {
  struct Attribute {
    int components = 0;
    std::vector<float> numbers;  // components × points; normalised whole numbers are 0…1
  };
  std::uint64_t points = 0;
  std::vector<std::uint32_t> indices;
  std::map<std::string, Attribute> attributes;
};

// `ids`: the unique id of each attribute in the stream. Refused as by `refuse_file` where the stream is damaged, makes more
// than `most_triangles`, or lacks an attribute.
Result<DracoPrimitive> decode_draco(std::span<const std::uint8_t> bytes,
                                    const std::map<std::string, std::uint32_t>& ids, std::uint64_t most_triangles);

}  // namespace strata::mesh
