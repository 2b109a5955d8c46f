// The title column of a table.
#include "domain/tables/table.h"

#include <gtest/gtest.h>

namespace strata {
namespace {

Column column(ColumnId id, ColumnKind kind, bool required = false, bool unique = false) {
  Column made;
  made.id = id;
  made.kind = kind;
  made.required = required;
  made.unique = unique;
  return made;
}

ColumnId title_of(std::vector<Column> columns, std::optional<ColumnId> chosen = {}) {
  Table table;
  table.columns = std::move(columns);
  table.title_column = chosen;
  const Column* found = name_column(table);
  return found ? found->id : ColumnId();
}

TEST(NameColumn, is_the_chosen_one_or_the_one_that_tells_records_apart_best) {
  const Column note = column(1, ColumnKind::text), code = column(2, ColumnKind::text, true, true);
  const Column term = column(3, ColumnKind::term),
               number = column(4, ColumnKind::integer, false, true);
  const Column cut = column(5, ColumnKind::line);
  EXPECT_EQ(title_of({note, code, term}), code.id);
  EXPECT_EQ(title_of({note, code, term}, term.id), term.id);
  EXPECT_EQ(title_of({cut, code}, cut.id), code.id) << "a line is no name";
  EXPECT_EQ(title_of({note, code}, ColumnId(77)), code.id) << "one that was dropped";
  EXPECT_EQ(title_of({term, note}), term.id) << "what it is of, and not who made it";
  EXPECT_EQ(title_of({term, code}), code.id);
  EXPECT_EQ(title_of({note, term}), note.id);
  EXPECT_EQ(title_of({number, cut}), number.id);
  EXPECT_EQ(title_of({cut}), ColumnId());
}

}  // namespace
}  // namespace strata
