#pragma once

#include <string>

#include "core/error.h"
#include "core/progress.h"
#include "report/document.h"
#include "report/pdf_pages.h"

namespace strata::report {

// Draws a table and moves below it. A short table stays on one page. A longer table continues on
// the next page between two rows, below its repeated first row. A row that is higher than a page
// continues between two lines. `place` is the place of the table in the document.
Result<void> add_table(PdfPages& pages, PdfPictures& pictures, const Table& table,
                       const std::string& place, const Progress& progress);

// Returns the height that the caption and the first rows need, or all rows of a short table.
Result<double> least_table_height(PdfPages& pages, PdfPictures& pictures, const Table& table,
                                  const std::string& place);

}  // namespace strata::report
