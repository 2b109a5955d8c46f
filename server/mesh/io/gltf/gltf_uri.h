#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace strata::mesh {

// URIs of glTF: `data:…;base64,…`, or a relative path in percent encoding.
inline bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }
// Nothing if it is not base64.
std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

}  // namespace strata::mesh
