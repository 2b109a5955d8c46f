#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/error.h"

// The binary message with one rectangle of a frame. protocol/frame.md describes it and numbers its
// rules.
namespace strata::protocol {

constexpr std::size_t kFrameHeaderBytes = 56;
constexpr std::uint8_t kFrameVersion = 1;
constexpr std::uint32_t kMaxFrameSize = 8192;                // pixels per side
constexpr std::uint64_t kMaxSafeInteger = (1ULL << 53) - 1;  // largest exact integer in JavaScript

enum class FrameCodec : std::uint8_t { jpeg = 1, png = 2 };

struct FrameHeader {
  FrameCodec codec = FrameCodec::jpeg;
  bool keyframe = false;  // the rectangle is the whole frame
  bool still = false;     // full quality; the last frame until a change
  bool last = false;      // last rectangle of the frame: draw it, then ack
  std::uint32_t view_id = 0;
  std::uint32_t frame = 0;
  std::uint64_t camera_seq = 0;
  std::uint64_t scene_sequence = 0;
  std::uint32_t x = 0, y = 0, width = 0, height = 0;  // of the rectangle, from the top left
  std::uint32_t full_width = 0, full_height = 0;
  std::uint32_t render_us = 0, encode_us = 0;
  std::uint32_t payload_bytes = 0;
  bool operator==(const FrameHeader&) const = default;
};

// Returns the first bytes of the message. The server creates the header, so a violated rule is a
// programming error (assert).
std::array<std::uint8_t, kFrameHeaderBytes> encode_frame_header(const FrameHeader& header);

// Returns the header of a whole message. The payload begins at kFrameHeaderBytes. Refuses a message
// that is too short or too long, and a header that violates a rule. The field of the error is the
// name of the member.
Result<FrameHeader> decode_frame_header(std::span<const std::uint8_t> message);

}  // namespace strata::protocol
