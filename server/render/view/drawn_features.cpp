#include "render/view/drawn_features.h"

#include <algorithm>
#include <cmath>

namespace strata::render {
namespace {

// kReachOfLine is a share of a line's length, the others are shares of the model's size.
constexpr double kReachOfSize = 1e-3, kReachOfLine = 0.02, kReachOfPoint = 5e-4;
// The longest piece, in pixels of the camera's window.
const double kPiece_px = shader::kFeatureMaxPlaces * static_cast<double>(shader::kFeatureStep_px);

// Reduces a segment to the part in which a linear function is not negative. `at_a` and `at_b` are
// the values of the function at both ends.
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

// A point on the image plane.
struct Projected {
  glm::dvec3 at{0};        // in pixels; depth 0…1
  double pixel_depth = 0;  // change of depth over the length of a pixel at this point
  double pixel = 1;        // length of a pixel in world units
};

class Projection {
 public:
  Projection(const Camera& camera, int width, int height)
      : camera_(camera), size_(width, height), orthographic_(is_orthographic(camera)) {
    // The length of a pixel; for a perspective camera, per unit of distance from the eye.
    across_ = 2 / (std::abs(camera.projection[0][0]) * width);
    scale_ = static_cast<double>(width) / camera.width;
  }

  double scale() const { return scale_; }
  const glm::dvec2& size() const { return size_; }

  // Projects the visible part of a segment. Returns false if the section or the near and far planes
  // remove the whole segment.
  bool segment(const glm::dvec3& from, const glm::dvec3& to, Projected& begins,
               Projected& ends) const {
    double begin = 0, end = 1;
    for (const glm::dvec4& plane : camera_.section)
      narrow(glm::dot(plane, glm::dvec4(from, 1)), glm::dot(plane, glm::dvec4(to, 1)), begin, end);
    const glm::dvec4 a = camera_.projection * (camera_.view * glm::dvec4(from, 1));
    const glm::dvec4 b = camera_.projection * (camera_.view * glm::dvec4(to, 1));
    // The part between the near and the far plane.
    narrow(a.w + a.z, b.w + b.z, begin, end);
    narrow(a.w - a.z, b.w - b.z, begin, end);
    if (begin > end) return false;
    begins = project(glm::mix(from, to, begin));
    ends = project(glm::mix(from, to, end));
    return true;
  }

 private:
  Projected project(const glm::dvec3& place) const {
    const glm::dvec4 view = camera_.view * glm::dvec4(place, 1);
    const double pixel = orthographic_ ? across_ : across_ * std::abs(view.z);
    // Towards the eye, but at most half the distance to it.
    const double step = orthographic_ ? pixel : std::min(pixel, std::abs(view.z) / 2);
    const glm::dvec3 at = on_picture(camera_.projection * view);
    const glm::dvec3 near = on_picture(camera_.projection * (view + glm::dvec4(0, 0, step, 0)));
    return {at, std::abs(at.z - near.z), pixel};
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

// The style of a mark. All its pieces have the same style.
struct Style {
  float half_width = 0, casing = 0;
  glm::vec4 color{0};
  double reach = 0;     // in world units
  double reach_px = 0;  // minimum
};

// Adds the pieces of a segment that may be visible in the frame. If `joins_last` is true, the first
// piece continues the last piece in `pieces`.
void add_pieces(const Projection& projection, const Projected& from, const Projected& to,
                const Style& style, bool joins_last, std::vector<shader::FeatureSegment>& pieces) {
  const glm::dvec2 a(from.at), b(to.at);
  const double length = glm::distance(a, b), scale = projection.scale();
  const double margin = kFeatureMargin_px * scale;
  double begin = 0, end = 1;
  for (int axis = 0; axis < 2; ++axis) {
    narrow(a[axis] + margin, b[axis] + margin, begin, end);
    narrow(projection.size()[axis] + margin - a[axis], projection.size()[axis] + margin - b[axis],
           begin, end);
  }
  if (begin > end) return;
  const double count = std::max(1.0, std::ceil(length / (kPiece_px * scale)));
  const auto places = static_cast<std::uint32_t>(
      std::clamp(std::ceil(length / count / (shader::kFeatureStep_px * scale)), 1.0,
                 static_cast<double>(shader::kFeatureMaxPlaces)));
  const double first = std::floor(begin * count),
               last = std::min(std::floor(end * count), count - 1);
  for (double piece = first; piece <= last; ++piece) {
    const double t0 = piece / count, t1 = (piece + 1) / count;
    const auto end_at = [&](double t) { return glm::vec3(glm::mix(from.at, to.at, t)); };
    const auto depth_at = [&](double t) {
      return static_cast<float>(std::lerp(from.pixel_depth, to.pixel_depth, t));
    };
    const auto reach_at = [&](double t) {
      return static_cast<float>(
          std::max(style.reach_px, style.reach / std::lerp(from.pixel, to.pixel, t)));
    };
    shader::FeatureSegment segment{};
    segment.from = glm::vec4(end_at(t0), style.half_width);
    segment.to = glm::vec4(end_at(t1), style.casing);
    segment.color = style.color;
    segment.reach = {depth_at(t0), depth_at(t1), reach_at(t0), reach_at(t1)};
    segment.place_count = places;
    const bool joins = piece > first || (joins_last && piece == 0);
    if (joins && !pieces.empty()) {
      segment.joins = shader::kFeatureJoinsLast;
      pieces.back().joins |= shader::kFeatureJoinsNext;
    }
    pieces.push_back(segment);
  }
}

double length_of(const std::vector<glm::dvec3>& places) {
  double length = 0;
  for (std::size_t i = 1; i < places.size(); ++i) length += glm::distance(places[i - 1], places[i]);
  return length;
}

}  // namespace

double reach_on_model(const std::vector<glm::dvec3>& places, double model_size) {
  return places.size() == 1 ? kReachOfPoint * model_size
                            : std::min(kReachOfSize * model_size, kReachOfLine * length_of(places));
}

std::vector<shader::FeatureSegment> project_features(const std::vector<DrawnFeature>& features,
                                                     const Camera& camera, int width, int height,
                                                     const FeatureReach& reach) {
  const Projection projection(camera, width, height);
  std::vector<shader::FeatureSegment> pieces;
  for (const DrawnFeature& feature : features) {
    if (camera.hidden_parts.test(static_cast<std::size_t>(feature.part))) continue;
    const bool is_point = feature.places.size() == 1;
    Style style;
    style.half_width =
        static_cast<float>((is_point ? kPointWidth_px : kLineWidth_px) / 2 * projection.scale());
    style.casing = static_cast<float>(kFeatureCasing_px * projection.scale());
    style.color =
        glm::vec4(feature.color[0], feature.color[1], feature.color[2], feature.color[3]) / 255.0f;
    style.reach_px = reach.pixels * projection.scale();
    style.reach = reach_on_model(feature.places, reach.model_size);
    Projected from, to;
    if (is_point) {
      if (projection.segment(feature.places[0], feature.places[0], from, to))
        add_pieces(projection, from, to, style, false, pieces);
      continue;
    }
    bool joins = false;
    for (std::size_t i = 1; i < feature.places.size(); ++i) {
      const std::size_t before = pieces.size();
      if (projection.segment(feature.places[i - 1], feature.places[i], from, to))
        add_pieces(projection, from, to, style, joins, pieces);
      // The next segment is connected only if the last piece ends at this segment's end.
      joins = pieces.size() > before && glm::vec2(pieces.back().to) == glm::vec2(to.at);
    }
  }
  return pieces;
}

}  // namespace strata::render
