#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace strata::mesh {

// The URIs of glTF are `data:…;base64,…` or a relative path in percent encoding.
inline bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }
// Returns nothing if the data are not base64.
std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

}  // namespace strata::mesh
