#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "media/picture.h"
#include "report/document.h"

namespace strata::report {

inline constexpr std::size_t kMaxPictureBytes = std::size_t{256} * 1024 * 1024;
inline constexpr std::int64_t kMaxPicturePixels = 100'000'000;

// An upright JPEG (gray or RGB) or PNG.
struct PictureBytes {
  PictureFormat format = PictureFormat::png;
  int width = 0, height = 0;  // pixels
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  bool is_source = true;  // false for a JPEG that was turned or converted to RGB
};

// Returns the bytes of a picture without a check of their content. `place` is the place of the
// picture in the document.
Result<std::shared_ptr<const std::vector<std::uint8_t>>> read_bytes(const PictureSource& source,
                                                                    const std::string& place);

// Reads a picture. Decodes it to find damage, which needs up to twice the memory of the pixels.
// Returns the errors of writers.h.
Result<PictureBytes> read_picture(const PictureSource& source, const std::string& place);

}  // namespace strata::report
