#pragma once

#include <string>

#include "domain/tables/table.h"
#include "expression/expression.h"
#include "store/pg/pg.h"
#include "store/tables/table_writer.h"

namespace strata::store {

// Return SQL for a formula over the columns of a table, which the statement must call `t`. The
// formula may use the visible columns of the table, and of the tables that its terms refer to
// (query::Names::columns). External values are parameters, which are appended to `params`; columns
// are named by id. Return an `invalid` error at `field`, with the position of the character, for a
// column that does not exist or has another kind. A text that is not a date, choice or number where
// one is expected is `invalid`, too. As in Expression, a result without a finite value is NULL. But
// numbers beyond the range of a double end the statement (SQLSTATE 22003, see unanswerable).
Result<std::string> condition_sql(const Expression& condition, const OpenTable& open,
                                  PgConnection& connection, Params& params,
                                  const std::string& field);
Result<std::string> number_sql(const Expression& number, const OpenTable& open,
                               PgConnection& connection, Params& params, const std::string& field);

// Returns the error for a failed statement with such an expression: an error of the expression if
// its numbers were too large.
Error unanswerable(const PgConnection& connection, Error problem, const std::string& field);

}  // namespace strata::store
