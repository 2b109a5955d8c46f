#pragma once

#include "core/error.h"
#include "report/document.h"

namespace strata::report {

// Returns the document with texts that files can contain (document.h). Returns an `invalid` error
// for a value outside its limits, with its place, such as "blocks/3/rows/0".
Result<Document> checked(const Document& document);

}  // namespace strata::report
