#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/progress.h"
#include "figure/sheet.h"
#include "media/picture.h"

namespace strata::figure {

enum class Format { png, tiff, svg, pdf, dxf };
std::string_view media_type(Format format);
std::string_view extension(Format format);  // ".pdf"

// Writes a sheet and its drawing, which has `dpi` pixels per inch, to a new file. SVG and PDF
// contain the drawing as a JPEG of high quality, and all other items as shapes and text. PNG and
// TIFF (deflate) contain only pixels, and the number of pixels per inch. The metadata of the file
// contains `title` and `author`. Characters that files cannot contain (control characters, U+FFFE,
// U+FFFF) are removed from all texts. Errors: `cancelled`, and `storage_full` if the file cannot be
// written. For DXF, see write_dxf.
struct Document {
  std::string title, author;
};
Result<void> write_figure(const Sheet& sheet, const Picture& drawing, int dpi, Format format,
                          const Document& document, const std::filesystem::path& file,
                          Progress& progress);

}  // namespace strata::figure
