#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/progress.h"
#include "report/document.h"

namespace strata::report {

// Write a document on A4 pages to a new file. The same document always gives the same bytes. The
// memory that a writer needs is that of the texts and of one decoded picture, and `write_pdf` also
// needs the JPEG files and the decoded PNG files of one page. Both check each picture completely.
// `write_pdf` writes a second file next to `file`, and `write_docx` one for each turned or CMYK
// picture. They delete these files, and after an error also `file`. Do not throw. Thread-safe.
//
// Errors: `invalid` for a document with wrong values (document.h), with their place in `field`, and
// for a damaged picture; `unsupported` for a picture that is not a JPEG or PNG; `damaged` for a
// missing picture; `too_large` for a picture above kMaxPictureBytes or kMaxPicturePixels
// (picture_bytes.h); `cancelled`; `storage_full` if the file cannot be written; `internal`.

// Writes Office Open XML (ISO/IEC 29500, transitional), which word processors can edit. Headings,
// captions and tables have styles, and page numbers are fields.
Result<void> write_docx(const Document& document, const std::filesystem::path& file,
                        Progress& progress);

// Writes PDF/A-2b (ISO 19005-2) with an outline, and with tags for text extraction and screen
// readers.
Result<void> write_pdf(const Document& document, const std::filesystem::path& file,
                       Progress& progress);

}  // namespace strata::report
