#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "query/sampling/texel_samples.h"

namespace strata::app {

// Texels as lines of CSV: `x,y,z,area_m2,value`, and columns of the record with the key.
// Coordinates are rounded to a tenth of a micrometer. Areas and values have single precision.
// Numbers in cells of records have double precision.
class TexelCsv {
 public:
  TexelCsv(Unit unit, char separator)
      : decimals_(unit == Unit::m    ? 7
                  : unit == Unit::cm ? 5
                                     : 4),
        separator_(separator) {}

  // Adds columns of records. Keys without a record have empty cells.
  void add_records(const std::vector<Record>& records, const std::vector<Column>& columns);
  std::string head() const;
  void append(std::string& text, const query::TexelSample& sample, bool is_cell) const;

 private:
  void append_number(std::string& text, double value, bool is_single) const;
  void append_place(std::string& text, double value) const;

  int decimals_;
  char separator_;
  std::vector<std::string> columns_;
  std::string no_record_;                                     // end of a line without a record
  std::unordered_map<std::uint32_t, std::string> of_record_;  // end of a line, by key
};

}  // namespace strata::app
