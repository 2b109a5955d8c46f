#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"

namespace strata::gl {

// Returns the text of `file` in the folder `directory`, ready for the compiler. `#include
// "shared/…"` lines are replaced by the named files, each file only once. `defines` ("NAME value")
// are inserted after the #version line, which must be the first line. Fails if a file is missing or
// an include is outside the folder.
Result<std::string> load_shader(const std::filesystem::path& directory, const std::string& file,
                                const std::vector<std::string>& defines = {});

}  // namespace strata::gl
