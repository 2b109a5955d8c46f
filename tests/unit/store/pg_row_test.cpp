#include "store/pg/pg_row.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

namespace strata::store {
namespace {

// A result with one row, as PostgreSQL sends it: in binary format, with the most significant byte
// first.
class Row {
 public:
  Row& integer(std::int64_t value) {
    std::string bytes;
    for (int shift = 56; shift >= 0; shift -= 8)
      bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> shift);
    return add(oid::kInt8, bytes);
  }
  Row& text(const std::string& value) { return add(oid::kText, value); }
  Row& null(Oid type) { return add(type, std::nullopt); }

  PgResult result() const {
    PGresult* made = PQmakeEmptyPGresult(nullptr, PGRES_TUPLES_OK);
    std::vector<PGresAttDesc> columns;
    std::string name = "column";
    for (const Cell& cell : cells_) columns.push_back({name.data(), 0, 0, 1, cell.type, -1, -1});
    PQsetResultAttrs(made, static_cast<int>(columns.size()), columns.data());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      std::string bytes = cells_[i].bytes.value_or("");
      PQsetvalue(made, 0, static_cast<int>(i), cells_[i].bytes ? bytes.data() : nullptr,
                 cells_[i].bytes ? static_cast<int>(bytes.size()) : -1);
    }
    return PgResult(made);
  }

 private:
  struct Cell {
    Oid type;
    std::optional<std::string> bytes;
  };
  Row& add(Oid type, std::optional<std::string> bytes) {
    cells_.push_back({type, std::move(bytes)});
    return *this;
  }
  std::vector<Cell> cells_;
};

TEST(PgRow, columns_are_read_in_their_order) {
  const PgResult rows = Row().integer(7).text("Cracks").integer(-2).text("cracks").result();
  PgRow row(rows, 0);
  EXPECT_EQ(row.id<LayerId>(), LayerId(7));
  EXPECT_EQ(row.text(), "Cracks");
  EXPECT_EQ(row.integer(), -2);
  EXPECT_EQ(row.text(), "cracks");
}

TEST(PgRow, a_null_column_is_passed_like_one_with_a_value) {
  const PgResult rows = Row()
                            .null(oid::kText)
                            .text("")
                            .null(oid::kInt8)
                            .integer(5)
                            .null(oid::kInt8)
                            .integer(9)
                            .result();
  PgRow row(rows, 0);
  EXPECT_EQ(row.optional_text(), std::nullopt);
  EXPECT_EQ(row.optional_text(), "");
  EXPECT_EQ(row.optional_integer(), std::nullopt);
  EXPECT_EQ(row.optional_integer(), 5);
  EXPECT_EQ(row.id<std::optional<TableId>>(), std::nullopt);
  EXPECT_EQ(row.id<std::optional<TableId>>(), TableId(9));
}

}  // namespace
}  // namespace strata::store
