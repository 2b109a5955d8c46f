#include "net/http/byte_range.h"

#include <algorithm>
#include <charconv>

namespace strata::net {
namespace {

std::optional<std::uint64_t> number_of(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  return error == std::errc::result_out_of_range ? UINT64_MAX : value;
}

}  // namespace

std::optional<RequestedRange> requested_range(std::string_view header, std::uint64_t bytes) {
  constexpr std::string_view kUnit = "bytes=";
  const RequestedRange whole{{0, bytes}, false};
  if (!header.starts_with(kUnit)) return whole;
  const std::string_view range = header.substr(kUnit.size());
  const auto dash = range.find('-');
  if (dash == std::string_view::npos || range.find(',') != std::string_view::npos) return whole;
  const auto first = number_of(range.substr(0, dash)), last = number_of(range.substr(dash + 1));
  const bool has_first = dash > 0, has_last = dash + 1 < range.size();
  if ((has_first && !first) || (has_last && !last) || (!has_first && !has_last)) return whole;
  if (!has_first) {  // requests the last bytes
    if (*last == 0 || bytes == 0) return std::nullopt;
    return RequestedRange{{bytes - std::min(*last, bytes), bytes}, true};
  }
  if (has_last && *last < *first) return whole;
  if (*first >= bytes) return std::nullopt;
  return RequestedRange{{*first, has_last ? std::min(*last, bytes - 1) + 1 : bytes}, true};
}

}  // namespace strata::net
