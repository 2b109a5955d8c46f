// The kind and the position of a mistake, and the suggestions that correct it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "expression/expression_parser.h"

namespace strata::query {
namespace {

struct Case {
  std::string text;
  std::string_view reason;
  std::size_t offset;
  std::size_t length = 0;
  std::vector<std::string> suggestions{};
};

void expect_refused(const Case& c, Names names = Names::layers) {
  SCOPED_TRACE(c.text);
  const auto parsed = parse_condition(c.text, "where", names);
  ASSERT_FALSE(parsed);
  const Error& problem = parsed.error();
  EXPECT_EQ(problem.reason, c.reason) << problem.detail;
  ASSERT_TRUE(problem.offset);
  EXPECT_EQ(*problem.offset, c.offset);
  EXPECT_EQ(problem.length, c.length);
  EXPECT_EQ(problem.suggestions, c.suggestions);
  // A suggestion replaces characters of the text and never extends beyond its end.
  EXPECT_LE(*problem.offset + problem.length, c.text.size());
}

TEST(Mistakes, have_a_stable_name_and_a_place) {
  using namespace mistake;
  for (const Case& c : std::vector<Case>{
           {"wet", kExpectsCondition, 0},
           {"not wet", kExpectsCondition, 0},
           {"wet > (1 > 2)", kExpectsNumber, 6},
           {"wet >", kSyntax, 5},
           {"wet > '1'", kWrongType, 6, 3},
           {"a.b = 'x' + 1", kWrongType, 6},
       })
    expect_refused(c);
  const auto number = parse_number("wet > 1", "expression");
  ASSERT_FALSE(number);
  EXPECT_EQ(number.error().reason, kExpectsNumber);
}

TEST(Mistakes, in_names_of_functions_are_corrected) {
  using namespace mistake;
  expect_refused({"sqr(wet) > 1", kUnknownFunction, 0, 3, {"sqrt"}});
  expect_refused({"wet > 1 and vaild(cracks)", kUnknownFunction, 12, 5, {"valid"}});
  expect_refused({"t_befor(a.b, '1560')", kUnknownFunction, 0, 7, {"t_before"}});
  expect_refused({"temperature(wet) > 1", kUnknownFunction, 0, 11});
  expect_refused({"buffer(cracks, 5)", kUnknownFunction, 0, 6, {"within"}});
}

TEST(Mistakes, in_words_between_conditions_are_corrected) {
  using namespace mistake;
  expect_refused({"wet > 1 adn dry > 1", kSyntax, 8, 3, {"and"}});
  expect_refused({"wet betwen 1 and 2", kSyntax, 4, 6, {"between"}});
  expect_refused({"wet > 1 valid", kSyntax, 8, 5});
}

TEST(Mistakes, a_unit_after_a_number_is_left_out) {
  using namespace mistake;
  expect_refused({"depth > 3 mm", kUnit, 8, 4, {"3"}});
  expect_refused({"depth > 3mm", kUnit, 8, 3, {"3"}});
  expect_refused({"3 mm < depth", kUnit, 0, 4, {"3"}});
  expect_refused({"depth > 0.5cm and wet > 1", kUnit, 8, 5, {"0.5"}});
  expect_refused({"depth > wet mm", kSyntax, 12, 2});  // `wet` is not a number
  expect_refused({"3d > 1", kSyntax, 1});
}

TEST(Mistakes, are_counted_in_characters) {
  const auto parsed = parse_condition("a.b = 'ä𝄞' adn wet > 1", "where");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().offset, 11u);
  EXPECT_EQ(parsed.error().length, 3u);
}

TEST(Mistakes, names_and_texts_know_their_length) {
  const auto parsed = parse_condition("  pieces.\"2nd\".code = 'it''s' and \"3d\" > 1", "where");
  ASSERT_TRUE(parsed);
  const Expression& equal = parsed->parts[0];
  EXPECT_EQ(equal.parts[0].position.at, 2u);
  EXPECT_EQ(equal.parts[0].position.length, std::string("pieces.\"2nd\".code").size());
  EXPECT_EQ(equal.parts[1].position.length, std::string("'it''s'").size());
  EXPECT_EQ(parsed->parts[1].parts[0].position.length, 4u);
}

TEST(Mistakes, names_and_texts_are_written_as_the_parser_reads_them) {
  for (const std::string slug : {"wet", "3d", "and", "roof-crack", "in"}) {
    const auto parsed = parse_number(name_in_expression(slug), "");
    ASSERT_TRUE(parsed) << slug;
    EXPECT_EQ(parsed->name, slug);
  }
  EXPECT_EQ(name_in_expression("wet"), "wet");
  EXPECT_EQ(name_in_expression("3d"), "\"3d\"");
  const auto text = parse_condition("a.b = " + text_in_expression("it's"), "");
  ASSERT_TRUE(text);
  EXPECT_EQ(text->parts[1].text, "it's");
}

}  // namespace
}  // namespace strata::query
