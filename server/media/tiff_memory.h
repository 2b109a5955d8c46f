#pragma once

#include <tiffio.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace strata {

// TIFF files in memory, for libtiff. The size of single allocations that a file can cause is
// limited.

// The limit for tiles of a TIFF. Files with larger tiles are rejected.
constexpr std::uint64_t kMaxTiffTileBytes = 256u << 20;

// A file in memory, and the first error message of libtiff for it.
struct TiffMemory {
  std::span<const std::uint8_t> in;          // for reading
  std::vector<std::uint8_t>* out = nullptr;  // for writing
  std::uint64_t at = 0;
  std::string complaint;

  std::uint64_t size() const { return out ? out->size() : in.size(); }
};

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

// Returns null if the file cannot be opened. `file.complaint` is then the reason. `file` must
// outlive the result.
Tiff open_tiff(TiffMemory& file, const char* mode);

// Returns the value of a tag in the current directory. If the file lacks the tag, returns its
// default, or 0 without a default.
template <class T>
T tiff_tag(TIFF* tiff, std::uint32_t tag) {
  T value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

// Returns whether a compression is lossless. Other compressions change values, and have a larger
// attack surface.
bool is_lossless(int compression);

}  // namespace strata
