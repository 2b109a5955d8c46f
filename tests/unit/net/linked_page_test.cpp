#include "net/api/linked/linked_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using testing::HasSubstr;
using testing::Not;

// Names come from users. Nodes without an address, such as choices and persons, have only a label.
TEST(LinkedPage, no_text_of_users_becomes_markup) {
  const std::string bad = "<img src=//evil.example>";
  const nlohmann::json documents[] = {
      {{"id", "http://site/id/1"}, {"_label", bad}, {"type", "HumanMadeObject"}},
      {{"_label", "x"}, {"classified_as", {{{"type", "Type"}, {"_label", bad}}}}},
      {{"_label", "x"}, {"made_by", {{"_label", bad}, {"content", bad}}}},
      {{"_label", "x"}, {"dimension", {{"value", 2}, {"unit", {{"_label", bad}}}}}},
      {{"_label", "x"}, {"part", {{"id", "javascript:alert(1)"}, {"_label", bad}}}},
      {{"_label", "x"}, {"name", {{"@value", bad}, {"@language", bad}}}},
      {{"_label", "x"}, {bad, bad}}};
  for (const nlohmann::json& document : documents) {
    const std::string page =
        strata::net::linked_page(document, "http://site/id/\"><img>", "http://site/models/1");
    EXPECT_THAT(page, Not(HasSubstr("<img"))) << document.dump();
    EXPECT_THAT(page, Not(HasSubstr("javascript:alert(1)\""))) << document.dump();
  }
}

TEST(LinkedPage, a_value_stands_after_its_label) {
  const nlohmann::json document{
      {"_label", "x"},
      {"dimension", {{"_label", "Area & more"}, {"value", 2}, {"unit", {{"_label", "m²"}}}}}};
  EXPECT_THAT(strata::net::linked_page(document, "http://site/id/1", ""),
              HasSubstr("Area &amp; more: 2 m²"));
}

}  // namespace
