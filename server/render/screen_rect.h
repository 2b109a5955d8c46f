#pragma once

#include <span>

#include "render/renderer.h"

namespace strata::render {

// The rectangle of a picture (origin top left) that model-space boxes cover; conservative, clamped, the whole picture when a
// box crosses the eye's plane, empty when none is in it. `align_to_16` grows it to multiples of 16 inside the picture.
PixelRect screen_rect(std::span<const FrameRequest::Box> boxes, const glm::dmat4& clip_from_model, int width,
                      int height, bool align_to_16);

// Empty (all zero) when they do not meet.
PixelRect intersection(const PixelRect& a, const PixelRect& b);

}  // namespace strata::render
