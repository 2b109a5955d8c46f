#include "domain/layers/tile_segment.h"

#include <zstd.h>

#include <cstring>
#include <limits>

#include "domain/layers/mask_texels.h"

namespace strata {
namespace {

// The stored format: one byte for the version, one byte for the width of a texel, then a zstd frame
// with, in sequence,
// - the number of revisions (one byte), their sequences (8 bytes each, little-endian), and the kind
//   of each revision (one byte each),
// - the tile before them: `valid` and the values,
// - for each revision the mask of written texels, and then, depending on the kind, nothing, the
//   bits of the value (4 bytes), or the valid texels among the written ones (a mask) and the values
//   of the written texels.
constexpr std::uint8_t kSegmentVersion = 65;
constexpr std::size_t kHeaderBytes = 2;
// Segments are made in the background. A high level finds the outlines of earlier revisions in
// later ones.
constexpr int kZstdLevel = 12;

enum class Kind : std::uint8_t { erased = 0, one_value = 1, values = 2 };

constexpr std::size_t kMaskBytes = sizeof(TileMask::words);

class Writer {
 public:
  void put(const void* data, std::size_t bytes) {
    const auto* p = static_cast<const std::uint8_t*>(data);
    raw_.insert(raw_.end(), p, p + bytes);
  }
  void put(const TileMask& mask) { put(mask.words.data(), kMaskBytes); }
  void put_byte(std::uint8_t byte) { raw_.push_back(byte); }
  const std::vector<std::uint8_t>& raw() const { return raw_; }

 private:
  std::vector<std::uint8_t> raw_;
};

// Reads return false at the end of the data.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> raw) : raw_(raw) {}
  bool take(void* data, std::size_t bytes) {
    if (raw_.size() < bytes) return false;
    std::memcpy(data, raw_.data(), bytes);
    raw_ = raw_.subspan(bytes);
    return true;
  }
  bool take(TileMask& mask) { return take(mask.words.data(), kMaskBytes); }
  bool at_end() const { return raw_.empty(); }

 private:
  std::span<const std::uint8_t> raw_;
};

tl::unexpected<Error> damaged(const char* why) {
  return fail(ErrorCode::internal, "Damaged tile", std::string("A stored segment ") + why);
}

// The kind of a revision, and the bits of its value if it wrote one value to all texels.
struct Written {
  Kind kind = Kind::values;
  std::uint32_t bits = 0;
};

Written written_by(const TileMask& mask, const TileData& after) {
  std::optional<bool> valid;
  std::uint32_t bits = 0;
  bool is_uniform = true;
  for_each_texel(mask, [&](int texel) {
    if (!valid) {
      valid = after.valid.test(texel);
      bits = after.bits(texel);
    } else if (*valid != after.valid.test(texel) || bits != after.bits(texel)) {
      is_uniform = false;
    }
  });
  if (!is_uniform) return {};
  if (!valid || !*valid) return {Kind::erased, 0};
  return {Kind::one_value, bits};
}

void put_values(const TileMask& mask, const TileData& after, Writer& out) {
  TileMask valid;
  for (int w = 0; w < kMaskWords; ++w) valid.words[w] = after.valid.words[w] & mask.words[w];
  out.put(valid);
  const auto width = static_cast<std::size_t>(after.texel_bytes());
  for_each_texel(mask, [&](int texel) {
    out.put(&after.values[static_cast<std::size_t>(texel) * width], width);
  });
}

// Reads a segment entry by entry, up to the last revision whose sequence is at most `until`. Leaves
// the tile after it in `tile`. `on_begin(tile)` gets the tile before the revisions, and
// `on_entry(sequence, written, tile)` the tile after each of them.
template <class OnBegin, class OnEntry>
Result<void> replay(std::span<const std::uint8_t> raw, std::int64_t until, TileData& tile,
                    OnBegin on_begin, OnEntry on_entry) {
  Reader in(raw);
  std::uint8_t count = 0;
  if (!in.take(&count, 1) || count == 0 || count > TileSegment::kMaxRevisions)
    return damaged("has a wrong number of revisions.");
  std::vector<std::int64_t> sequences(count);
  std::vector<Kind> kinds(count);
  if (!in.take(sequences.data(), sequences.size() * sizeof(std::int64_t)) ||
      !in.take(kinds.data(), kinds.size()) || !in.take(tile.valid) ||
      !in.take(tile.values.data(), tile.values.size()))
    return damaged("is too short.");
  const auto width = static_cast<std::size_t>(tile.texel_bytes());
  on_begin(tile);
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    if (sequences[i] <= (i == 0 ? 0 : sequences[i - 1]))
      return damaged("has revisions in the wrong order.");
    if (sequences[i] > until) return {};
    TileMask mask, valid;
    std::uint32_t bits = 0;
    bool is_complete = in.take(mask);
    switch (kinds[i]) {
      case Kind::erased: for_each_texel(mask, [&](int texel) { tile.clear(texel); }); break;
      case Kind::one_value:
        is_complete = is_complete && in.take(&bits, sizeof(bits));
        for_each_texel(mask, [&](int texel) { tile.write(texel, bits); });
        break;
      case Kind::values:
        is_complete = is_complete && in.take(valid);
        for_each_texel(mask, [&](int texel) {
          std::uint32_t value = 0;
          is_complete = is_complete && in.take(&value, width);
          if (valid.test(texel))
            tile.write(texel, value);
          else
            tile.clear(texel);
        });
        break;
      default: return damaged("has an unknown kind of revision.");
    }
    if (!is_complete) return damaged("is too short.");
    on_entry(sequences[i], mask, tile);
  }
  return in.at_end() ? Result<void>{} : damaged("is too long.");
}

