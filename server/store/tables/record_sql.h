#pragma once

#include <string>

#include "domain/tables/table.h"
#include "expression/expression.h"
#include "store/pg/pg.h"
#include "store/tables/table_writer.h"

namespace strata::store {

// Returns a formula over the visible columns of a table, and over those of the tables that its
// terms name (query::Names::columns), as SQL over the rows, which the statement calls `t`. External
// values are parameters, appended to `params`; columns are their ids. Refused (invalid at `field`,
// with the character): a column that does not exist or has another kind, a text that is not a date,
// choice or number where one is expected. As in Expression, a result without a finite value is
// NULL, except for numbers beyond the range of a double: then PostgreSQL ends the statement
// (SQLSTATE 22003, see unanswerable).
Result<std::string> condition_sql(const Expression& condition, const OpenTable& open,
                                  PgConnection& connection, Params& params,
                                  const std::string& field);
Result<std::string> number_sql(const Expression& number, const OpenTable& open,
                               PgConnection& connection, Params& params, const std::string& field);

// Returns the error for a failed statement with such an expression: an error of the expression if
// its numbers were too large.
Error unanswerable(const PgConnection& connection, Error problem, const std::string& field);

}  // namespace strata::store
