#pragma once

#include <string>
#include <string_view>

namespace strata {

constexpr std::size_t kMaxFilenameLength = 255;  // bytes

// Returns the last part of a user's path, which may come from any operating system. The result is
// UTF-8 without invisible characters: control characters, zero-width characters, and characters
// that reverse the following text (`exe.gpj` is displayed as `jpg.exe`). Returns only the end of a
// name that is longer than kMaxFilenameLength. Returns an empty text if nothing remains.
std::string base_filename(std::string_view path);

// Returns the last part of a user's path, as `base_filename`, without its extension.
std::string filename_stem(std::string_view path);

// Returns a user's path with its folders, separated by "/", each like `base_filename`. Files of one
// scan refer to each other by such paths. Removes parts that lead to a folder outside, and drives.
std::string relative_filename(std::string_view path);

}  // namespace strata
