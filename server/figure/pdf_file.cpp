#include "figure/pdf_file.h"

#include <cairo-pdf.h>

#include <cstdio>

namespace strata::figure {

PdfFile::PdfFile(const std::filesystem::path& file, double width, double height)
    : file_(std::fopen(file.c_str(), "wb")),
      is_complete_(file_ != nullptr),
      surface_(cairo_pdf_surface_create_for_stream(write, this, width, height)) {}

bool PdfFile::finish() {
  cairo_surface_finish(surface_.get());
  if (cairo_surface_status(surface_.get()) != CAIRO_STATUS_SUCCESS) is_complete_ = false;
  if (file_ && std::fclose(file_.release()) != 0) is_complete_ = false;
  return is_complete_;
}

// Returns no error, because cairo 1.16 crashes if it has an outline and cannot write a page.
cairo_status_t PdfFile::write(void* pdf_file, const unsigned char* bytes, unsigned int count) {
  auto& self = *static_cast<PdfFile*>(pdf_file);
  if (self.is_complete_ && std::fwrite(bytes, 1, count, self.file_.get()) != count)
    self.is_complete_ = false;
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace strata::figure
