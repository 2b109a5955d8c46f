#include "store/pg/sql.h"

#include <gtest/gtest.h>

#include <string_view>

namespace strata::store {
namespace {

constexpr auto kColumns = sql("id, ", "name");
consteval auto of_table(const auto& table) { return sql("SELECT ", kColumns, " FROM ", table); }

template <class Text>
concept CanBeRead = requires(Text&& text) {
  std::forward<Text>(text).c_str();
};

TEST(Sql, literals_and_pieces_are_joined_in_their_order) {
  constexpr auto kStatement = sql(of_table("layers"), " WHERE id = $1");
  EXPECT_EQ(std::string_view(kStatement.c_str()), "SELECT id, name FROM layers WHERE id = $1");
}

TEST(Sql, an_empty_piece_adds_nothing) {
  constexpr auto kStatement = sql("", kColumns, "");
  EXPECT_EQ(std::string_view(kStatement.c_str()), "id, name");
}

TEST(Sql, text_that_is_gone_at_once_is_not_handed_out) {
  static_assert(CanBeRead<const SqlText<3>&>);
  static_assert(!CanBeRead<const SqlText<3>>);
}

}  // namespace
}  // namespace strata::store
