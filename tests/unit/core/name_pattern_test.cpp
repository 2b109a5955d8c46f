#include <gtest/gtest.h>

#include <set>

#include "core/text/name_pattern.h"

namespace strata {
namespace {

// Returns a text such as "code=SU 1 n=2 ", or "" if the name does not match the pattern. The text
// begins with "!" if the code is known.
std::string read(const std::string& pattern, const std::string& name,
                 const std::set<std::string>& known = {}) {
  const auto parsed = NamePattern::parse(pattern, "pattern");
  EXPECT_TRUE(parsed) << parsed.error().detail;
  const auto reading = parsed->read(
      name, "code", [&](std::string_view value) { return known.contains(std::string(value)); });
  if (!reading) return {};
  std::string text = reading->is_known ? "!" : "";
  for (const auto& [word, value] : reading->words) text += word + "=" + value + " ";
  return text;
}

TEST(NamePattern, words_are_what_stands_between_the_texts) {
  EXPECT_EQ(read("{code}_{view}_{n}.jpg", "12_north_1.jpg"), "code=12 n=1 view=north ");
  EXPECT_EQ(read("{code}_{view}_{n}.jpg", "12_north_1.JPG"), "code=12 n=1 view=north ");
  EXPECT_EQ(read("photo {code}", "Photo 7"), "code=7 ");
  EXPECT_EQ(read("{code}", "all of it.jpg"), "code=all of it.jpg ");
}

TEST(NamePattern, other_names_are_not_of_it) {
  for (const char* name : {"", "12.jpg", "12_north.jpg", "_north_1.jpg", "12__1.jpg",
                           "12_north_.jpg", "12_north_1.png", "12_north_1.jpg.exe"})
    EXPECT_EQ(read("{code}_{view}_{n}.jpg", name), "") << name;
}

TEST(NamePattern, of_several_readings_the_known_one_is_meant) {
  EXPECT_EQ(read("{code}_{view}_{n}.jpg", "SU_12_north_1.jpg", {"SU_12"}),
            "!code=SU_12 n=1 view=north ");
  EXPECT_EQ(read("{code}_{view}_{n}.jpg", "SU_12_north_1.jpg", {"SU"}),
            "!code=SU n=north_1 view=12 ");
  EXPECT_EQ(read("{code}_{view}_{n}.jpg", "SU_12_north_1.jpg", {"SU", "SU_12"}),
            "!code=SU_12 n=1 view=north ");
  EXPECT_EQ(read("{view}-{code}.jpg", "a-b-c.jpg", {"c"}), "!code=c view=a-b ");
  EXPECT_EQ(read("{code}_{n}.jpg", "x_y_z.jpg", {"q"}), "code=x_y n=z ");
}

TEST(NamePattern, patterns_that_say_nothing_are_refused) {
  for (const char* pattern : {"", "photo.jpg", "{a}{b}", "{a", "a}", "{}", "{a{b}}", "{a}_{a}",
                              "{a}1{b}2{c}3{d}4{e}5{f}6{g}7{h}8{i}"}) {
    const auto parsed = NamePattern::parse(pattern, "pattern");
    ASSERT_FALSE(parsed) << pattern;
    EXPECT_EQ(parsed.error().code, ErrorCode::invalid);
    EXPECT_EQ(parsed.error().field, "pattern");
  }
}

TEST(NamePattern, a_loose_name_forgets_how_it_is_written) {
  EXPECT_EQ(loose_name("SU 12-b"), loose_name("su_12B"));
  EXPECT_NE(loose_name("SU 12"), loose_name("SU 1"));
}

}  // namespace
}  // namespace strata
