// Writes sheets as pixels: PNG and TIFF.
#include <tiffio.h>

#include <cmath>
#include <cstdarg>
#include <memory>

#include "core/owned_file.h"
#include "figure/sheet_rows.h"
#include "figure/writers.h"
#include "media/guarded_png.h"

namespace strata::figure {
namespace {

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

Result<void> ended(bool all, bool cancelled) {
  if (all) return {};
  return cancelled ? cancelled_problem() : unwritable();
}

int ignore_tiff(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // namespace

Result<void> write_png(const Sheet& sheet, const Picture& drawing, int dpi,
                       const Document& document, const std::filesystem::path& path,
                       Progress& progress) {
  const OwnedFile file(std::fopen(path.c_str(), "wb"));
  if (!file) return unwritable();
  const auto [width, height] = pixels_of(sheet, dpi);
  PngWriter writer;
  if (writer.info == nullptr) return unwritable();
  std::string title = document.title, author = document.author;
  char title_key[] = "Title", author_key[] = "Author";
  png_text texts[2] = {};
  texts[0] = {
      PNG_ITXT_COMPRESSION_NONE, title_key, title.data(), 0, title.size(), nullptr, nullptr};
  texts[1] = {
      PNG_ITXT_COMPRESSION_NONE, author_key, author.data(), 0, author.size(), nullptr, nullptr};
  const auto per_metre = static_cast<png_uint_32>(std::lround(dpi / 0.0254));
  bool good = guarded(writer.png, [&] {
    png_init_io(writer.png, file.get());
    // The strongest level saves 10 % but takes four times as long.
    png_set_compression_level(writer.png, 4);
    png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(width),
                 static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_pHYs(writer.png, writer.info, per_metre, per_metre, PNG_RESOLUTION_METER);
    png_set_text(writer.png, writer.info, texts, 2);
    png_write_info(writer.png, writer.info);
  });
  good = good && sheet_rows(sheet, drawing, dpi, progress, [&](std::span<const std::uint8_t> rgb) {
           return guarded(writer.png, [&] { png_write_row(writer.png, rgb.data()); });
         });
  good = good && guarded(writer.png, [&] { png_write_end(writer.png, nullptr); });
  good = good && std::fflush(file.get()) == 0;
  return ended(good, progress.cancelled());
}

Result<void> write_tiff(const Sheet& sheet, const Picture& drawing, int dpi,
                        const Document& document, const std::filesystem::path& path,
                        Progress& progress) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), ignore_tiff, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_tiff, nullptr);
  std::unique_ptr<TIFF, CloseTiff> tiff(TIFFOpenExt(path.c_str(), "w", options.get()));
  if (!tiff) return unwritable();
  const auto [width, height] = pixels_of(sheet, dpi);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(width));
  TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(height));
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 3);
  TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff.get(), TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, 64);
  TIFFSetField(tiff.get(), TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  TIFFSetField(tiff.get(), TIFFTAG_XRESOLUTION, static_cast<double>(dpi));
  TIFFSetField(tiff.get(), TIFFTAG_YRESOLUTION, static_cast<double>(dpi));
  TIFFSetField(tiff.get(), TIFFTAG_DOCUMENTNAME, document.title.c_str());
  TIFFSetField(tiff.get(), TIFFTAG_ARTIST, document.author.c_str());
  TIFFSetField(tiff.get(), TIFFTAG_SOFTWARE, "Strata");
  std::uint32_t row = 0;
  std::vector<std::uint8_t> line;
  bool good = sheet_rows(sheet, drawing, dpi, progress, [&](std::span<const std::uint8_t> rgb) {
    line.assign(rgb.begin(), rgb.end());  // a copy, because the predictor changes the line
    return TIFFWriteScanline(tiff.get(), line.data(), row++) == 1;
  });
  good = good && TIFFFlush(tiff.get()) == 1;
  return ended(good, progress.cancelled());
}

}  // namespace strata::figure
