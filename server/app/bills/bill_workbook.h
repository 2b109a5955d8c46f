#pragma once

#include <filesystem>
#include <memory>

#include "app/bills/measured_bill.h"
#include "core/temporary_file.h"

namespace strata::app {

// Writes a workbook (XLSX) with two sheets. The sheet "Bill" has a row for each item: its quantity
// is a formula over the rows of its lines, and its total a formula of the quantity and the price.
// The sheet "Lines" has a row for each line of the proof, whose billed value is a formula of the
// measured value. Formulas have the rounding of the position. Returns storage_full if the disk is
// full.
Result<std::shared_ptr<const TemporaryFile>> bill_workbook(const MeasuredBill& bill,
                                                           const std::filesystem::path& folder);

}  // namespace strata::app
