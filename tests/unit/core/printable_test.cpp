#include "core/text/printable.h"

#include <gtest/gtest.h>

#include "core/text/direction.h"

namespace strata {
namespace {

TEST(Printable, characters_that_files_cannot_contain_are_removed) {
  EXPECT_EQ(printable("a\x01 b\x1f\tc\nd"), "a b\tc\nd");
  EXPECT_EQ(printable("a\uFFFE\uFFFF b"), "a b");
  EXPECT_EQ(printable("Größe 🗿"), "Größe 🗿");
}

TEST(Printable, invalid_bytes_become_a_replacement_character) {
  EXPECT_EQ(printable("a\xff"
                      "b"),
            "a\uFFFD"
            "b");
  const std::string cut = printable("a\xc3");
  EXPECT_EQ(cut, "a\uFFFD");
}

TEST(Direction, the_first_letter_sets_the_direction) {
  EXPECT_TRUE(is_right_to_left("123 עברית abc"));
  EXPECT_TRUE(is_right_to_left("العربية"));
  EXPECT_FALSE(is_right_to_left("abc עברית"));
  EXPECT_FALSE(is_right_to_left("12 – ?"));
  EXPECT_FALSE(is_right_to_left(""));
}

}  // namespace
}  // namespace strata
