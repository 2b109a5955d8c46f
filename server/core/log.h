#pragma once

#include <string_view>

namespace strata::log {

enum class Level { debug, info, warning, error };

// Write one line with the time and the level to stderr. Either log an error or return it, but not
// both.
void set_level(Level level);
void debug(std::string_view message);
void info(std::string_view message);
void warning(std::string_view message);
void error(std::string_view message);

}  // namespace strata::log
