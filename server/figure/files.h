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

// Writes a sheet with its drawing, whose pixels are `dpi` per inch, as a new file. In SVG and PDF
// the drawing is a JPEG of high quality, and everything else is shapes and text; in PNG and TIFF
// (deflate) everything is pixels, with their number per inch in the file. cancelled: cancelled;
// storage_full: the file cannot be written. The file's metadata contain `title` and `author`.
// Characters that files cannot hold (control characters, U+FFFE, U+FFFF) are removed from all
// texts.
struct Document {
  std::string title, author;
};
Result<void> write_figure(const Sheet& sheet, const Picture& drawing, int dpi, Format format,
                          const Document& document, const std::filesystem::path& file,
                          Progress& progress);

}  // namespace strata::figure
