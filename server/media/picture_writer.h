#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "media/picture.h"

namespace strata {

// Writes an image as a JPEG or PNG file, row by row, top row first. So the whole image is never in
// memory. The file has the same pixels as a file of encode_jpeg or encode_png. Not thread-safe.
// Throws std::runtime_error if the library fails.
class PictureWriter {
 public:
  // `jpeg` is used for JPEG only.
  PictureWriter(PictureFormat format, int width, int height, JpegSettings jpeg = {});
  ~PictureWriter();
  PictureWriter(PictureWriter&&) noexcept;

  // Appends whole rows of RGBA8 pixels.
  void put(std::span<const std::uint8_t> rgba);
  // Returns the file. Call it once, after the last row.
  std::vector<std::uint8_t> finish();

 private:
  class File;
  class Jpeg;
  class Png;
  std::unique_ptr<File> file_;
  std::size_t row_bytes_ = 0;
};

}  // namespace strata
