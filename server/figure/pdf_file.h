#pragma once

#include <filesystem>

#include "core/owned_file.h"
#include "figure/cairo_owners.h"

namespace strata::figure {

// A PDF surface on a new file. It reports all writing errors. Surfaces that cairo 1.16 opens by
// name do not report the errors of the last bytes, for example on a full disk.
class PdfFile {
 public:
  // Lengths are points.
  PdfFile(const std::filesystem::path& file, double width, double height);
  PdfFile(const PdfFile&) = delete;
  PdfFile& operator=(const PdfFile&) = delete;

  cairo_surface_t* surface() const { return surface_.get(); }
  // Ends the file. Returns whether it is complete. Call it once.
  bool finish();

 private:
  static cairo_status_t write(void* pdf_file, const unsigned char* bytes, unsigned int count);

  OwnedFile file_;
  bool is_complete_ = false;
  CairoSurface surface_;  // destroyed first, because it writes the file
};

}  // namespace strata::figure
