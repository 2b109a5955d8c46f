#pragma once

#include <string>

#include "domain/tables/table.h"
#include "expression/expression.h"
#include "store/pg/pg.h"
#include "store/tables/table_writer.h"

namespace strata::store {

// A formula over the columns that are seen of a table and of those that its terms name
// (query::Names::columns) as SQL over its rows, which the statement calls `t`. What comes from
// outside are parameters, added to `params` behind those that it has; columns are their ids.
// Refused (invalid at `field`, with the character): a column that is not there or holds something
// else, a text that is no date where one is wanted, no choice, no number. As in Expression
// everything that has no finite value is NULL, but for what leaves the range of a double: there
// PostgreSQL ends the statement (SQLSTATE 22003, see unanswerable).
Result<std::string> condition_sql(const Expression& condition, const OpenTable& open,
                                  PgConnection& connection, Params& params,
                                  const std::string& field);
Result<std::string> number_sql(const Expression& number, const OpenTable& open,
                               PgConnection& connection, Params& params, const std::string& field);

// What a failed statement with such an expression means to the caller: the expression's fault where
// its numbers were too large.
Error unanswerable(const PgConnection& connection, Error problem, const std::string& field);

}  // namespace strata::store
