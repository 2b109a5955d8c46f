#include "mesh/io/gltf/gltf_uri.h"

#include "core/text/base64.h"

namespace strata::mesh {

std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
  const auto comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
    return std::nullopt;
  return from_base64(uri.substr(comma + 1));
}

}  // namespace strata::mesh
