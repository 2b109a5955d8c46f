#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/maps/map_values.h"
#include "net/http/http_types.h"

// What requests with flat maps have in common.
namespace strata::net {

constexpr std::uint64_t kMaxMapBytes = 256u << 20;

// A number of the query; `fallback` where it is absent. Refused (422): no number, out of range,
// absent without a fallback.
Result<double> number_of(const Request& request, const std::string& name, double low, double high,
                         std::optional<double> fallback = {});

Result<app::MapAxis> map_axis(const Request& request);        // `along`
Result<app::MapOptions> map_options(const Request& request);  // the rest of the query

// The files of the map that the body holds; parts of a form lie in `folder` while they are read.
// Refused (400, 413, 415, 422): as take_upload and MapFiles::open refuse.
Result<app::MapFiles> take_map(const Request& request, const std::filesystem::path& folder);

}  // namespace strata::net
