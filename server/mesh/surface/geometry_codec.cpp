#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

#include "mesh/surface/geometry.h"

// The stored form, little-endian:
//   "SGEO" · version u8 · zstd frame (with content size and checksum) of
//   u64 positions, vertices, indices · f64 origin[3] · planes(positions x, y, z as u64) ·
//   planes(vertex normal, uv.x, uv.y, color, position index as u32) · planes(index codes as u32) ·
//   only in version 3: u32 ends of parts
// "planes" is a column of integers. Each integer is replaced by its zigzag difference from the
// previous one. The differences are stored byte plane by byte plane. Neighbors on the Hilbert curve
// differ little, so the high planes are almost entirely zero. Vertex positions and the box are
// computed from the other data and not stored.

namespace strata::mesh {
namespace {

constexpr char kMagic[4] = {'S', 'G', 'E', 'O'};
// In version 1 the highest byte of a color was the alpha of the file, which was not used. A
// geometry without parts has version 2, which earlier servers can read.
constexpr std::uint8_t kVersion = 2, kVersionWithoutOpenness = 1, kVersionWithParts = 3;
constexpr std::uint32_t kOpen = 0xff000000u;
constexpr int kLevel = 1;
constexpr std::size_t kHeaderBytes = 3 * 8 + 3 * 8;
constexpr std::size_t kPositionBytes = 3 * 8, kVertexBytes = 5 * 4, kIndexBytes = 4, kPartBytes = 4;

tl::unexpected<Error> damaged(const std::string& what) {
  return fail(ErrorCode::internal, "Stored geometry damaged",
              "The stored geometry cannot be read: " + what +
                  ". Restore it from a backup or import the model again.");
}

template <class Bits>
Bits zigzag(Bits difference) {
  return static_cast<Bits>((difference << 1) ^ (Bits{0} - (difference >> (8 * sizeof(Bits) - 1))));
}
template <class Bits>
Bits unzigzag(Bits code) {
  return static_cast<Bits>((code >> 1) ^ (Bits{0} - (code & 1)));
}

// Writes `count` values of `value(i)` as planes to `out` and moves `out` past them.
template <class Bits, class Value>
void write_planes(std::uint8_t*& out, std::size_t count, Value value) {
  Bits before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Bits now = value(i);
    const Bits code = zigzag<Bits>(now - before);
    before = now;
    for (std::size_t plane = 0; plane < sizeof(Bits); ++plane) {
      out[plane * count + i] = static_cast<std::uint8_t>(code >> (8 * plane));
    }
  }
  out += sizeof(Bits) * count;
}

template <class Bits, class Take>
void read_planes(const std::uint8_t*& in, std::size_t count, Take take) {
  Bits value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Bits code = 0;
    for (std::size_t plane = 0; plane < sizeof(Bits); ++plane)
      code |= static_cast<Bits>(Bits{in[plane * count + i]} << (8 * plane));
    value = static_cast<Bits>(value + unzigzag(code));
    take(i, value);
  }
  in += sizeof(Bits) * count;
}

