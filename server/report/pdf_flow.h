#pragma once

#include <cairo.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "report/document.h"
#include "report/pdf_picture.h"

namespace strata::report {

// Lays out a document that `checked` returned, and draws its pages on a PDF surface. The unit of
// the context must be a point. A heading stays on the page of the block after it, and a picture on
// the page of its caption. Reports progress from 0 to `share`. cairo uses `pictures` until the
// surface is destroyed. Returns the alternative texts of the pictures, in the order of their tags.
Result<std::vector<std::string>> draw_pages(cairo_t* context, const Document& document,
                                            PdfPictures& pictures, Progress& progress,
                                            double share);

}  // namespace strata::report
