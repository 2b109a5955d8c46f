#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "report/document.h"

namespace strata::report {

// Converts a PDF of cairo to PDF/A-2b (ISO 19005-2): writes a copy with XMP metadata, a color
// profile, the language of the document, the alternative texts of its figures, and a file ID. The
// copy depends only on the content. Returns the error `storage_full` if the copy cannot be written.
// Throws exceptions of QPDF, which are std::exceptions.
Result<void> write_archive(const std::filesystem::path& drawn, const std::filesystem::path& file,
                           const Document& document, const std::vector<std::string>& alternatives);

}  // namespace strata::report
