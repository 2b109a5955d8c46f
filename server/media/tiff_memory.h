#pragma once

#include <tiffio.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace strata {

// TIFF files in memory, for libtiff. What a file may make it allocate at once is bounded.

// of a file's own tiles; larger ones are refused
constexpr std::uint64_t kMaxTiffTileBytes = 256u << 20;

// A file in memory, and libtiff's first complaint about it.
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

// Null: it cannot be opened, see the complaint. `file` outlives the result.
Tiff open_tiff(TiffMemory& file, const char* mode);

// Of the directory that is open; its default where the file has none, otherwise 0.
template <class T>
T tiff_tag(TIFF* tiff, std::uint32_t tag) {
  T value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

// Of a compression code: the others change values, and are the larger attack surface.
bool is_lossless(int compression);

}  // namespace strata