// The largest segment that `encode_segment` can make for the type.
std::size_t max_raw_bytes(int width) {
  const std::size_t tile = kMaskBytes + std::size_t{kTexelsPerTile} * static_cast<unsigned>(width);
  return 1 + tile + TileSegment::kMaxRevisions * (sizeof(std::int64_t) + 1 + kMaskBytes + tile);
}

Result<std::vector<std::uint8_t>> decompress(ValueType type, std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes) return damaged("is too short.");
  if (bytes[0] != kSegmentVersion) return damaged("has an unknown version.");
  if (bytes[1] != bytes_per_texel(type)) return damaged("has a different texel width.");
  const std::span<const std::uint8_t> frame = bytes.subspan(kHeaderBytes);
  const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  // Larger than any size: the size is unknown, or the frame is damaged.
  if (size > max_raw_bytes(bytes[1])) return damaged("has a wrong decompressed size.");
  std::vector<std::uint8_t> raw(static_cast<std::size_t>(size));
  const std::size_t n = ZSTD_decompress(raw.data(), raw.size(), frame.data(), frame.size());
  if (ZSTD_isError(n) || n != raw.size()) return damaged("has a wrong decompressed size.");
  return raw;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> encode_segment(const TileSegment& segment) {
  const auto& entries = segment.entries;
  if (entries.empty() || entries.size() > TileSegment::kMaxRevisions) return std::nullopt;
  std::vector<Kind> kinds;
  Writer written;
  TileData tile = segment.before;
  for (const auto& [sequence, revision] : entries) {
    if (!differs_only_where_written(revision)) return std::nullopt;
    apply(revision, tile);
    const Written what = written_by(revision.written, tile);
    kinds.push_back(what.kind);
    written.put(revision.written);
    if (what.kind == Kind::one_value) written.put(&what.bits, sizeof(what.bits));
    if (what.kind == Kind::values) put_values(revision.written, tile, written);
  }
  Writer raw;
  raw.put_byte(static_cast<std::uint8_t>(entries.size()));
  for (const auto& entry : entries) raw.put(&entry.sequence, sizeof(entry.sequence));
  raw.put(kinds.data(), kinds.size());
  raw.put(segment.before.valid);
  raw.put(segment.before.values.data(), segment.before.values.size());
  raw.put(written.raw().data(), written.raw().size());

  std::vector<std::uint8_t> out(kHeaderBytes + ZSTD_compressBound(raw.raw().size()));
  out[0] = kSegmentVersion;
  out[1] = static_cast<std::uint8_t>(segment.before.texel_bytes());
  const std::size_t n = ZSTD_compress(out.data() + kHeaderBytes, out.size() - kHeaderBytes,
                                      raw.raw().data(), raw.raw().size(), kZstdLevel);
  if (ZSTD_isError(n)) return std::nullopt;
  out.resize(kHeaderBytes + n);
  return out;
}

Result<TileSegment> decode_segment(TileAddress address, ValueType type,
                                   std::span<const std::uint8_t> bytes) {
  const auto raw = STRATA_TRY(decompress(type, bytes));
  TileSegment segment;
  TileData tile(type), previous(type);
  STRATA_TRY(replay(
      raw, std::numeric_limits<std::int64_t>::max(), tile,
      [&](const TileData& before) { segment.before = previous = before; },
      [&](std::int64_t sequence, const TileMask& written, const TileData& after) {
        segment.entries.push_back({sequence, make_revision(address, previous, after, written)});
        previous = after;
      }));
  return segment;
}

Result<TileData> tile_in_segment(ValueType type, std::span<const std::uint8_t> bytes,
                                 std::int64_t sequence) {
  const auto raw = STRATA_TRY(decompress(type, bytes));
  TileData tile(type);
  STRATA_TRY(replay(
      raw, sequence, tile, [](const TileData&) {},
      [](std::int64_t, const TileMask&, const TileData&) {}));
  return tile;
}

}  // namespace strata
