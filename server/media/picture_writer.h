#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "media/picture.h"

namespace strata {

// Writes a picture as a JPEG or PNG file row by row, top first, so that the whole picture is never
// in memory. The result decodes as that of encode_jpeg and encode_png. Belongs to one thread.
// Throws std::runtime_error if the library fails.
class PictureWriter {
 public:
  // `jpeg` is for JPEGs only.
  PictureWriter(PictureFormat format, int width, int height, JpegSettings jpeg = {});
  ~PictureWriter();
  PictureWriter(PictureWriter&&) noexcept;

  // Appends whole rows of RGBA8.
  void put(std::span<const std::uint8_t> rgba);
  // Call once, after the last row.
  std::vector<std::uint8_t> finish();

 private:
  class File;
  class Jpeg;
  class Png;
  std::unique_ptr<File> file_;
  std::size_t row_bytes_ = 0;
};

}  // namespace strata
