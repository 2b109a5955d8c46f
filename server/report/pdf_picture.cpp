#include "report/pdf_picture.h"

#include <cstring>
#include <memory>
#include <new>

namespace strata::report {
namespace {

struct DestroyPattern {
  void operator()(cairo_pattern_t* pattern) const { cairo_pattern_destroy(pattern); }
};
using Pattern = std::unique_ptr<cairo_pattern_t, DestroyPattern>;

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

// Converts RGBA to the 32-bit words of cairo, 0x00rrggbb, on white paper.
void put_on_white(std::vector<std::uint8_t>& pixels) {
  for (std::size_t i = 0; i + 3 < pixels.size(); i += 4) {
    const std::uint32_t alpha = pixels[i + 3];
    std::uint32_t word = 0;
    for (std::size_t c = 0; c < 3; ++c)
      word = word << 8 | (pixels[i + c] * alpha + 255 * (255 - alpha) + 127) / 255;
    std::memcpy(&pixels[i], &word, sizeof word);
  }
}

// Paints a pattern of one unit per pixel. Without the filter, cairo would ask viewers to
// interpolate the pixels, which PDF/A forbids.
void paint(cairo_t* context, cairo_pattern_t* pattern) {
  cairo_pattern_set_filter(pattern, CAIRO_FILTER_NEAREST);
  cairo_set_source(context, pattern);
  cairo_paint(context);
}

}  // namespace

Result<PdfPictures::Size> PdfPictures::size(const PictureSource& source, const std::string& place) {
  if (const auto found = checked_.find(source); found != checked_.end()) return found->second.size;
  const PictureBytes picture = STRATA_TRY(read_picture(source, place));
  const Size size{picture.width, picture.height};
  checked_[source] = {size, picture.format, picture.is_source,
                      "picture " + std::to_string(checked_.size())};
  return size;
}

Result<void> PdfPictures::draw(cairo_t* context, const PictureSource& source,
                               const std::string& place, double x, double y, double width,
                               double height) {
  const Checked& checked = checked_.at(source);
  const bool is_jpeg = checked.format == PictureFormat::jpeg;
  cairo_save(context);
  cairo_translate(context, x, y);
  Result<void> drawn;
  if (is_jpeg) {
    cairo_scale(context, width, height);
    drawn = draw_jpeg(context, source, checked, place);
  } else {
    cairo_scale(context, width / checked.size.width, height / checked.size.height);
    drawn = draw_png(context, source, checked, place);
  }
  cairo_restore(context);
  return drawn;
}

Result<void> PdfPictures::draw_jpeg(cairo_t* context, const PictureSource& source,
                                    const Checked& checked, const std::string& place) {
  Bytes bytes;
  if (checked.is_source)
    bytes = STRATA_TRY(read_bytes(source, place));
  else
    bytes = STRATA_TRY(read_picture(source, place)).bytes;
  // cairo writes the JPEG instead of this pixel, so its size is that of the picture.
  const figure::CairoSurface pixel(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
  auto owner = std::make_unique<Bytes>(bytes);
  if (cairo_surface_set_mime_data(
          pixel.get(), CAIRO_MIME_TYPE_JPEG, bytes->data(), bytes->size(),
          [](void* kept) { delete static_cast<Bytes*>(kept); },
          owner.get()) == CAIRO_STATUS_SUCCESS)
    static_cast<void>(owner.release());
  auto id = std::make_unique<std::string>(checked.id);
  const auto* characters = reinterpret_cast<const unsigned char*>(id->data());
  if (cairo_surface_set_mime_data(
          pixel.get(), CAIRO_MIME_TYPE_UNIQUE_ID, characters, id->size(),
          [](void* kept) { delete static_cast<std::string*>(kept); },
          id.get()) == CAIRO_STATUS_SUCCESS)
    static_cast<void>(id.release());
  const Pattern pattern(cairo_pattern_create_for_surface(pixel.get()));
  paint(context, pattern.get());
  return {};
}

Result<void> PdfPictures::draw_png(cairo_t* context, const PictureSource& source,
                                   const Checked& checked, const std::string& place) {
  const auto bytes = STRATA_TRY(read_bytes(source, place));
  auto picture = STRATA_TRY(decode_picture(*bytes));
  put_on_white(picture.rgba);
  const figure::CairoSurface pixels(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, checked.size.width, checked.size.height));
  if (cairo_surface_status(pixels.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  cairo_surface_flush(pixels.get());
  const auto row = std::size_t{4} * static_cast<std::size_t>(checked.size.width);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(pixels.get()));
  for (std::size_t y = 0; y < static_cast<std::size_t>(checked.size.height); ++y)
    std::memcpy(cairo_image_surface_get_data(pixels.get()) + y * stride, &picture.rgba[y * row],
                row);
  cairo_surface_mark_dirty(pixels.get());
  const Pattern pattern(cairo_pattern_create_for_surface(pixels.get()));
  paint(context, pattern.get());
  return {};
}

}  // namespace strata::report
