#pragma once

#include "figure/files.h"

namespace strata::figure {

// One for each kind of file, as write_figure, which has left out of all words what files do not
// have.
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

// The drawing within SVG and PDF.
std::vector<std::uint8_t> drawing_jpeg(const Picture& drawing);
tl::unexpected<Error> unwritable();  // storage_full

}  // namespace strata::figure
