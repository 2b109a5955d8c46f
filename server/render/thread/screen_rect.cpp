#include "render/thread/screen_rect.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <limits>

#include "shared/cut.h"
#include "shared/shade.h"

namespace strata::render {
namespace {

// Outlines are wider in frames with more pixels than the camera's window.
double outline_px(double pixels, double pixel_scale) { return pixels * std::max(1.0, pixel_scale); }

// A texel's color and outline affect the pixels around it.
double padding_px(double pixel_scale) {
  return 1.5 + outline_px(shader::kOutlinePixels, pixel_scale);
}
constexpr int kAlign = 16;
std::int64_t area(const PixelRect& rect) { return std::int64_t{rect.width} * rect.height; }

// Returns the additional pixels of one rectangle around both. Negative if they overlap.
std::int64_t growth(const PixelRect& a, const PixelRect& b) {
  return area(around(a, b)) - area(a) - area(b);
}

// Adds a rectangle to `rects` and merges it with all rectangles that are cheaper to draw together.
void add_rect(std::vector<PixelRect>& rects, PixelRect rect, std::int64_t rect_cost_px) {
  for (std::size_t i = 0; i < rects.size();) {
    if (growth(rects[i], rect) > rect_cost_px) {
      ++i;
      continue;
    }
    rect = around(rects[i], rect);
    rects.erase(rects.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;  // the larger rectangle may be near others
  }
  rects.push_back(rect);
}

// Removes the two rectangles that grow least when merged. Returns the merged one.
PixelRect take_nearest(std::vector<PixelRect>& rects) {
  std::size_t first = 0, second = 1;
  for (std::size_t i = 0; i < rects.size(); ++i)
    for (std::size_t k = i + 1; k < rects.size(); ++k)
      if (growth(rects[i], rects[k]) < growth(rects[first], rects[second])) first = i, second = k;
  const PixelRect joined = around(rects[first], rects[second]);
  rects.erase(rects.begin() + static_cast<std::ptrdiff_t>(second));
  rects.erase(rects.begin() + static_cast<std::ptrdiff_t>(first));
  return joined;
}

}  // namespace

PixelRect screen_rect(const FrameRequest::Box& box, const glm::dmat4& clip_from_model, int width,
                      int height, bool align_to_16, double pixel_scale) {
  const double padding = padding_px(pixel_scale);
  int behind = 0;
  double x0 = std::numeric_limits<double>::max(), y0 = x0, x1 = -x0, y1 = -x0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                       corner & 4 ? box.max.z : box.min.z, 1);
    const glm::dvec4 clip = clip_from_model * p;
    if (clip.w <= 1e-9) {
      ++behind;
      continue;
    }
    const double x = (clip.x / clip.w * 0.5 + 0.5) * width,
                 y = (0.5 - clip.y / clip.w * 0.5) * height;
    x0 = std::min(x0, x), x1 = std::max(x1, x);
    y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
  if (behind == 8) return {};
  if (behind > 0) return {0, 0, width, height};
  const auto clamped = [](double value, int limit) {
    return static_cast<int>(std::clamp(value, 0.0, double(limit)));
  };
  int left = clamped(std::floor(x0 - padding), width),
      right = clamped(std::ceil(x1 + padding), width);
  int top = clamped(std::floor(y0 - padding), height),
      bottom = clamped(std::ceil(y1 + padding), height);
  if (left >= right || top >= bottom) return {};
  if (align_to_16) {
    left -= left % kAlign;
    top -= top % kAlign;
    right = std::min(width, (right + kAlign - 1) / kAlign * kAlign);
    bottom = std::min(height, (bottom + kAlign - 1) / kAlign * kAlign);
  }
  return {left, top, right - left, bottom - top};
}

std::vector<PixelRect> screen_rects(std::span<const FrameRequest::Box> boxes,
                                    const glm::dmat4& clip_from_model, int width, int height,
                                    bool align_to_16, std::int64_t rect_cost_px,
                                    double pixel_scale) {
  std::vector<PixelRect> rects;
  for (const auto& box : boxes) {
    const PixelRect rect =
        screen_rect(box, clip_from_model, width, height, align_to_16, pixel_scale);
    if (rect.width == 0) continue;
    add_rect(rects, rect, rect_cost_px);
    if (rects.size() > kMaxScreenRects) add_rect(rects, take_nearest(rects), rect_cost_px);
  }
  if (rects.size() < 2) return rects;
  // One rectangle around all may be cheaper even if no two of them are cheaper to merge. An example
  // is four rectangles along the sides of a frame.
  PixelRect all = rects.front();
  std::int64_t apart = -rect_cost_px;
  for (const PixelRect& rect : rects) {
    all = around(all, rect);
    apart += area(rect) + rect_cost_px;
  }
  return apart < area(all) ? rects : std::vector{all};
}

PixelRect with_neighbors(const PixelRect& rect, int width, int height, double pixel_scale) {
  const double widest = std::max(shader::kOutlinePixels, shader::kCutOutlinePixels);
  const int more = static_cast<int>(std::ceil(outline_px(widest, pixel_scale) + 0.5));
  return intersection({rect.x - more, rect.y - more, rect.width + 2 * more, rect.height + 2 * more},
                      {0, 0, width, height});
}

void add_box(std::vector<FrameRequest::Box>& boxes, const FrameRequest::Box& box,
             std::size_t most) {
  if (std::find(boxes.begin(), boxes.end(), box) != boxes.end()) return;
  if (boxes.size() < most) return boxes.push_back(box);
  const auto grown = [&](const FrameRequest::Box& one) {
    return FrameRequest::Box{glm::min(one.min, box.min), glm::max(one.max, box.max)};
  };
  const auto size = [](const FrameRequest::Box& one) { return glm::compAdd(one.max - one.min); };
  const auto growth = [&](const FrameRequest::Box& one) { return size(grown(one)) - size(one); };
  auto& nearest = *std::min_element(boxes.begin(), boxes.end(), [&](const auto& a, const auto& b) {
    return growth(a) < growth(b);
  });
  nearest = grown(nearest);
}

PixelRect around(const PixelRect& a, const PixelRect& b) {
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x,
          std::max(a.y + a.height, b.y + b.height) - y};
}

PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  const int x0 = std::max(a.x, b.x), x1 = std::min(a.x + a.width, b.x + b.width);
  const int y0 = std::max(a.y, b.y), y1 = std::min(a.y + a.height, b.y + b.height);
  if (x0 >= x1 || y0 >= y1) return {};
  return {x0, y0, x1 - x0, y1 - y0};
}

}  // namespace strata::render