std::vector<std::uint8_t> serialize(const Geometry& geometry) {
  const std::size_t positions = geometry.positions.size(), vertices = geometry.vertices.size(),
                    indices = geometry.indices.size();
  std::vector<std::uint8_t> bytes(kHeaderBytes + positions * kPositionBytes +
                                  vertices * kVertexBytes + indices * kIndexBytes +
                                  geometry.part_ends.size() * kPartBytes);
  std::uint8_t* out = bytes.data();
  const std::uint64_t counts[3] = {positions, vertices, indices};
  std::memcpy(out, counts, sizeof counts);
  const double origin[3] = {geometry.origin.x, geometry.origin.y, geometry.origin.z};
  std::memcpy(out + sizeof counts, origin, sizeof origin);
  out += kHeaderBytes;
  for (int axis = 0; axis < 3; ++axis) {
    write_planes<std::uint64_t>(out, positions, [&](std::size_t i) {
      return std::bit_cast<std::uint64_t>(geometry.positions[i][axis]);
    });
  }
  const std::vector<Vertex>& v = geometry.vertices;
  write_planes<std::uint32_t>(out, vertices, [&](std::size_t i) { return v[i].normal; });
  write_planes<std::uint32_t>(
      out, vertices, [&](std::size_t i) { return std::bit_cast<std::uint32_t>(v[i].uv.x); });
  write_planes<std::uint32_t>(
      out, vertices, [&](std::size_t i) { return std::bit_cast<std::uint32_t>(v[i].uv.y); });
  write_planes<std::uint32_t>(out, vertices, [&](std::size_t i) { return v[i].color; });
  write_planes<std::uint32_t>(out, vertices, [&](std::size_t i) { return v[i].position_index; });
  write_planes<std::uint32_t>(out, indices, [&](std::size_t i) { return geometry.indices[i]; });
  if (!geometry.part_ends.empty())
    std::memcpy(out, geometry.part_ends.data(), geometry.part_ends.size() * kPartBytes);
  return bytes;
}

// Takes the ends of parts from the rest of the content. Returns false if they are not ascending, or
// if parts share a vertex or a position.
bool take_parts(std::span<const std::uint8_t> rest, Geometry& geometry) {
  std::vector<std::uint32_t>& ends = geometry.part_ends;
  ends.resize(rest.size() / kPartBytes);
  std::memcpy(ends.data(), rest.data(), rest.size());
  if (!std::ranges::is_sorted(ends) || ends.back() != geometry.triangle_count()) return false;
  std::uint32_t first_vertex = 0, first_position = 0, begin = 0;
  for (const std::uint32_t end : ends) {
    std::uint32_t end_vertex = first_vertex, end_position = first_position;
    for (std::size_t i = 3 * std::size_t{begin}; i < 3 * std::size_t{end}; ++i) {
      const std::uint32_t vertex = geometry.indices[i];
      const std::uint32_t position = geometry.vertices[vertex].position_index;
      if (vertex < first_vertex || position < first_position) return false;
      end_vertex = std::max(end_vertex, vertex + 1);
      end_position = std::max(end_position, position + 1);
    }
    begin = end;
    first_vertex = end_vertex;
    first_position = end_position;
  }
  return true;
}

