#include "core/text/timestamp.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <ctime>
#include <string>

namespace strata {
namespace {

// The time zone of the process during a test.
class Zone {
 public:
  explicit Zone(const char* name) {
    if (const char* before = std::getenv("TZ")) before_ = before;
    setenv("TZ", name, 1);
    tzset();
  }
  ~Zone() {
    if (before_.empty())
      unsetenv("TZ");
    else
      setenv("TZ", before_.c_str(), 1);
    tzset();
  }
  Zone(const Zone&) = delete;
  Zone& operator=(const Zone&) = delete;

 private:
  std::string before_;
};

std::string parsed(std::string_view text, UnzonedTime unzoned) {
  const auto time = parse_time(text, unzoned);
  return time ? utc_text(*time) : "nothing";
}

TEST(ParseTime, a_time_with_a_zone_does_not_depend_on_the_machine) {
  const Zone zone("XXX-3");  // three hours east of Greenwich
  for (const auto unzoned : {UnzonedTime::utc, UnzonedTime::local}) {
    EXPECT_EQ(parsed("2026-11-21T14:32:05.25Z", unzoned), "2026-11-21T14:32:05.250Z");
    EXPECT_EQ(parsed("2026-11-21 14:32:05+01:00", unzoned), "2026-11-21T13:32:05.000Z");
    EXPECT_EQ(parsed("2026-11-21T14:32-01:00", unzoned), "2026-11-21T15:32:00.000Z");
  }
}

TEST(ParseTime, a_time_without_a_zone_is_in_the_chosen_zone) {
  const Zone zone("XXX-3");
  EXPECT_EQ(parsed("2026-11-21T14:32", UnzonedTime::utc), "2026-11-21T14:32:00.000Z");
  EXPECT_EQ(parsed("2026-11-21T14:32", UnzonedTime::local), "2026-11-21T11:32:00.000Z");
  EXPECT_EQ(parsed("2026-11-21", UnzonedTime::local), "2026-11-20T21:00:00.000Z");
}

TEST(ParseTime, times_that_the_clock_cannot_represent_are_the_nearest_ones) {
  EXPECT_EQ(parsed("2999-01-01T00:00:00Z", UnzonedTime::utc).substr(0, 4), "2262");
  EXPECT_EQ(parsed("0001-01-01T00:00:00Z", UnzonedTime::utc).substr(0, 4), "1677");
}

TEST(ParseTime, other_texts_are_refused) {
  for (const char* text : {"", "14:32", "2026-02-30T10:00", "2026-11-21T25:00", "yesterday"})
    EXPECT_FALSE(parse_time(text)) << text;
}

}  // namespace
}  // namespace strata
