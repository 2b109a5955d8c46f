#pragma once

#include <optional>
#include <string>
#include <vector>

#include "store/pg/pg.h"

namespace strata::store {

// Reads the columns of one row, each once and in the order of the SELECT. The result must outlive
// the PgRow.
class PgRow {
 public:
  PgRow(const PgResult& rows, int row) : rows_(rows), row_(row) {}

  // Returns an id. If T is an optional id, it is empty for SQL null.
  template <class T>
  T id() {
    return rows_.id<T>(row_, column_++);
  }
  std::int64_t integer() { return rows_.integer(row_, column_++); }
  double real() { return rows_.real(row_, column_++); }
  bool boolean() { return rows_.boolean(row_, column_++); }
  std::string text() { return rows_.text(row_, column_++); }
  Uuid uuid() { return rows_.uuid(row_, column_++); }
  nlohmann::json json() { return rows_.json(row_, column_++); }
  Time time() { return rows_.time(row_, column_++); }
  std::vector<double> reals() { return rows_.reals(row_, column_++); }

  // Return no value if the column is null.
  std::optional<std::int64_t> optional_integer() { return optional(&PgRow::integer); }
  std::optional<double> optional_real() { return optional(&PgRow::real); }
  std::optional<std::string> optional_text() { return optional(&PgRow::text); }
  std::optional<Time> optional_time() { return optional(&PgRow::time); }
  std::optional<nlohmann::json> optional_json() { return optional(&PgRow::json); }
  std::optional<std::vector<double>> optional_reals() { return optional(&PgRow::reals); }

 private:
  template <class T>
  std::optional<T> optional(T (PgRow::*read)()) {
    if (!rows_.null(row_, column_)) return (this->*read)();
    ++column_;
    return std::nullopt;
  }

  const PgResult& rows_;
  int row_;
  int column_ = 0;
};

}  // namespace strata::store
