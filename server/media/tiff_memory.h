#pragma once

#include <tiffio.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace strata {

// TIFF files in memory, for libtiff. Limits single allocations that a file can cause.

// of a file's own tiles; larger ones are refused
constexpr std::uint64_t kMaxTiffTileBytes = 256u << 20;

// A file in memory, and the first error message of libtiff about it.
struct TiffMemory {
  std::span<const std::uint8_t> in;          // reading
  std::vector<std::uint8_t>* out = nullptr;  // writing
  std::uint64_t at = 0;
  std::string complaint;

  std::uint64_t size() const { return out ? out->size() : in.size(); }
};

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

// Null: the file cannot be opened; see the message. `file` must outlive the result.
Tiff open_tiff(TiffMemory& file, const char* mode);

// Returns a tag of the open directory; its default if the file has none, otherwise 0.
template <class T>
T tiff_tag(TIFF* tiff, std::uint32_t tag) {
  T value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

// Whether a compression is lossless: others change values, and are a larger attack surface.
bool is_lossless(int compression);

}  // namespace strata
