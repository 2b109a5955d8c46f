#pragma once

#include <span>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// The rectangle of a picture (origin top left) that model-space boxes cover; conservative, clamped, the whole picture when a
// box crosses the eye's plane, empty when none is in it. `align_to_16` grows it to multiples of 16 inside the picture.
PixelRect screen_rect(std::span<const FrameRequest::Box> boxes, const glm::dmat4& clip_from_model, int width,
                      int height, bool align_to_16);

// One more of `boxes`, unless it is there; more than `most` become one around them all.
void add_box(std::vector<FrameRequest::Box>& boxes, const FrameRequest::Box& box, std::size_t most);

// Empty (all zero) when they do not meet.
PixelRect intersection(const PixelRect& a, const PixelRect& b);

}  // namespace strata::render
