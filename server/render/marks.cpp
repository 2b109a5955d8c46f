#include "render/marks.h"

#include <algorithm>
#include <cmath>

namespace strata::render {
namespace {

constexpr double kPointLift = 4;  // times that of lines: the surface beside a point must not cut its disc

// Of a segment from `a` to `b` the part where a linear function that is `at_a` and `at_b` at its ends is not below 0.
void narrow(double at_a, double at_b, double& begin, double& end) {
  if (at_a >= 0 && at_b >= 0) return;
  if (at_a < 0 && at_b < 0) {
    begin = 1;
    end = 0;
    return;
  }
  const double t = at_a / (at_a - at_b);
  if (at_a < 0)
    begin = std::max(begin, t);
  else
    end = std::min(end, t);
}

class Projection {
 public:
  Projection(const Camera& camera, int width, int height)
      : camera_(camera), size_(width, height), orthographic_(is_orthographic(camera)) {
    // Length of a pixel, per distance from the eye where there is one.
    across_ = 2 / (std::abs(camera.projection[0][0]) * width);
    scale_ = static_cast<double>(width) / camera.width;
  }

  double scale() const { return scale_; }

  // `lift`: pixels.
  bool segment(const glm::dvec3& from, const glm::dvec3& to, double lift, shader::MarkSegment& out) const {
    double begin = 0, end = 1;
    for (const glm::dvec4& plane : camera_.section)
      narrow(glm::dot(plane, glm::dvec4(from, 1)), glm::dot(plane, glm::dvec4(to, 1)), begin, end);
    const glm::dvec4 a = lifted(from, lift), b = lifted(to, lift);
    // In front of the near plane and of the far one.
    narrow(a.w + a.z, b.w + b.z, begin, end);
    narrow(a.w - a.z, b.w - b.z, begin, end);
    if (begin > end) return false;
    const glm::dvec3 p = on_picture(glm::mix(a, b, begin)), q = on_picture(glm::mix(a, b, end));
    out.from = glm::vec4(p, 0);
    out.to = glm::vec4(q, 0);
    return true;
  }

 private:
  glm::dvec4 lifted(const glm::dvec3& place, double lift) const {
    glm::dvec4 view = camera_.view * glm::dvec4(place, 1);
    if (orthographic_)
      view.z += lift * across_;
    else
      view = glm::dvec4(glm::dvec3(view) * (1 - std::min(lift * across_, 0.5)), 1);
    return camera_.projection * view;
  }
  glm::dvec3 on_picture(const glm::dvec4& clip) const {
    const glm::dvec3 device = glm::dvec3(clip) / clip.w;
    return {glm::clamp((glm::dvec2(device) * 0.5 + 0.5) * size_, -1e6, 1e6), device.z * 0.5 + 0.5};
  }

  const Camera& camera_;
  const glm::dvec2 size_;
  const bool orthographic_;
  double across_ = 0, scale_ = 1;
};

}  // namespace

std::vector<shader::MarkSegment> project_marks(const std::vector<DrawnMark>& marks, const Camera& camera, int width,
                                               int height, double lift_px) {
  const Projection projection(camera, width, height);
  std::vector<shader::MarkSegment> segments;
  for (const DrawnMark& mark : marks) {
    const bool is_point = mark.places.size() == 1;
    const auto half = static_cast<float>((is_point ? kPointWidth_px : kLineWidth_px) / 2 * projection.scale());
    const auto casing = static_cast<float>(kMarkCasing_px * projection.scale());
    const glm::vec4 color = glm::vec4(mark.color[0], mark.color[1], mark.color[2], mark.color[3]) / 255.0f;
    for (std::size_t i = is_point ? 0 : 1; i < mark.places.size(); ++i) {
      shader::MarkSegment segment{};
      if (!projection.segment(mark.places[is_point ? i : i - 1], mark.places[i], (is_point ? kPointLift : 1) * lift_px,
                              segment))
        continue;
      segment.from.w = half;
      segment.to.w = casing;
      segment.color = color;
      segments.push_back(segment);
    }
  }
  return segments;
}

}  // namespace strata::render
