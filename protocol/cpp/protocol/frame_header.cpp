#include "protocol/frame_header.h"

#include <algorithm>
#include <cassert>
#include <string>

namespace strata::protocol {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'S', 'T', 'R', 'F'};
constexpr std::uint16_t kKeyframe = 1, kStill = 2, kLast = 4;

template <class T>
void put(std::span<std::uint8_t> bytes, std::size_t offset, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bytes[offset + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

template <class T>
T get(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value |= std::uint64_t{bytes[offset + i]} << (8 * i);
  return static_cast<T>(value);
}

tl::unexpected<Error> broken(const char* field, std::string detail) {
  return fail(ErrorCode::malformed, "Frame not usable", std::move(detail), field);
}

// Checks rules 5 to 10 of frame.md, which are conditions on several members.
Result<void> check(const FrameHeader& h) {
  if (h.view_id > 15) return broken("view_id", "A view is 0 to 15.");
  if (h.camera_seq > kMaxSafeInteger) return broken("camera_seq", "It is at most 2^53 - 1.");
  if (h.scene_sequence > kMaxSafeInteger)
    return broken("scene_sequence", "It is at most 2^53 - 1.");
  if (h.full_width < 1 || h.full_width > kMaxFrameSize)
    return broken("full_width", "A picture is 1 to 8192 pixels wide.");
  if (h.full_height < 1 || h.full_height > kMaxFrameSize)
    return broken("full_height", "A picture is 1 to 8192 pixels high.");
  if (h.width < 1 || h.x + h.width > h.full_width)
    return broken("width", "The rectangle lies within the picture.");
  if (h.height < 1 || h.y + h.height > h.full_height)
    return broken("height", "The rectangle lies within the picture.");
  if (h.keyframe && (h.width != h.full_width || h.height != h.full_height))
    return broken("keyframe", "A keyframe is the whole picture.");
  if (h.payload_bytes < 1) return broken("payload_bytes", "A rectangle has bytes.");
  return {};
}

}  // namespace

std::array<std::uint8_t, kFrameHeaderBytes> encode_frame_header(const FrameHeader& h) {
  assert(check(h));
  std::array<std::uint8_t, kFrameHeaderBytes> bytes{};
  std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
  const std::uint16_t flags = static_cast<std::uint16_t>(
      (h.keyframe ? kKeyframe : 0) | (h.still ? kStill : 0) | (h.last ? kLast : 0));
  put<std::uint8_t>(bytes, 4, kFrameVersion);
  put<std::uint8_t>(bytes, 5, static_cast<std::uint8_t>(h.codec));
  put<std::uint16_t>(bytes, 6, flags);
  put<std::uint32_t>(bytes, 8, h.view_id);
  put<std::uint32_t>(bytes, 12, h.frame);
  put<std::uint64_t>(bytes, 16, h.camera_seq);
  put<std::uint64_t>(bytes, 24, h.scene_sequence);
  put<std::uint16_t>(bytes, 32, static_cast<std::uint16_t>(h.x));
  put<std::uint16_t>(bytes, 34, static_cast<std::uint16_t>(h.y));
  put<std::uint16_t>(bytes, 36, static_cast<std::uint16_t>(h.width));
  put<std::uint16_t>(bytes, 38, static_cast<std::uint16_t>(h.height));
  put<std::uint16_t>(bytes, 40, static_cast<std::uint16_t>(h.full_width));
  put<std::uint16_t>(bytes, 42, static_cast<std::uint16_t>(h.full_height));
  put<std::uint32_t>(bytes, 44, h.render_us);
  put<std::uint32_t>(bytes, 48, h.encode_us);
  put<std::uint32_t>(bytes, 52, h.payload_bytes);
  return bytes;
}

Result<FrameHeader> decode_frame_header(std::span<const std::uint8_t> message) {
  if (message.size() < kFrameHeaderBytes)
    return broken("message", "A frame has at least 56 bytes.");
  if (!std::equal(kMagic.begin(), kMagic.end(), message.begin()))
    return broken("magic", "A frame starts with STRF.");
  if (message[4] != kFrameVersion) return broken("version", "Only version 1 is known.");
  const auto codec = static_cast<FrameCodec>(message[5]);
  if (codec != FrameCodec::jpeg && codec != FrameCodec::png)
    return broken("codec", "Known are 1 (JPEG) and 2 (PNG).");
  const auto flags = get<std::uint16_t>(message, 6);
  if ((flags & ~(kKeyframe | kStill | kLast)) != 0)
    return broken("flags", "Bits above the third are zero.");
  FrameHeader h;
  h.codec = codec;
  h.keyframe = (flags & kKeyframe) != 0;
  h.still = (flags & kStill) != 0;
  h.last = (flags & kLast) != 0;
  h.view_id = get<std::uint32_t>(message, 8);
  h.frame = get<std::uint32_t>(message, 12);
  h.camera_seq = get<std::uint64_t>(message, 16);
  h.scene_sequence = get<std::uint64_t>(message, 24);
  h.x = get<std::uint16_t>(message, 32);
  h.y = get<std::uint16_t>(message, 34);
  h.width = get<std::uint16_t>(message, 36);
  h.height = get<std::uint16_t>(message, 38);
  h.full_width = get<std::uint16_t>(message, 40);
  h.full_height = get<std::uint16_t>(message, 42);
  h.render_us = get<std::uint32_t>(message, 44);
  h.encode_us = get<std::uint32_t>(message, 48);
  h.payload_bytes = get<std::uint32_t>(message, 52);
  STRATA_TRY(check(h));
  if (message.size() - kFrameHeaderBytes != h.payload_bytes)
    return broken("payload_bytes", "The payload is exactly the rest of the message.");
  return h;
}

}  // namespace strata::protocol
