#include "figure/files.h"

#include "figure/writers.h"

namespace strata::figure {

std::string_view media_type(Format format) {
  switch (format) {
    case Format::png: return "image/png";
    case Format::tiff: return "image/tiff";
    case Format::svg: return "image/svg+xml";
    case Format::pdf: return "application/pdf";
  }
  return {};
}

std::string_view extension(Format format) {
  switch (format) {
    case Format::png: return ".png";
    case Format::tiff: return ".tif";
    case Format::svg: return ".svg";
    case Format::pdf: return ".pdf";
  }
  return {};
}

std::vector<std::uint8_t> drawing_jpeg(const Picture& drawing) {
  constexpr JpegSettings kPrint{95, true};
  return encode_jpeg(drawing.rgba, drawing.width, drawing.height, kPrint);
}

tl::unexpected<Problem> unwritable() {
  return fail(507, "Figure not written",
              "The server's disk does not take the file. Free some of it, or ask for fewer dpi.");
}

Result<void> write_figure(const Sheet& sheet, const Picture& drawing, int dpi, Format format, const Document& document,
                          const std::filesystem::path& file, Progress& progress) {
  switch (format) {
    case Format::png: return write_png(sheet, drawing, dpi, document, file, progress);
    case Format::tiff: return write_tiff(sheet, drawing, dpi, document, file, progress);
    case Format::svg: return write_svg(sheet, drawing, document, file, progress);
    case Format::pdf: return write_pdf(sheet, drawing, document, file, progress);
  }
  return {};
}

}  // namespace strata::figure
