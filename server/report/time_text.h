#pragma once

#include <chrono>
#include <string>

#include "core/text/timestamp.h"

namespace strata::report {

// Returns a time as in XMP and in the core properties of OOXML: "2026-03-01T09:30:00Z".
inline std::string time_text(std::chrono::sys_seconds time) {
  constexpr std::size_t kSeconds = 19;  // the length of the text up to the seconds
  return utc_text(time).substr(0, kSeconds) + "Z";
}

}  // namespace strata::report
