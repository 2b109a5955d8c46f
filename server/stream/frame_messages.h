#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace strata::stream {

// An encoded message for the socket: the frame header (protocol/frame_header.h) and the payload in
// one buffer.
using FrameBytes = std::shared_ptr<const std::vector<std::uint8_t>>;
// The messages of one frame, one for each rectangle, in order.
using FrameMessages = std::vector<FrameBytes>;
using SendFrames = std::function<void(FrameMessages)>;

}  // namespace strata::stream
