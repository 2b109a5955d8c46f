#include "mesh/io/gltf/meshopt_stream.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

namespace strata::mesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kSecondVersion = 0xa1;
// The largest compression ratio of a stream. Two bits encode 16 bytes of a vertex in version 0 and
// 256 bytes in version 1.
constexpr std::uint64_t kMaxGain = 64, kMaxGainOfSecond = 1024;
constexpr std::size_t kGroup = 16;
constexpr std::size_t kMinTail = 24;

std::uint8_t unzigzag(std::uint8_t v) { return static_cast<std::uint8_t>((v >> 1) ^ -(v & 1)); }
std::uint16_t unzigzag16(std::uint16_t v) {
  return static_cast<std::uint16_t>((v >> 1) ^ -(v & 1));
}

// Decodes version 1 of the attribute stream (KHR_meshopt_compression, appendix A). The library of
// Debian 12 does not support this version.
class AttributeStream {
 public:
  AttributeStream(std::span<const std::uint8_t> bytes, std::size_t count, std::size_t stride)
      : bytes_(bytes), count_(count), stride_(stride) {}

  bool decode(Bytes& out) {
    const std::size_t tail = stride_ + stride_ / 4, padded = std::max(tail, kMinTail);
    if (bytes_.size() < 1 + padded) return false;
    at_ = 1;
    end_ = bytes_.size() - padded;
    const std::uint8_t* baseline = bytes_.data() + bytes_.size() - tail;
    channels_ = std::span(baseline + stride_, stride_ / 4);
    for (const std::uint8_t mode : channels_)
      if ((mode & 15) > 2 || ((mode & 15) < 2 && mode > 15)) return false;
    std::memcpy(last_.data(), baseline, stride_);
    const std::size_t block = std::min<std::size_t>(8192 / stride_ & ~(kGroup - 1), 256);
    for (std::size_t first = 0; first < count_; first += block) {
      const std::size_t size = std::min(block, count_ - first);
      if (!read_deltas(size)) return false;
      for (std::size_t channel = 0; channel < channels_.size(); ++channel)
        add_deltas(channel, size, out.data() + first * stride_ + 4 * channel);
    }
    return at_ == end_;
  }

 private:
  // Reads the deltas of a block, ordered by the bytes of the element. The deltas of byte k begin at
  // k × 256.
  bool read_deltas(std::size_t size) {
    const std::size_t control = at_;
    if (!take(stride_ / 4)) return false;
    for (std::size_t k = 0; k < stride_; ++k) {
      std::uint8_t* out = deltas_.data() + k * 256;
      const int mode = bytes_[control + k / 4] >> 2 * (k % 4) & 3;
      if (mode == 2) {
        std::fill_n(out, size, std::uint8_t{0});
      } else if (mode == 3) {
        if (!take(size)) return false;
        std::memcpy(out, bytes_.data() + at_ - size, size);
      } else if (!read_groups(size, mode, out)) {
        return false;
      }
    }
    return true;
  }

