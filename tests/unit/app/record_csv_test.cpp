// Records as CSV: a written file can be read again, and errors name their line and column.
#include "app/records/record_csv.h"

#include <gtest/gtest.h>

namespace strata::app {
namespace {

using nlohmann::json;

Table units() {
  Table table;
  table.name = "Units";
  const auto add = [&](const char* name, ColumnKind kind) {
    Column column;
    column.id = ColumnId(static_cast<std::int64_t>(table.columns.size()) + 10);
    column.name = name;
    column.slug = name;
    column.kind = kind;
    table.columns.push_back(column);
  };
  add("code", ColumnKind::text);
  add("depth", ColumnKind::numeric);
  add("above", ColumnKind::relation);
  table.columns[0].labels = {{"es", "Código"}};
  table.columns[2].target = TableId(1);
  return table;
}

TEST(RecordCsv, what_is_written_is_read_again_with_every_separator) {
  const Table table = units();
  const std::vector<Record> records = {{1,
                                        3,
                                        {{ColumnId(10), "=SUM(A1); \"x\"\ny"},
                                         {ColumnId(11), -1.5},
                                         {ColumnId(12), {2, 4294967295}}}},
                                       {4294967295, 1, {{ColumnId(11), 1e-7}}},
                                       {7, 1, {}}};
  for (const char separator : {',', ';', '\t'})
    for (const auto& measured :
         {MeasuredRecords{},
          MeasuredRecords{{"area_m2", "length_m"}, {{0.25, 3}, {1e-9, 0}, {0, 1}}}}) {
      const auto text = records_csv(records, table.columns, measured, separator);
      const auto rows = read_records_csv(text, table);
      ASSERT_TRUE(rows.has_value()) << rows.error().detail;
      EXPECT_TRUE(rows->mistakes.empty());
      ASSERT_EQ(rows->records.size(), 3u);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(rows->records[i].key, records[i].key);
        for (const Column& column : table.columns) {
          const auto expected = records[i].values.find(column.id);
          EXPECT_EQ(rows->records[i].values.at(column.id),
                    expected == records[i].values.end() ? json() : expected->second)
              << separator << column.slug;
        }
      }
    }
  EXPECT_NE(records_csv(records, table.columns, {}, ';').find(";-1,5;"), std::string::npos);
}

TEST(RecordCsv, columns_are_known_by_slug_name_and_label) {
  const auto rows = read_records_csv("Código, depth ,version,key\nA,1,5,\n", units());
  ASSERT_TRUE(rows.has_value()) << rows.error().detail;
  EXPECT_EQ(rows->records[0].values.at(10), "A");
  EXPECT_EQ(rows->records[0].version, 5);
  EXPECT_FALSE(rows->records[0].key.has_value());
  EXPECT_EQ(rows->heads.at(10), "Código");
}

TEST(RecordCsv, what_records_measure_is_passed_over_unless_a_column_is_called_so) {
  Table table = units();
  const auto passed = read_records_csv("code,area_m2,length_m,point_count\nA,x,3,4\n", table);
  ASSERT_TRUE(passed.has_value()) << passed.error().detail;
  EXPECT_EQ(passed->records[0].values.size(), 1u);
  table.columns[1].slug = table.columns[1].name = "length_m";
  const auto read = read_records_csv("code,area_m2,length_m\nA,x,3\n", table);
  ASSERT_TRUE(read.has_value()) << read.error().detail;
  EXPECT_EQ(read->records[0].values.at(11), 3);
}

TEST(RecordCsv, a_first_row_that_cannot_be_understood_is_refused) {
  for (const char* text :
       {"", "\n\n", "colour\nred\n", "code,Código\na,b\n", "key,key\n1,2\n", "code,\na,b\n"}) {
    const auto rows = read_records_csv(text, units());
    ASSERT_FALSE(rows.has_value()) << text;
    EXPECT_EQ(rows.error().code, ErrorCode::invalid);
  }
}

TEST(RecordCsv, each_mistake_is_told_by_its_line_and_column) {
  const auto rows =
      read_records_csv("key,code,depth\n1,\"a\nb\",x\n-1,a,1\n2,a\n3,a,1,1\n4,a,2\n", units());
  ASSERT_TRUE(rows.has_value()) << rows.error().detail;
  EXPECT_EQ(rows->rows, 5u);
  ASSERT_EQ(rows->records.size(), 1u);
  EXPECT_EQ(rows->lines, std::vector<int>{7});
  ASSERT_EQ(rows->mistakes.size(), 4u);
  EXPECT_EQ(rows->mistakes[0].line, 2);
  EXPECT_EQ(rows->mistakes[0].column, "depth");
  EXPECT_EQ(rows->mistakes[1].line, 4);
  EXPECT_EQ(rows->mistakes[1].column, "key");
  EXPECT_EQ(rows->mistakes[2].line, 5);
  EXPECT_EQ(rows->mistakes[3].line, 6);
}

}  // namespace
}  // namespace strata::app
