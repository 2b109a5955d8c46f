#include <gtest/gtest.h>

#include <string>

#include "net/http/byte_range.h"

namespace strata::net {
namespace {

// Returns the range to send as "begin-end", excluding `end`, or "all", or "none".
std::string parsed(std::string_view header, std::uint64_t bytes = 1000) {
  const auto range = requested_range(header, bytes);
  if (!range) return "none";
  if (!range->is_part) return "all";
  return std::to_string(range->range.begin) + "-" + std::to_string(range->range.end);
}

TEST(ByteRange, one_range_is_understood_in_its_three_forms) {
  EXPECT_EQ(parsed("bytes=0-0"), "0-1");
  EXPECT_EQ(parsed("bytes=10-19"), "10-20");
  EXPECT_EQ(parsed("bytes=990-"), "990-1000");
  EXPECT_EQ(parsed("bytes=990-5000"), "990-1000");
  EXPECT_EQ(parsed("bytes=-10"), "990-1000");
  EXPECT_EQ(parsed("bytes=-5000"), "0-1000");
}

TEST(ByteRange, what_lies_behind_the_end_is_not_there) {
  EXPECT_EQ(parsed("bytes=1000-"), "none");
  EXPECT_EQ(parsed("bytes=99999999999999999999999-"), "none");
  EXPECT_EQ(parsed("bytes=-0"), "none");
  EXPECT_EQ(parsed("bytes=0-", 0), "none");
}

TEST(ByteRange, what_is_not_understood_is_passed_over) {
  for (const char* header :
       {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=5-1", "bytes=0-1,5-6", "lines=1-2",
        "bytes=1-2-3", "bytes= 1-2", "bytes=0x1-2", "bytes=--5"})
    EXPECT_EQ(parsed(header), "all") << header;
}

}  // namespace
}  // namespace strata::net
