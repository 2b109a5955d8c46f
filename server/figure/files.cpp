#include "figure/files.h"

#include "core/text/printable.h"
#include "figure/writers.h"

namespace strata::figure {
namespace {

void make_printable(std::vector<Group>& groups) {
  for (Group& group : groups) {
    group.name = printable(group.name);
    for (Item& item : group.items)
      if (auto* words = std::get_if<Words>(&item)) words->text = printable(words->text);
    make_printable(group.parts);
  }
}

Sheet printable_sheet(Sheet sheet) {
  make_printable(sheet.groups);
  return sheet;
}

}  // namespace

std::string_view media_type(Format format) {
  switch (format) {
    case Format::png: return "image/png";
    case Format::tiff: return "image/tiff";
    case Format::svg: return "image/svg+xml";
    case Format::pdf: return "application/pdf";
    case Format::dxf: return "image/vnd.dxf";
  }
  return {};
}

std::string_view extension(Format format) {
  switch (format) {
    case Format::png: return ".png";
    case Format::tiff: return ".tif";
    case Format::svg: return ".svg";
    case Format::pdf: return ".pdf";
    case Format::dxf: return ".dxf";
  }
  return {};
}

std::vector<std::uint8_t> drawing_jpeg(const Picture& drawing) {
  constexpr JpegSettings kPrint{95, true};
  return encode_jpeg(drawing.rgba, drawing.width, drawing.height, kPrint);
}

tl::unexpected<Error> unwritable() {
  return fail(ErrorCode::storage_full, "Figure not written",
              "The server could not write the file to its disk. Free disk space, or choose a "
              "lower resolution (dpi) or, for outlines, a larger tolerance.");
}

Result<void> write_figure(const Sheet& requested, const Picture& drawing, int dpi, Format format,
                          const Document& about, const std::filesystem::path& file,
                          Progress& progress) {
  const Sheet sheet = printable_sheet(requested);
  const Document document{printable(about.title), printable(about.author)};
  switch (format) {
    case Format::png: return write_png(sheet, drawing, dpi, document, file, progress);
    case Format::tiff: return write_tiff(sheet, drawing, dpi, document, file, progress);
    case Format::svg: return write_svg(sheet, drawing, document, file, progress);
    case Format::pdf: return write_pdf(sheet, drawing, document, file, progress);
    case Format::dxf: break;  // has no sheet
  }
  return {};
}

}  // namespace strata::figure
