// Writes sheets as PDF with cairo. Text and shapes are vectors, and the drawing is a JPEG.
#include <cairo-pdf.h>

#include "figure/cairo_owners.h"
#include "figure/cairo_sheet.h"
#include "figure/paper.h"
#include "figure/pdf_file.h"
#include "figure/writers.h"

namespace strata::figure {
namespace {

constexpr double kPointsPerMm = 72 / kInch_mm;

}  // namespace

Result<void> write_pdf(const Sheet& sheet, const Picture& drawing, const Document& document,
                       const std::filesystem::path& path, Progress& progress) {
  progress.report(0.1, "Packing the drawing");
  const auto jpeg = drawing_jpeg(drawing);
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.7, "Writing the file");
  PdfFile file(path, sheet.size.x * kPointsPerMm, sheet.size.y * kPointsPerMm);
  cairo_surface_t* page = file.surface();
  cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_TITLE, document.title.c_str());
  cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_AUTHOR, document.author.c_str());
  cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_CREATOR, "Strata");
  {
    const CairoContext context(cairo_create(page));
    cairo_scale(context.get(), kPointsPerMm, kPointsPerMm);
    // cairo writes the JPEG instead of these pixels and uses only their size. It does not modify
    // the JPEG or the pixels.
    const CairoSurface image(cairo_image_surface_create_for_data(
        const_cast<std::uint8_t*>(drawing.rgba.data()), CAIRO_FORMAT_RGB24, drawing.width,
        drawing.height, 4 * drawing.width));
    cairo_surface_set_mime_data(image.get(), CAIRO_MIME_TYPE_JPEG, jpeg.data(), jpeg.size(),
                                nullptr, nullptr);
    cairo_save(context.get());
    cairo_translate(context.get(), sheet.drawing.corner.x, sheet.drawing.corner.y);
    cairo_scale(context.get(), sheet.drawing.size.x / drawing.width,
                sheet.drawing.size.y / drawing.height);
    cairo_set_source_surface(context.get(), image.get(), 0, 0);
    cairo_paint(context.get());
    cairo_restore(context.get());
    draw_groups(context.get(), sheet);
    cairo_show_page(context.get());
    const bool is_complete = file.finish();  // must run while the JPEG exists
    if (!is_complete || cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) return unwritable();
  }
  return {};
}

}  // namespace strata::figure