Result<Geometry> deserialize(const std::vector<std::uint8_t>& bytes, bool has_parts) {
  if (bytes.size() < kHeaderBytes) return damaged("it is incomplete");
  std::uint64_t counts[3];
  std::memcpy(counts, bytes.data(), sizeof counts);
  const std::uint64_t positions = counts[0], vertices = counts[1], indices = counts[2];
  constexpr std::uint64_t kMax = 0xffffffffu;
  const std::uint64_t used =
      kHeaderBytes + positions * kPositionBytes + vertices * kVertexBytes + indices * kIndexBytes;
  const std::uint64_t rest = bytes.size() - std::min<std::uint64_t>(used, bytes.size());
  const bool fits =
      bytes.size() >= used &&
      (has_parts ? rest > 0 && rest <= kMaxModelParts * kPartBytes && rest % kPartBytes == 0
                 : rest == 0);
  if (positions > kMax || vertices > kMax || indices > kMax || indices % 3 != 0 || !fits)
    return damaged("its counts do not match its size");
  Geometry geometry;
  double origin[3];
  std::memcpy(origin, bytes.data() + sizeof counts, sizeof origin);
  geometry.origin = {origin[0], origin[1], origin[2]};
  bool finite = std::isfinite(origin[0]) && std::isfinite(origin[1]) && std::isfinite(origin[2]);
  const std::uint8_t* in = bytes.data() + kHeaderBytes;
  geometry.positions.resize(positions);
  geometry.vertices.resize(vertices);
  geometry.indices.resize(indices);
  for (int axis = 0; axis < 3; ++axis) {
    read_planes<std::uint64_t>(in, positions, [&](std::size_t i, std::uint64_t bits) {
      const double value = std::bit_cast<double>(bits);
      finite = finite && std::isfinite(value);
      geometry.positions[i][axis] = value;
    });
  }
  std::vector<Vertex>& v = geometry.vertices;
  bool in_range = true;
  read_planes<std::uint32_t>(in, vertices,
                             [&](std::size_t i, std::uint32_t bits) { v[i].normal = bits; });
  read_planes<std::uint32_t>(in, vertices, [&](std::size_t i, std::uint32_t bits) {
    v[i].uv.x = std::bit_cast<float>(bits);
  });
  read_planes<std::uint32_t>(in, vertices, [&](std::size_t i, std::uint32_t bits) {
    v[i].uv.y = std::bit_cast<float>(bits);
  });
  read_planes<std::uint32_t>(in, vertices,
                             [&](std::size_t i, std::uint32_t bits) { v[i].color = bits; });
  read_planes<std::uint32_t>(in, vertices, [&](std::size_t i, std::uint32_t bits) {
    v[i].position_index = bits;
    in_range = in_range && bits < positions;
  });
  read_planes<std::uint32_t>(in, indices, [&](std::size_t i, std::uint32_t bits) {
    geometry.indices[i] = bits;
    in_range = in_range && bits < vertices;
  });
  if (!in_range) return damaged("an index is out of range");
  if (has_parts && !take_parts(std::span(bytes).subspan(used), geometry))
    return damaged("its parts are not separate");
  for (Vertex& vertex : v) {
    vertex.position = glm::vec3(geometry.positions[vertex.position_index] - geometry.origin);
    finite = finite && std::isfinite(vertex.position.x) && std::isfinite(vertex.position.y) &&
             std::isfinite(vertex.position.z) && std::isfinite(vertex.uv.x) &&
             std::isfinite(vertex.uv.y);
  }
  if (!finite) return damaged("a number in it is not finite");
  find_boxes(geometry);
  return geometry;
}

}  // namespace

std::vector<std::uint8_t> encode_geometry(const Geometry& geometry) {
  const std::vector<std::uint8_t> content = serialize(geometry);
  const std::size_t prefix = sizeof kMagic + 1;
  std::vector<std::uint8_t> result(prefix + ZSTD_compressBound(content.size()));
  std::copy(std::begin(kMagic), std::end(kMagic), result.begin());
  result[sizeof kMagic] = geometry.part_ends.empty() ? kVersion : kVersionWithParts;
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     &ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  const std::size_t size = ZSTD_compress2(context.get(), result.data() + prefix,
                                          result.size() - prefix, content.data(), content.size());
  if (ZSTD_isError(size)) throw std::bad_alloc();  // the target is large, so only memory can fail
  result.resize(prefix + size);
  result.shrink_to_fit();
  return result;
}

Result<Geometry> decode_geometry(std::span<const std::uint8_t> bytes) {
  const std::size_t prefix = sizeof kMagic + 1;
  if (bytes.size() <= prefix || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    return damaged("it does not begin like stored geometry");
  const std::uint8_t version = bytes[sizeof kMagic];
  if (version != kVersion && version != kVersionWithoutOpenness && version != kVersionWithParts)
    return damaged("it has version " + std::to_string(version) +
                   ", this server reads versions 1 to 3");
  const std::span<const std::uint8_t> frame = bytes.subspan(prefix);
  const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  // Geometry never compresses by a factor of 1000. A larger size indicates damage, and no memory is
  // allocated for it.
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN ||
      size / 1000 > frame.size() + 65536) {
    return damaged("its size is wrong");
  }
  if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size())
    return damaged("it has too few or too many bytes");
  std::vector<std::uint8_t> content(size);
  const std::size_t read =
      ZSTD_decompress(content.data(), content.size(), frame.data(), frame.size());
  if (ZSTD_isError(read) || read != size) return damaged("its checksum does not match");
  auto geometry = STRATA_TRY(deserialize(content, version == kVersionWithParts));
  if (version == kVersionWithoutOpenness)
    for (Vertex& vertex : geometry.vertices) vertex.color |= kOpen;
  return geometry;
}

}  // namespace strata::mesh
