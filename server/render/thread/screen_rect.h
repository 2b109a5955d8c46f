#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// The rectangle of a picture (origin top left) that a model-space box covers; conservative,
// clamped, the whole picture when it crosses the eye's plane, empty when it is not in it.
// `align_to_16` grows it to multiples of 16 inside the picture. `pixel_scale`: pixels of the
// picture in one of the camera's window, in which outlines are measured.
PixelRect screen_rect(const FrameRequest::Box& box, const glm::dmat4& clip_from_model, int width,
                      int height, bool align_to_16, double pixel_scale = 1);

// What one more rectangle costs (a draw, a transfer, a JPEG's tables, a decoding), in pixels of a
// larger one. Drawing alone, with llvmpipe and three layers: 0.2 ms a rectangle and 30 ns a pixel.
constexpr std::int64_t kRectCost_px = 96 * 96;

// Rectangles that cover those of all boxes, `kMaxScreenRects` at most: what lies so near that one
// is cheaper than two is joined, and all of them where one around all is.
constexpr std::size_t kMaxScreenRects = 16;
std::vector<PixelRect> screen_rects(std::span<const FrameRequest::Box> boxes,
                                    const glm::dmat4& clip_from_model, int width, int height,
                                    bool align_to_16, std::int64_t rect_cost_px = kRectCost_px,
                                    double pixel_scale = 1);

// One more of `boxes`, unless it is there; when there are `most`, the one that grows least grows
// around it.
void add_box(std::vector<FrameRequest::Box>& boxes, const FrameRequest::Box& box, std::size_t most);

// Of a rectangle's pixels in a frame.
constexpr std::size_t rgba_bytes(const PixelRect& rect) {
  return std::size_t{4} * static_cast<std::size_t>(rect.width) *
         static_cast<std::size_t>(rect.height);
}

// Empty (all zero) when they do not meet.
PixelRect intersection(const PixelRect& a, const PixelRect& b);

}  // namespace strata::render