  bool read_groups(std::size_t size, int mode, std::uint8_t* out) {
    static constexpr int kBits[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    const std::size_t groups = (size + kGroup - 1) / kGroup, header = at_;
    if (!take((groups + 3) / 4)) return false;
    for (std::size_t g = 0; g < groups; ++g, out += kGroup)
      if (!read_group(kBits[mode][bytes_[header + g / 4] >> 2 * (g % 4) & 3], out)) return false;
    return true;
  }

  // A byte after the group replaces a value with all bits set.
  bool read_group(int bits, std::uint8_t* out) {
    if (bits == 0) {
      std::fill_n(out, kGroup, std::uint8_t{0});
      return true;
    }
    const std::size_t packed = at_, each = 8 / static_cast<std::size_t>(bits);
    if (!take(kGroup / each)) return false;
    const int sentinel = (1 << bits) - 1;
    for (std::size_t i = 0; i < kGroup; ++i) {
      // For single bits, the first value is in the lowest bit. For wider values, it is in the
      // highest bits.
      const std::size_t place = bits == 1 ? i % each : each - 1 - i % each;
      const int value =
          bytes_[packed + i / each] >> (place * static_cast<std::size_t>(bits)) & sentinel;
      if (bits < 8 && value == sentinel) {
        if (!take(1)) return false;
        out[i] = bytes_[at_ - 1];
      } else {
        out[i] = static_cast<std::uint8_t>(value);
      }
    }
    return true;
  }

  void add_deltas(std::size_t channel, std::size_t size, std::uint8_t* out) {
    const std::uint8_t* deltas = deltas_.data() + 4 * channel * 256;
    std::uint8_t* last = last_.data() + 4 * channel;
    const int mode = channels_[channel] & 15, turn = channels_[channel] >> 4;
    for (std::size_t i = 0; i < size; ++i, out += stride_) {
      std::array<std::uint8_t, 4> delta;
      for (std::size_t k = 0; k < 4; ++k) delta[k] = deltas[k * 256 + i];
      if (mode == 0) {
        for (std::size_t k = 0; k < 4; ++k)
          last[k] = static_cast<std::uint8_t>(last[k] + unzigzag(delta[k]));
      } else if (mode == 1) {
        for (std::size_t k = 0; k < 4; k += 2) {
          const auto change = static_cast<std::uint16_t>(delta[k] | delta[k + 1] << 8);
          const auto sum =
              static_cast<std::uint16_t>((last[k] | last[k + 1] << 8) + unzigzag16(change));
          last[k] = static_cast<std::uint8_t>(sum);
          last[k + 1] = static_cast<std::uint8_t>(sum >> 8);
        }
      } else {
        std::uint32_t change, word;
        std::memcpy(&change, delta.data(), 4);
        std::memcpy(&word, last, 4);
        word ^= std::rotr(change, turn);  // encoders rotate left
        std::memcpy(last, &word, 4);
      }
      std::memcpy(out, last, 4);
    }
  }

  bool take(std::size_t size) {
    if (size > end_ - at_) return false;
    at_ += size;
    return true;
  }

  std::span<const std::uint8_t> bytes_, channels_;
  std::size_t count_, stride_, at_ = 0, end_ = 0;
  std::array<std::uint8_t, 256> last_{};
  std::array<std::uint8_t, 256 * 256> deltas_{};
};

// Decodes YCoCg with a precision encoded in the alpha value (appendix B, filter 4). The library
// does not support this filter either.
template <class Unsigned, class Signed>
void decode_colors(Bytes& out, std::size_t count) {
  constexpr double kMax = std::numeric_limits<Unsigned>::max();
  for (std::size_t i = 0; i < count; ++i) {
    std::array<Unsigned, 4> in;
    std::uint8_t* at = out.data() + i * sizeof in;
    std::memcpy(in.data(), at, sizeof in);
    const int scale = (1 << std::bit_width(static_cast<unsigned>(in[3]))) - 1;
    const int y = in[0], co = static_cast<Signed>(in[1]), cg = static_cast<Signed>(in[2]);
    const int alpha = in[3] & scale >> 1;
    const std::array<int, 4> rgba{y + co - cg, y + cg, y - co - cg, alpha << 1 | (alpha & 1)};
    for (std::size_t k = 0; k < 4; ++k)
      in[k] =
          scale == 0
              ? Unsigned{0}
              : static_cast<Unsigned>(std::clamp(std::round(rgba[k] * (kMax / scale)), 0.0, kMax));
    std::memcpy(at, in.data(), sizeof in);
  }
}

bool decode_attributes(std::span<const std::uint8_t> bytes, const MeshoptShape& shape, Bytes& out) {
  if (!bytes.empty() && bytes[0] == kSecondVersion)
    return std::make_unique<AttributeStream>(bytes, shape.count, shape.stride)->decode(out);
  return meshopt_decodeVertexBuffer(out.data(), shape.count, shape.stride, bytes.data(),
                                    bytes.size()) == 0;
}

}  // namespace

tl::expected<Bytes, std::string> decode_meshopt(std::span<const std::uint8_t> bytes,
                                                const MeshoptShape& shape,
                                                std::uint64_t most_bytes) {
  const auto& [mode, filter, count, stride] = shape;
  const bool attributes = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES",
             indices = mode == "INDICES";
  const bool plain = filter.empty() || filter == "NONE";
  if (!attributes && !triangles && !indices)
    return tl::unexpected("it has no mode \"" + mode.substr(0, 40) + "\"");
  if (attributes ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
    return tl::unexpected("elements of " + std::to_string(stride) +
                          " bytes are not possible in the mode " + mode);
  if (triangles && count % 3 != 0)
    return tl::unexpected("its " + std::to_string(count) + " indices are not a multiple of three");
  const bool fits =
      plain || (attributes && ((filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                               (filter == "QUATERNION" && stride == 8) || filter == "EXPONENTIAL" ||
                               (filter == "COLOR" && (stride == 4 || stride == 8))));
  if (!fits)
    return tl::unexpected("the filter \"" + filter.substr(0, 40) +
                          "\" is not possible for elements of " + std::to_string(stride) +
                          " bytes in the mode " + mode);
  const bool second = attributes && !bytes.empty() && bytes[0] == kSecondVersion;
  if (count > 256 + (bytes.size() + 64) * (second ? kMaxGainOfSecond : kMaxGain) / stride)
    return tl::unexpected("its " + std::to_string(bytes.size()) + " bytes cannot hold " +
                          std::to_string(count) + " elements");
  if (count > most_bytes / stride) return tl::unexpected(std::string("it becomes too large"));
  Bytes out(count * stride);
  if (count == 0) return out;
  const bool done =
      attributes
          ? decode_attributes(bytes, shape, out)
          : (triangles
                 ? meshopt_decodeIndexBuffer(out.data(), count, stride, bytes.data(), bytes.size())
                 : meshopt_decodeIndexSequence(out.data(), count, stride, bytes.data(),
                                               bytes.size())) == 0;
  if (!done) return tl::unexpected(std::string("it is damaged"));
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
  if (filter == "COLOR" && stride == 4) decode_colors<std::uint8_t, std::int8_t>(out, count);
  if (filter == "COLOR" && stride == 8) decode_colors<std::uint16_t, std::int16_t>(out, count);
  return out;
}

}  // namespace strata::mesh
