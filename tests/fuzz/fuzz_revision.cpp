// Fuzzes stored tiles and revisions, which come from a database that other programs can write to.
// The first byte selects the layer's type. The rest is tried in two ways: unchanged, and as the
// content of a complete frame, because a fuzzer rarely makes a frame of the right size.
#include <zstd.h>

#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "domain/layers/revision.h"
#include "domain/layers/tile_segment.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

void decode(ValueType type, std::span<const std::uint8_t> bytes) {
  if (const auto tile = decode_tile(type, bytes)) {
    const auto again = decode_tile(type, encode_tile(*tile));
    demand(again.has_value() && *again == *tile);
  }
  const TileAddress address{3, 4};
  if (const auto revision = decode_revision(address, type, bytes)) {
    const auto again = decode_revision(address, type, encode_revision(*revision));
    demand(again.has_value() && *again == *revision);
    TileData tile(type);
    apply(*revision, tile);
    apply(*revision, tile);
    demand(tile == TileData(type));
  }
  if (const auto segment = decode_segment(address, type, bytes)) {
    const auto stored = encode_segment(*segment);
    demand(stored.has_value());
    const auto again = decode_segment(address, type, *stored);
    demand(again.has_value() && *again == *segment);
    demand(tile_in_segment(type, *stored, segment->entries.back().sequence).has_value());
  }
}

void decode_framed(ValueType type, std::uint8_t version, const std::vector<std::uint8_t>& raw) {
  std::vector<std::uint8_t> framed{version, static_cast<std::uint8_t>(bytes_per_texel(type))};
  framed.resize(2 + ZSTD_compressBound(raw.size()));
  const std::size_t frame =
      ZSTD_compress(framed.data() + 2, framed.size() - 2, raw.data(), raw.size(), 1);
  demand(!ZSTD_isError(frame));
  framed.resize(2 + frame);
  decode(type, framed);
}

// Fills a mask for each plane, and the values of a tile, with the bytes.
std::vector<std::uint8_t> planes_of(ValueType type, std::size_t planes,
                                    std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> raw(planes * sizeof(TileMask::words) + TileData(type).values.size());
  for (std::size_t i = 0; i < raw.size() && !bytes.empty(); ++i) raw[i] = bytes[i % bytes.size()];
  return raw;
}

// One revision whose kind is the first byte, over a tile of the other bytes.
std::vector<std::uint8_t> segment_of(ValueType type, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> raw{1, 7, 0, 0, 0, 0, 0, 0, 0, static_cast<std::uint8_t>(bytes[0] % 4)};
  const auto before = planes_of(type, 1, bytes);
  raw.insert(raw.end(), before.begin(), before.end());
  raw.insert(raw.end(), bytes.begin(), bytes.end());
  return raw;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto type = static_cast<ValueType>(data[0] % 8);
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  decode(type, bytes);
  decode_framed(type, 1, planes_of(type, 2, bytes));
  decode_framed(type, 129, planes_of(type, 1, bytes));
  decode_framed(type, 65, segment_of(type, bytes));
  return 0;
}
