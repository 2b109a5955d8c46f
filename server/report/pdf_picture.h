#pragma once

#include <cairo.h>

#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "figure/cairo_owners.h"
#include "report/document.h"
#include "report/picture_bytes.h"

namespace strata::report {

// Draws pictures on a PDF surface. A JPEG becomes a part of the PDF without decoding. cairo keeps
// the decoded pixels of a PNG until the page ends.
class PdfPictures {
 public:
  struct Size {
    int width = 0, height = 0;  // pixels
  };
  // Returns the size of the upright picture. Checks the whole picture when it is asked for the
  // first time. Returns the errors of read_picture.
  Result<Size> size(const PictureSource& source, const std::string& place);

  // Draws a picture that `size` has checked. Lengths are units of the context.
  Result<void> draw(cairo_t* context, const PictureSource& source, const std::string& place,
                    double x, double y, double width, double height);

 private:
  struct Checked {
    Size size;
    PictureFormat format = PictureFormat::png;
    bool is_source = true;  // as in PictureBytes
    std::string id;         // under which cairo writes equal pictures only once
  };
  Result<void> draw_jpeg(cairo_t* context, const PictureSource& source, const Checked& checked,
                         const std::string& place);
  Result<void> draw_png(cairo_t* context, const PictureSource& source, const Checked& checked,
                        const std::string& place);

  std::map<PictureSource, Checked> checked_;
};

}  // namespace strata::report
