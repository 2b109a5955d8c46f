#pragma once

#include "figure/files.h"

namespace strata::figure {

// The writers of the file formats. write_figure calls them after it has removed characters that
// files cannot contain from all texts.
Result<void> write_png(const Sheet& sheet, const Picture& drawing, int dpi,
                       const Document& document, const std::filesystem::path& path,
                       Progress& progress);
Result<void> write_tiff(const Sheet& sheet, const Picture& drawing, int dpi,
                        const Document& document, const std::filesystem::path& path,
                        Progress& progress);
Result<void> write_svg(const Sheet& sheet, const Picture& drawing, const Document& document,
                       const std::filesystem::path& path, Progress& progress);
Result<void> write_pdf(const Sheet& sheet, const Picture& drawing, const Document& document,
                       const std::filesystem::path& path, Progress& progress);

// Returns the drawing as a JPEG, for SVG and PDF.
std::vector<std::uint8_t> drawing_jpeg(const Picture& drawing);
tl::unexpected<Error> unwritable();  // the Error `storage_full`

}  // namespace strata::figure
