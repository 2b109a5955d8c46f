#pragma once

#include "figure/files.h"

namespace strata::figure {

// One function per kind of file, called by write_figure, which removes characters that files cannot
// hold from all texts.
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

// Returns the JPEG of the drawing for SVG and PDF.
std::vector<std::uint8_t> drawing_jpeg(const Picture& drawing);
tl::unexpected<Error> unwritable();  // storage_full

}  // namespace strata::figure
