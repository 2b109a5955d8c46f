// Fuzzes files of records: their type from the first bytes, independent of the name, and
// thumbnails.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "media/jpeg_facts.h"
#include "media/media_type.h"
#include "media/picture.h"
#include "media/thumbnail.h"

namespace {

constexpr int kSide = 16;
constexpr strata::ThumbnailLimits kLimits{512 * 512, 512 * 512};  // larger images only take longer

void demand(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const auto type = strata::sniff_media_type(bytes, "photo.jpg");
  demand(type.find('/') != std::string::npos);
  const auto facts = strata::read_jpeg_facts(bytes);
  demand(facts.orientation >= 1 && facts.orientation <= 8);
  const auto small = strata::make_thumbnail(bytes, kSide, kLimits);
  if (!small) {
    demand(small.error().code == strata::ErrorCode::unsupported ||
           small.error().code == strata::ErrorCode::invalid);
    return 0;
  }
  demand(type == "image/jpeg" || type == "image/png");
  const auto info = strata::inspect_picture(*small);
  demand(info && info->format == strata::PictureFormat::jpeg && info->width <= kSide &&
         info->height <= kSide);
  return 0;
}
