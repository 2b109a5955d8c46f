#pragma once

#include <cstdint>
#include <source_location>
#include <span>
#include <string_view>
#include <variant>

#include "core/log_levels.h"

namespace strata::log {

// The module whose file contains the call. The compiler determines it, which costs no run time.
struct Where {
  Module module;
  consteval Where(std::source_location place)  // NOLINT(google-explicit-constructor): a default
      : module(module_of_file(place.file_name())) {}
};

// A value after the message. In JSON it is a separate member.
struct Field {
  std::string_view name;  // letters, digits and `_`
  std::variant<std::int64_t, double, std::string_view> value;
};

// Write one line with the time, the level, the module and the trace of the thread to stderr. Either
// log an error or return it, but not both.
void debug(std::string_view message, Where where = std::source_location::current());
void info(std::string_view message, Where where = std::source_location::current());
void warning(std::string_view message, Where where = std::source_location::current());
void error(std::string_view message, Where where = std::source_location::current());
void write(Level level, std::string_view message, std::span<const Field> fields,
           Where where = std::source_location::current());

// Returns whether a line of this level is written. Call it before you compose a message that is
// rarely written.
bool is_enabled(Level level, Where where = std::source_location::current());

// Replaces the levels of all modules. Thread-safe, also while other threads write.
void set_levels(const Levels& levels);
Levels levels();

enum class Format { text, json };
// Call before other threads write.
void set_format(Format format);

}  // namespace strata::log
