#pragma once

#include <string>
#include <string_view>

namespace strata {

constexpr std::size_t kLongestFilename = 255;  // bytes

// The last part of a user's path, which may come from any system, without control characters and as UTF-8; its end where it is
// longer than kLongestFilename. Empty where nothing is left.
std::string base_filename(std::string_view path);

}  // namespace strata
