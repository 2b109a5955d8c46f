// CSV as spreadsheets write and read it.
#include <gtest/gtest.h>

#include <random>

#include "core/text/csv.h"

namespace strata {
namespace {

using Cells = std::vector<std::string>;

std::vector<Cells> rows_of(std::string_view text) {
  const auto csv = parse_csv(text);
  EXPECT_TRUE(csv.has_value()) << text << ": " << (csv ? "" : csv.error().detail);
  std::vector<Cells> rows;
  if (csv)
    for (const auto& row : csv->rows) rows.push_back(row.cells);
  return rows;
}

TEST(Csv, rows_may_end_as_any_system_ends_them) {
  for (const char* text : {"a,b\n1,2\n", "a,b\r\n1,2\r\n", "a,b\r1,2\r", "a,b\n1,2",
                           "\xef\xbb\xbf"
                           "a,b\n\n1,2\n\n"})
    EXPECT_EQ(rows_of(text), (std::vector<Cells>{{"a", "b"}, {"1", "2"}})) << text;
}

TEST(Csv, the_separator_is_found_in_the_first_row) {
  EXPECT_EQ(rows_of("a;b\n1,5;2\n"), (std::vector<Cells>{{"a", "b"}, {"1,5", "2"}}));
  EXPECT_EQ(rows_of("a\tb\n1\t2\n"), (std::vector<Cells>{{"a", "b"}, {"1", "2"}}));
  EXPECT_EQ(rows_of("\"a,a,a\";b\n1;2\n"), (std::vector<Cells>{{"a,a,a", "b"}, {"1", "2"}}));
  EXPECT_EQ(rows_of("sep=;\r\na,b\n1;2\n"), (std::vector<Cells>{{"a,b"}, {"1", "2"}}));
}

TEST(Csv, quoted_cells_hold_anything) {
  EXPECT_EQ(rows_of("a,b\n\"1,\"\"x\"\"\",\"two\nlines\"\n,\"\"\n"),
            (std::vector<Cells>{{"a", "b"}, {"1,\"x\"", "two\nlines"}}));
}

TEST(Csv, lines_are_counted_through_quoted_line_ends) {
  const auto csv = parse_csv("a,b\r\n\"1\r\n2\r3\n4\",x\r\n\r\n5,6\n");
  ASSERT_TRUE(csv.has_value());
  ASSERT_EQ(csv->rows.size(), 3u);
  EXPECT_EQ(csv->rows[1].line, 2);
  EXPECT_EQ(csv->rows[2].line, 7);
}

TEST(Csv, a_problem_names_the_line) {
  const auto expect_problem = [](std::string_view text, const char* part,
                                 const CsvLimits& limits = {}) {
    const auto csv = parse_csv(text, limits);
    ASSERT_FALSE(csv.has_value()) << text;
    EXPECT_EQ(csv.error().code, ErrorCode::invalid);
    EXPECT_NE(csv.error().detail.find(part), std::string::npos) << csv.error().detail;
  };
  expect_problem("a,b\n1,\"2\n", "(line");
  expect_problem("a,b\n1,2\n\"1\"x,2\n", "(line 3)");
  expect_problem("a,b\n1,\xff\n", "(line 2)");
  expect_problem(std::string_view("a,b\n1,\0\n", 8), "(line 2)");
  expect_problem(std::string_view("\xff\xfe"
                                  "a\0",
                                  4),
                 "UTF-16");
  expect_problem("sep=|\na|b\n", "separator must be");
  expect_problem("a,b,c\n", "at most 2 cells", {10, 2});
  expect_problem("a\nb\nc\n", "at most 2 rows", {2, 10});
}

TEST(Csv, what_is_written_is_read_again) {
  std::mt19937 random(7);
  constexpr std::string_view kLetters = "a1,;\t\"\r\n '=-";
  for (int round = 0; round < 500; ++round) {
    const char separator = ",;\t"[random() % 3];
    std::string text(kUtf8Mark);
    std::vector<Cells> rows{{"first", "second", "third"}};
    for (unsigned i = 0, count = random() % 5; i < count; ++i) {
      Cells cells;
      for (int c = 0; c < 3; ++c) {
        std::string cell;
        for (unsigned n = random() % 6; n > 0; --n) cell += kLetters[random() % kLetters.size()];
        cells.push_back(std::move(cell));
      }
      cells[0] += 'x';
      rows.push_back(std::move(cells));
    }
    for (const Cells& row : rows) text += csv_line(row, separator);
    EXPECT_EQ(rows_of(text), rows) << text;
  }
}

TEST(Csv, a_text_that_a_spreadsheet_would_run_is_kept_as_text) {
  EXPECT_EQ(guard_formula("=1+1"), "'=1+1");
  EXPECT_EQ(guard_formula("@x"), "'@x");
  EXPECT_EQ(guard_formula("a=1"), "a=1");
  EXPECT_EQ(guard_formula("'quoted'"), "'quoted'");
  for (const char* text : {"=1+1", "'=1+1", "''-x", "", "'", "''", "plain", "+34 958", "\t=1"})
    EXPECT_EQ(unguard_formula(guard_formula(text)), text);
}

TEST(Csv, full_width_signs_begin_a_formula_too) {
  for (const char* sign : {"\uff1d", "\uff0b", "\uff0d", "\uff20"})
    EXPECT_EQ(guard_formula(std::string(sign) + "1+1"), std::string("'") + sign + "1+1");
  EXPECT_EQ(guard_formula("\uff1ea"), "\uff1ea");  // full-width > begins with the same bytes
}

TEST(Csv, a_part_that_another_separator_makes_a_cell_is_guarded) {
  EXPECT_EQ(guard_formula("a;=1+1"), "a;'=1+1");
  EXPECT_EQ(guard_formula("a;=1+1;b\t@x,-2"), "a;'=1+1;b\t'@x,'-2");
  EXPECT_EQ(guard_formula("a\n=1\r\n+2"), "a\n'=1\r\n'+2");
  EXPECT_EQ(guard_formula("a;\"=1"), "a;'\"=1");  // a reader removes the double quote
  EXPECT_EQ(guard_formula("a;;b, -c; 'd'"), "a;;b, -c; 'd'");
}

TEST(Csv, a_text_with_any_separator_is_quoted_and_a_number_is_not) {
  for (const char separator : {',', ';', '\t'}) {
    EXPECT_EQ(csv_line({"a;b", "a,b", "a\tb", "x"}, separator),
              std::string("\"a;b\"") + separator + "\"a,b\"" + separator + "\"a\tb\"" + separator +
                  "x\r\n");
  }
  EXPECT_EQ(csv_line({"1,5", "-2,25e-05"}, ';'), "1,5;-2,25e-05\r\n");
  EXPECT_EQ(csv_line({"1,5"}, ','), "\"1,5\"\r\n");
}

// Splits a text like a reader that uses `separator` and recognizes quotes only at the start of a
// cell.
std::vector<std::string> cells_as_seen(const std::string& text, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false, at_begin = true;
  for (const char c : text) {
    if (c == '"' && (quoted || at_begin)) {
      quoted = !quoted;
    } else if (!quoted && (c == separator || c == '\r' || c == '\n')) {
      cells.emplace_back();
      at_begin = true;
      continue;
    } else {
      cells.back() += c;
    }
    at_begin = false;
  }
  return cells;
}

TEST(Csv, guarded_texts_come_back_and_run_nowhere_whatever_separates) {
  std::mt19937 random(11);
  const std::vector<std::string> parts = {"a", "=",  "+",  "-",  "@", "'",      "\"",    ",",
                                          ";", "\t", "\n", "\r", " ", "\uff1d", "\uff20"};
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (unsigned n = random() % 9; n > 0; --n) text += parts[random() % parts.size()];
    const std::string guarded = guard_formula(text);
    ASSERT_EQ(unguard_formula(guarded), text);
    const char separator = ",;\t"[random() % 3];
    const std::string line = csv_line({"10", guarded, "z"}, separator);
    const auto read = rows_of("sep=" + std::string(1, separator) + "\r\n" + line);
    ASSERT_EQ(read.size(), 1u);
    ASSERT_EQ(unguard_formula(read[0][1]), text);
    for (const char other : {',', ';', '\t'})
      for (const std::string& cell : cells_as_seen(line, other))
        for (const char* sign : {"=", "+", "-", "@", "\uff1d", "\uff20"})
          ASSERT_FALSE(cell.starts_with(sign))
              << line << "as separated by " << other << ": " << cell;
  }
}

}  // namespace
}  // namespace strata
