#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strata {

// The id of all work for one request or one stroke (W3C Trace Context, level 1). All bytes are zero
// if the work belongs to no request.
struct TraceId {
  std::array<std::uint8_t, 16> bytes{};
  bool operator==(const TraceId&) const = default;
  explicit operator bool() const { return *this != TraceId{}; }
};
// The id of one part of a trace, such as the work of this server on a request.
struct SpanId {
  std::array<std::uint8_t, 8> bytes{};
  bool operator==(const SpanId&) const = default;
};

TraceId random_trace_id();
SpanId random_span_id();
std::string to_string(const TraceId& id);  // 32 lower-case hexadecimal digits
std::string to_string(const SpanId& id);   // 16 lower-case hexadecimal digits

struct TraceContext {
  TraceId trace;
  SpanId span;           // the span of the sender
  bool sampled = false;  // the sender records this trace
  bool operator==(const TraceContext&) const = default;
};

// Reads a header `traceparent`. Returns nothing unless the version is 00, all hexadecimal digits
// are lower-case, and no id is zero. The caller then begins a new trace (standard, 3.2.2 and 4.3).
std::optional<TraceContext> parse_traceparent(std::string_view text);
std::string to_traceparent(const TraceContext& context);

// Returns the context of this server's work: the trace of the sender, or a new trace if `sent` is
// malformed or empty. It always has a new span.
TraceContext continued_trace(std::string_view sent);

// Returns the trace of this thread's work, or zero without a trace. Each log line contains it.
const TraceId& current_trace();

// Marks the thread as working for a trace.
class TraceScope {
 public:
  explicit TraceScope(const TraceId& trace);
  ~TraceScope();
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

 private:
  const TraceId before_;
};

}  // namespace strata
