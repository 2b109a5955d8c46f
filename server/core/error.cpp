#include "core/error.h"

#include <ostream>

namespace strata {

std::string_view name(ErrorCode code) {
  switch (code) {
    case ErrorCode::malformed: return "malformed";
    case ErrorCode::unauthenticated: return "unauthenticated";
    case ErrorCode::forbidden: return "forbidden";
    case ErrorCode::not_found: return "not_found";
    case ErrorCode::method_not_allowed: return "method_not_allowed";
    case ErrorCode::not_acceptable: return "not_acceptable";
    case ErrorCode::too_slow: return "too_slow";
    case ErrorCode::conflict: return "conflict";
    case ErrorCode::superseded: return "superseded";
    case ErrorCode::gone: return "gone";
    case ErrorCode::stale: return "stale";
    case ErrorCode::too_large: return "too_large";
    case ErrorCode::unsupported: return "unsupported";
    case ErrorCode::range_not_satisfied: return "range_not_satisfied";
    case ErrorCode::misdirected: return "misdirected";
    case ErrorCode::invalid: return "invalid";
    case ErrorCode::upgrade_required: return "upgrade_required";
    case ErrorCode::version_required: return "version_required";
    case ErrorCode::too_many_requests: return "too_many_requests";
    case ErrorCode::head_too_large: return "head_too_large";
    case ErrorCode::cancelled: return "cancelled";
    case ErrorCode::moved: return "moved";
    case ErrorCode::internal: return "internal";
    case ErrorCode::damaged: return "damaged";
    case ErrorCode::not_implemented: return "not_implemented";
    case ErrorCode::bad_gateway: return "bad_gateway";
    case ErrorCode::busy: return "busy";
    case ErrorCode::unavailable: return "unavailable";
    case ErrorCode::timed_out: return "timed_out";
    case ErrorCode::gpu_lost: return "gpu_lost";
    case ErrorCode::out_of_memory: return "out_of_memory";
    case ErrorCode::storage_full: return "storage_full";
  }
  return "internal";
}

std::optional<ErrorCode> error_code_named(std::string_view name_of_it) {
  for (int i = 0; i <= static_cast<int>(kLastErrorCode); ++i)
    if (const auto code = static_cast<ErrorCode>(i); name(code) == name_of_it) return code;
  return std::nullopt;
}

Error moved_to(std::string location) {
  Error error{ErrorCode::moved,
              "Model moved",
              "Another node of this site owns the model now. Repeat the request at its address.",
              {}};
  error.location = std::move(location);
  return error;
}

std::ostream& operator<<(std::ostream& out, ErrorCode code) { return out << name(code); }

}  // namespace strata
