// Writes documents as PDF/A. cairo draws the pages, and then QPDF adds what cairo does not write.
#include "core/temporary_file.h"
#include "figure/cairo_owners.h"
#include "figure/pdf_file.h"
#include "report/check_document.h"
#include "report/page.h"
#include "report/pdf_archive.h"
#include "report/pdf_flow.h"
#include "report/pdf_text.h"
#include "report/unwritable.h"
#include "report/writers.h"

namespace strata::report {
namespace {

Result<void> write(const Document& requested, const std::filesystem::path& file,
                   Progress& progress) {
  constexpr double kDrawingShare = 0.9;
  const Document document = STRATA_TRY(checked(requested));
  const TemporaryFile drawn(file.string() + ".drawn");
  PdfPictures pictures;  // outlives the surface
  figure::PdfFile pages(drawn.path, points(kPageWidth_mm), points(kPageHeight_mm));
  std::vector<std::string> alternatives;
  {
    const figure::CairoContext context(cairo_create(pages.surface()));
    alternatives =
        STRATA_TRY(draw_pages(context.get(), document, pictures, progress, kDrawingShare));
    if (!pages.finish() || cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) return unwritable();
  }
  if (progress.cancelled()) return cancelled_problem();
  progress.report(kDrawingShare, "Writing the file");
  return write_archive(drawn.path, file, document, alternatives);
}

}  // namespace

Result<void> write_pdf(const Document& document, const std::filesystem::path& file,
                       Progress& progress) {
  return without_exceptions(file, [&] { return write(document, file, progress); });
}

}  // namespace strata::report
