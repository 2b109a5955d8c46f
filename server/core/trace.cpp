#include "core/trace.h"

#include <sodium.h>

#include "core/text/hex.h"

namespace strata {
namespace {

constexpr std::size_t kLength = 55;  // 00-<32 digits>-<16 digits>-<2 digits>
constexpr std::uint8_t kSampled = 1;

thread_local TraceId working_for;

template <class Id>
Id random_id() {
  Id id;
  do randombytes_buf(id.bytes.data(), id.bytes.size());
  while (id == Id{});
  return id;
}

// Unlike `hex_digit_value`, refuses digits in upper case, which the standard forbids.
int lower_digit_value(char c) { return c >= 'A' && c <= 'F' ? -1 : hex_digit_value(c); }

template <std::size_t N>
bool read_digits(std::string_view digits, std::array<std::uint8_t, N>& bytes) {
  for (std::size_t i = 0; i < N; ++i) {
    const int high = lower_digit_value(digits[2 * i]), low = lower_digit_value(digits[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    bytes[i] = static_cast<std::uint8_t>(high << 4 | low);
  }
  return true;
}

}  // namespace

TraceId random_trace_id() { return random_id<TraceId>(); }
SpanId random_span_id() { return random_id<SpanId>(); }
std::string to_string(const TraceId& id) { return to_hex(id.bytes); }
std::string to_string(const SpanId& id) { return to_hex(id.bytes); }

std::optional<TraceContext> parse_traceparent(std::string_view text) {
  if (text.size() != kLength || !text.starts_with("00-") || text[35] != '-' || text[52] != '-')
    return std::nullopt;
  TraceContext context;
  std::array<std::uint8_t, 1> flags{};
  if (!read_digits(text.substr(3, 32), context.trace.bytes) ||
      !read_digits(text.substr(36, 16), context.span.bytes) ||
      !read_digits(text.substr(53, 2), flags))
    return std::nullopt;
  if (context.trace == TraceId{} || context.span == SpanId{}) return std::nullopt;
  context.sampled = (flags[0] & kSampled) != 0;
  return context;
}

std::string to_traceparent(const TraceContext& context) {
  return "00-" + to_string(context.trace) + "-" + to_string(context.span) +
         (context.sampled ? "-01" : "-00");
}

TraceContext continued_trace(std::string_view sent) {
  if (auto context = parse_traceparent(sent)) {
    context->span = random_span_id();
    return *context;
  }
  return {random_trace_id(), random_span_id(), false};
}

const TraceId& current_trace() { return working_for; }

TraceScope::TraceScope(const TraceId& trace) : before_(working_for) { working_for = trace; }
TraceScope::~TraceScope() { working_for = before_; }

}  // namespace strata
