#include "render/screen_rect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/shade.h"

namespace strata::render {
namespace {

// A texel's colour reaches the pixels around it, and so does its outline.
constexpr double kPadding_px = 1.5 + shader::kOutlinePixels;
constexpr int kAlign = 16;

}  // namespace

PixelRect screen_rect(std::span<const FrameRequest::Box> boxes, const glm::dmat4& clip_from_model, int width,
                      int height, bool align_to_16) {
  double x0 = std::numeric_limits<double>::max(), y0 = x0, x1 = -x0, y1 = -x0;
  for (const auto& box : boxes) {
    int behind = 0;
    double bx0 = std::numeric_limits<double>::max(), by0 = bx0, bx1 = -bx0, by1 = -bx0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                         corner & 4 ? box.max.z : box.min.z, 1);
      const glm::dvec4 clip = clip_from_model * p;
      if (clip.w <= 1e-9) {
        ++behind;
        continue;
      }
      const double x = (clip.x / clip.w * 0.5 + 0.5) * width, y = (0.5 - clip.y / clip.w * 0.5) * height;
      bx0 = std::min(bx0, x), bx1 = std::max(bx1, x);
      by0 = std::min(by0, y), by1 = std::max(by1, y);
    }
    if (behind == 8) continue;
    if (behind > 0) return {0, 0, width, height};
    x0 = std::min(x0, bx0), x1 = std::max(x1, bx1);
    y0 = std::min(y0, by0), y1 = std::max(y1, by1);
  }
  if (x0 > x1) return {};
  const auto clamped = [](double value, int limit) { return static_cast<int>(std::clamp(value, 0.0, double(limit))); };
  int left = clamped(std::floor(x0 - kPadding_px), width), right = clamped(std::ceil(x1 + kPadding_px), width);
  int top = clamped(std::floor(y0 - kPadding_px), height), bottom = clamped(std::ceil(y1 + kPadding_px), height);
  if (left >= right || top >= bottom) return {};
  if (align_to_16) {
    left -= left % kAlign;
    top -= top % kAlign;
    right = std::min(width, (right + kAlign - 1) / kAlign * kAlign);
    bottom = std::min(height, (bottom + kAlign - 1) / kAlign * kAlign);
  }
  return {left, top, right - left, bottom - top};
}

void add_box(std::vector<FrameRequest::Box>& boxes, const FrameRequest::Box& box, std::size_t most) {
  if (std::find(boxes.begin(), boxes.end(), box) != boxes.end()) return;
  boxes.push_back(box);
  if (boxes.size() <= most) return;
  FrameRequest::Box all = boxes.front();
  for (const auto& one : boxes) all = {glm::min(all.min, one.min), glm::max(all.max, one.max)};
  boxes.assign(1, all);
}

PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  const int x0 = std::max(a.x, b.x), x1 = std::min(a.x + a.width, b.x + b.width);
  const int y0 = std::max(a.y, b.y), y1 = std::min(a.y + a.height, b.y + b.height);
  if (x0 >= x1 || y0 >= y1) return {};
  return {x0, y0, x1 - x0, y1 - y0};
}

}  // namespace strata::render
