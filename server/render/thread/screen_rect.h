#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// Returns the part of a frame that a model-space box covers (origin top left). The result is
// conservative and clamped to the frame. It is the whole frame if the box crosses the eye's plane,
// and empty if the box is outside. `align_to_16` enlarges it to multiples of 16 inside the frame.
// `pixel_scale` is the number of frame pixels per pixel of the camera's window, the unit of
// outlines.
PixelRect screen_rect(const FrameRequest::Box& box, const glm::dmat4& clip_from_model, int width,
                      int height, bool align_to_16, double pixel_scale = 1);

// The cost of one more rectangle (draw call, transfer, JPEG tables, decoding), as a number of
// pixels. With llvmpipe and three layers, drawing alone takes 0.2 ms per rectangle and 30 ns per
// pixel.
constexpr std::int64_t kRectCost_px = 96 * 96;

// Returns at most `kMaxScreenRects` rectangles that cover all boxes. Merges two rectangles if one
// rectangle around both is cheaper. Merges all if one around all of them is cheaper.
constexpr std::size_t kMaxScreenRects = 16;
std::vector<PixelRect> screen_rects(std::span<const FrameRequest::Box> boxes,
                                    const glm::dmat4& clip_from_model, int width, int height,
                                    bool align_to_16, std::int64_t rect_cost_px = kRectCost_px,
                                    double pixel_scale = 1);

// Returns the part of a frame whose surface the shading of a rectangle reads. The outlines of
// values and of cuts depend on pixels around their own.
PixelRect with_neighbors(const PixelRect& rect, int width, int height, double pixel_scale);

// Adds a box to `boxes` unless it is in the list. If the list has `most` boxes, extends the box
// that grows least.
void add_box(std::vector<FrameRequest::Box>& boxes, const FrameRequest::Box& box, std::size_t most);

// Returns the bytes of a rectangle's pixels in a frame.
constexpr std::size_t rgba_bytes(const PixelRect& rect) {
  return std::size_t{4} * static_cast<std::size_t>(rect.width) *
         static_cast<std::size_t>(rect.height);
}

// Returns the smallest rectangle that contains both.
PixelRect around(const PixelRect& a, const PixelRect& b);

// Returns an empty rectangle (all zero) if they do not intersect.
PixelRect intersection(const PixelRect& a, const PixelRect& b);

}  // namespace strata::render
