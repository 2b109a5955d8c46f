#include "figure/sheet_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "figure/cairo_owners.h"
#include "figure/cairo_sheet.h"
#include "figure/paper.h"

namespace strata::figure {
namespace {

constexpr int kBandRows = 256;

// Copies rows of the drawing to a band. A cairo pixel is a 32-bit word of the machine: 0x00rrggbb.
void put_drawing(std::uint8_t* band, int stride, int first_row, int rows, const Picture& drawing,
                 int left, int top, int width) {
  for (int row = 0; row < rows; ++row) {
    const int from = first_row + row - top;
    if (from < 0 || from >= drawing.height) continue;
    const std::uint8_t* rgba = drawing.rgba.data() + std::size_t{4} * from * drawing.width;
    std::uint8_t* line = band + static_cast<std::size_t>(row) * stride + std::size_t{4} * left;
    for (int x = 0; x < std::min(drawing.width, width - left); ++x, rgba += 4, line += 4) {
      const std::uint32_t pixel =
          std::uint32_t{rgba[0]} << 16 | std::uint32_t{rgba[1]} << 8 | rgba[2];
      std::memcpy(line, &pixel, 4);
    }
  }
}

}  // namespace

SheetPixels pixels_of(const Sheet& sheet, int dpi) {
  return {static_cast<int>(std::lround(sheet.size.x / kInch_mm * dpi)),
          static_cast<int>(std::lround(sheet.size.y / kInch_mm * dpi))};
}

bool sheet_rows(const Sheet& sheet, const Picture& drawing, int dpi, Progress& progress,
                const std::function<bool(std::span<const std::uint8_t> rgb)>& take) {
  const auto [width, height] = pixels_of(sheet, dpi);
  const double pixels_per_mm = dpi / kInch_mm;
  const auto pixel = [&](double mm) { return static_cast<int>(std::lround(mm * pixels_per_mm)); };
  std::vector<std::uint8_t> line(std::size_t{3} * width);
  for (int first = 0; first < height; first += kBandRows) {
    if (progress.cancelled()) return false;
    progress.report(static_cast<double>(first) / height, "Writing the file");
    const int rows = std::min(kBandRows, height - first);
    const CairoSurface band(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, rows));
    const CairoContext context(cairo_create(band.get()));
    cairo_set_source_rgb(context.get(), 1, 1, 1);
    cairo_paint(context.get());
    cairo_surface_flush(band.get());
    std::uint8_t* pixels = cairo_image_surface_get_data(band.get());
    const int stride = cairo_image_surface_get_stride(band.get());
    put_drawing(pixels, stride, first, rows, drawing, pixel(sheet.drawing.corner.x),
                pixel(sheet.drawing.corner.y), width);
    cairo_surface_mark_dirty(band.get());
    cairo_translate(context.get(), 0, -first);
    cairo_scale(context.get(), pixels_per_mm, pixels_per_mm);
    draw_groups(context.get(), sheet);
    cairo_surface_flush(band.get());
    if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS)
      throw std::runtime_error(cairo_status_to_string(cairo_status(context.get())));
    for (int row = 0; row < rows; ++row) {
      const std::uint8_t* from = pixels + static_cast<std::size_t>(row) * stride;
      for (int x = 0; x < width; ++x) {
        std::uint32_t value = 0;
        std::memcpy(&value, from + std::size_t{4} * x, 4);
        line[3 * static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(value >> 16);
        line[3 * static_cast<std::size_t>(x) + 1] = static_cast<std::uint8_t>(value >> 8);
        line[3 * static_cast<std::size_t>(x) + 2] = static_cast<std::uint8_t>(value);
      }
      if (!take(line)) return false;
    }
  }
  return true;
}

}  // namespace strata::figure
