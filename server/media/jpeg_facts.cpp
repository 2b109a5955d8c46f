#include "media/jpeg_facts.h"

#include <algorithm>
#include <optional>

namespace strata {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Reads numbers of a TIFF structure in its byte order. Returns nothing beyond its end.
class TiffReader {
 public:
  TiffReader(Bytes bytes, bool little) : bytes_(bytes), little_(little) {}
  std::optional<std::uint32_t> number(std::size_t at, int size) const {
    if (at > bytes_.size() || bytes_.size() - at < static_cast<std::size_t>(size))
      return std::nullopt;
    std::uint32_t value = 0;
    for (int i = 0; i < size; ++i)
      value |= std::uint32_t{bytes_[at + static_cast<std::size_t>(i)]}
               << (8 * (little_ ? i : size - 1 - i));
    return value;
  }

 private:
  Bytes bytes_;
  bool little_;
};

int orientation_of(Bytes tiff) {
  constexpr std::uint32_t kOrientation = 0x0112, kShort = 3;
  if (tiff.size() < 8 || tiff[0] != tiff[1] || (tiff[0] != 'I' && tiff[0] != 'M')) return 1;
  const TiffReader reader(tiff, tiff[0] == 'I');
  const auto directory = reader.number(4, 4);
  const auto entries = directory ? reader.number(*directory, 2) : std::nullopt;
  for (std::uint32_t i = 0; i < entries.value_or(0); ++i) {
    const std::size_t entry = std::size_t{*directory} + 2 + std::size_t{12} * i;
    const auto tag = reader.number(entry, 2), kind = reader.number(entry + 2, 2),
               value = reader.number(entry + 8, 2);
    if (!tag || !kind || !value) break;
    if (*tag == kOrientation && *kind == kShort && *value >= 1 && *value <= 8)
      return static_cast<int>(*value);
  }
  return 1;
}

}  // namespace

JpegFacts read_jpeg_facts(Bytes bytes) {
  constexpr std::uint8_t kExif[] = {'E', 'x', 'i', 'f', 0, 0};
  JpegFacts facts;
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    const std::uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff) break;
    if (marker == 0xff) {  // padding
      ++at;
      continue;
    }
    const std::size_t length = std::size_t{bytes[at + 2]} << 8 | bytes[at + 3];
    const bool is_scan = marker == 0xda || marker == 0xd9;
    if (is_scan || length < 2 || length > bytes.size() - at - 2) break;
    const Bytes content = bytes.subspan(at + 4, length - 2);
    if (marker == 0xe1 && content.size() > sizeof kExif &&
        std::equal(std::begin(kExif), std::end(kExif), content.begin()))
      facts.orientation = orientation_of(content.subspan(sizeof kExif));
    constexpr std::uint8_t kAdobe[] = {'A', 'd', 'o', 'b', 'e'};
    if (marker == 0xee && content.size() >= 12 &&
        std::equal(std::begin(kAdobe), std::end(kAdobe), content.begin()))
      facts.adobe = true;
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    // These are the markers of progressive JPEG, which has several scans.
    if (is_frame)
      facts.progressive = marker == 0xc2 || marker == 0xc6 || marker == 0xca || marker == 0xce;
    at += 2 + length;
  }
  return facts;
}

}  // namespace strata
