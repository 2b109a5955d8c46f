#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/progress.h"
#include "figure/sheet.h"
#include "media/picture.h"

namespace strata::figure {

enum class Format { png, tiff, svg, pdf };
std::string_view media_type(Format format);
std::string_view extension(Format format);  // ".pdf"

// Writes a sheet with its drawing, whose pixels are `dpi` an inch, as a new file. In SVG and PDF
// the drawing is a JPEG of high quality, and all else is shapes and words; in PNG and TIFF
// (deflate) everything is pixels, of which the file says how many an inch has. cancelled:
// cancelled; storage_full: it cannot be written. `title` and `author` go along as the file's own.
// Of all words, characters that files do not have (control characters, U+FFFE, U+FFFF) are left
// out.
struct Document {
  std::string title, author;
};
Result<void> write_figure(const Sheet& sheet, const Picture& drawing, int dpi, Format format,
                          const Document& document, const std::filesystem::path& file,
                          Progress& progress);

}  // namespace strata::figure
