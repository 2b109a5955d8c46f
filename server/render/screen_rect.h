#pragma once

#include <span>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// The rectangle of a picture (origin top left) that a model-space box covers; conservative, clamped, the whole picture when
// it crosses the eye's plane, empty when it is not in it. `align_to_16` grows it to multiples of 16 inside the picture.
PixelRect screen_rect(const FrameRequest::Box& box, const glm::dmat4& clip_from_model, int width, int height,
                      bool align_to_16);

// Rectangles that cover those of all boxes, `kMaxScreenRects` at most: what lies so near that one is cheaper than two is joined.
constexpr std::size_t kMaxScreenRects = 16;
std::vector<PixelRect> screen_rects(std::span<const FrameRequest::Box> boxes, const glm::dmat4& clip_from_model,
                                    int width, int height, bool align_to_16);

// One more of `boxes`, unless it is there; when there are `most`, the one that grows least grows around it.
void add_box(std::vector<FrameRequest::Box>& boxes, const FrameRequest::Box& box, std::size_t most);

// Empty (all zero) when they do not meet.
PixelRect intersection(const PixelRect& a, const PixelRect& b);

}  // namespace strata::render
