#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// Returns the rectangle of a picture (origin top left) that a model-space box covers; conservative,
// clamped; the whole picture if the box crosses the eye's plane, empty if it is outside.
// `align_to_16` grows it to multiples of 16 inside the picture. `pixel_scale`: pixels of the
// picture for one of the camera's window, the unit of outlines.
PixelRect screen_rect(const FrameRequest::Box& box, const glm::dmat4& clip_from_model, int width,
                      int height, bool align_to_16, double pixel_scale = 1);

// The cost of one more rectangle (a draw, a transfer, a JPEG's tables, a decoding), in pixels of a
// larger one. Drawing alone, with llvmpipe and three layers: 0.2 ms a rectangle and 30 ns a pixel.
constexpr std::int64_t kRectCost_px = 96 * 96;

// Returns rectangles that cover those of all boxes, at most `kMaxScreenRects`. Rectangles are
// merged if one is cheaper than two; all of them, if one around all is cheaper.
constexpr std::size_t kMaxScreenRects = 16;
std::vector<PixelRect> screen_rects(std::span<const FrameRequest::Box> boxes,
                                    const glm::dmat4& clip_from_model, int width, int height,
                                    bool align_to_16, std::int64_t rect_cost_px = kRectCost_px,
                                    double pixel_scale = 1);

// Adds a box to `boxes`, unless it is there; if there are `most`, extends the one that grows least.
void add_box(std::vector<FrameRequest::Box>& boxes, const FrameRequest::Box& box, std::size_t most);

// Bytes of a rectangle's pixels in a frame.
constexpr std::size_t rgba_bytes(const PixelRect& rect) {
  return std::size_t{4} * static_cast<std::size_t>(rect.width) *
         static_cast<std::size_t>(rect.height);
}

// Empty (all zero) if they do not intersect.
PixelRect intersection(const PixelRect& a, const PixelRect& b);

}  // namespace strata::render
