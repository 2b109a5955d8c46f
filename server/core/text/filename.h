#pragma once

#include <string>
#include <string_view>

namespace strata {

constexpr std::size_t kMaxFilenameLength = 255;  // bytes

// Returns the last part of a user's path, which may come from any system, as UTF-8 without
// invisible characters: control characters, zero-width characters, and those that reverse the
// following text (`exe.gpj` that reads `jpg.exe`). Only its end if it is longer than
// kMaxFilenameLength. Empty if nothing remains.
std::string base_filename(std::string_view path);

}  // namespace strata
