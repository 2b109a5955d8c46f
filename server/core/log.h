#pragma once

#include <string_view>

namespace strata::log {

enum class Level { debug, info, warning, error };

// Write one line to stderr with time and level. Log or propagate an error, never both.
void set_level(Level level);
void debug(std::string_view message);
void info(std::string_view message);
void warning(std::string_view message);
void error(std::string_view message);

}  // namespace strata::log
