#pragma once

#include <string>
#include <string_view>

namespace strata {

constexpr std::size_t kMaxFilenameLength = 255;  // bytes

// The last part of a user's path, which may come from any system, as UTF-8 and without what is not
// to be seen: control characters, characters of no width, and those that turn the direction of what
// follows (`exe.gpj` that reads `jpg.exe`). Its end where it is longer than kMaxFilenameLength.
// Empty where nothing is left.
std::string base_filename(std::string_view path);

}  // namespace strata
