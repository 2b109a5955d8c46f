#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "media/picture.h"

namespace strata {

// Writes a picture as a file of JPEG or PNG while its rows come, top first, so that it is nowhere
// as a whole. The bytes mean the same as those of encode_jpeg and encode_png. Belongs to one
// thread. Throws std::runtime_error where the library fails.
class PictureWriter {
 public:
  // `jpeg` counts for JPEGs alone.
  PictureWriter(PictureFormat format, int width, int height, JpegSettings jpeg = {});
  ~PictureWriter();
  PictureWriter(PictureWriter&&) noexcept;

  // Whole rows of RGBA8, as many as there are.
  void put(std::span<const std::uint8_t> rgba);
  // After the last row, once.
  std::vector<std::uint8_t> finish();

 private:
  class File;
  class Jpeg;
  class Png;
  std::unique_ptr<File> file_;
  std::size_t row_bytes_ = 0;
};

}  // namespace strata
