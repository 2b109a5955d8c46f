#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "core/trace.h"

namespace strata {
namespace {

constexpr const char* kGood = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";

TEST(Traceparent, a_valid_header_is_read_and_written_back) {
  const auto context = parse_traceparent(kGood);
  ASSERT_TRUE(context);
  EXPECT_EQ(to_string(context->trace), "4bf92f3577b34da6a3ce929d0e0e4736");
  EXPECT_EQ(to_string(context->span), "00f067aa0ba902b7");
  EXPECT_TRUE(context->sampled);
  EXPECT_EQ(to_traceparent(*context), kGood);
}

TEST(Traceparent, only_the_lowest_flag_is_read) {
  const auto flags = [](const char* digits) {
    return parse_traceparent(std::string(kGood).substr(0, 53) + digits);
  };
  EXPECT_FALSE(flags("00")->sampled);
  EXPECT_FALSE(flags("02")->sampled);
  EXPECT_TRUE(flags("ff")->sampled);
}

TEST(Traceparent, malformed_headers_are_refused) {
  for (const char* text : {
           "",
           "00",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-1",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01-",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01-more",
           " 00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-0",
           "01-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
           "ff-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
           "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00F067AA0BA902B7-01",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-0A",
           "00-4bf92f3577b34da6a3ce929d0e0e473g-00f067aa0ba902b7-01",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902bx-01",
           "00-00000000000000000000000000000000-00f067aa0ba902b7-01",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-0000000000000000-01",
           "00_4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
           "00-4bf92f3577b34da6a3ce929d0e0e4736_00f067aa0ba902b7-01",
           "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7_01",
       })
    EXPECT_FALSE(parse_traceparent(text)) << text;
}

TEST(Traceparent, the_server_keeps_the_trace_and_makes_its_own_span) {
  const auto own = continued_trace(kGood);
  EXPECT_EQ(to_string(own.trace), "4bf92f3577b34da6a3ce929d0e0e4736");
  EXPECT_NE(to_string(own.span), "00f067aa0ba902b7");
  EXPECT_TRUE(own.sampled);
  const auto fresh = continued_trace("nonsense");
  EXPECT_TRUE(fresh.trace);
  EXPECT_NE(fresh.span, SpanId{});
  EXPECT_FALSE(fresh.sampled);
  EXPECT_EQ(parse_traceparent(to_traceparent(fresh)), fresh);
}

TEST(Traceparent, new_ids_differ) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) ids.insert(to_string(random_trace_id()));
  EXPECT_EQ(ids.size(), 1000u);
}

TEST(TraceScope, the_trace_belongs_to_the_thread_and_ends_with_the_scope) {
  EXPECT_FALSE(current_trace());
  const TraceId outer = random_trace_id(), inner = random_trace_id();
  {
    const TraceScope scope(outer);
    {
      const TraceScope nested(inner);
      EXPECT_EQ(current_trace(), inner);
      std::thread([] { EXPECT_FALSE(current_trace()); }).join();
    }
    EXPECT_EQ(current_trace(), outer);
  }
  EXPECT_FALSE(current_trace());
}

}  // namespace
}  // namespace strata
