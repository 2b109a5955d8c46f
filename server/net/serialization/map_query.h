#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/maps/map_values.h"
#include "net/http/http_types.h"

// Functions for all requests with maps.
namespace strata::net {

constexpr std::uint64_t kMaxMapBytes = 256u << 20;

// Returns a number from the query, or `fallback` if it is absent. Refuses (422) invalid text, a
// number out of range, and an absent number without a fallback.
Result<double> number_of(const Request& request, const std::string& name, double low, double high,
                         std::optional<double> fallback = {});

Result<app::MapAxis> map_axis(const Request& request);        // the parameter `along`
Result<app::MapOptions> map_options(const Request& request);  // all other parameters

// Returns the files of the map in the body. If the body is a form, writes its files to `folder` and
// deletes them after reading. Refuses the same bodies as take_upload and MapFiles::open (400, 413,
// 415, 422).
Result<app::MapFiles> take_map(const Request& request, const std::filesystem::path& folder);

}  // namespace strata::net
