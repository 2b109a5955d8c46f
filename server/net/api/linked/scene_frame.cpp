#include "net/api/linked/scene_frame.h"

#include "core/text/fixed_number.h"
#include "domain/scene/model.h"
#include "domain/scene/up.h"

namespace strata::net {
namespace {

constexpr int kDecimals = 6;  // a micrometer

void append_path(std::string& text, const query::FlatRing& path, bool closed,
                 const SceneFrame& frame) {
  for (std::size_t i = 0; i < path.size() + (closed ? 1 : 0); ++i) {
    text += i == 0 ? '(' : ',';
    const glm::dvec3 place = frame.place(path[i % path.size()]);
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) text += ' ';
      append_fixed(text, place[axis], kDecimals);
    }
  }
  text += ')';
}

void append_polygon(std::string& text, const query::FlatPolygon& polygon, const SceneFrame& frame) {
  for (std::size_t i = 0; i < polygon.rings.size(); ++i) {
    text += i == 0 ? '(' : ',';
    append_path(text, polygon.rings[i], true, frame);
  }
  text += ')';
}

}  // namespace

SceneFrame::SceneFrame(const Model& model) : origin_(model.origin), metres_(model.metres()) {
  const UpFrame frame = up_frame(model.up);
  axes_ = {frame.right, frame.up, -frame.into};
}

glm::dvec3 SceneFrame::place(const glm::dvec3& world) const {
  return direction(world - origin_) * metres_;
}

glm::dvec3 SceneFrame::direction(const glm::dvec3& world) const {
  return {glm::dot(axes_[0], world), glm::dot(axes_[1], world), glm::dot(axes_[2], world)};
}

std::string scene_wkt(const app::Feature& feature, app::FeatureKind kind, const SceneFrame& frame) {
  if (feature.geometry.empty()) return {};
  std::string text;
  if (kind != app::FeatureKind::areas) {
    text = kind == app::FeatureKind::points ? "POINT Z " : "LINESTRING Z ";
    append_path(text, feature.geometry.front().rings.front(), false, frame);
    return text;
  }
  const bool is_one = feature.geometry.size() == 1;
  text = is_one ? "POLYGON Z " : "MULTIPOLYGON Z ";
  for (std::size_t i = 0; i < feature.geometry.size(); ++i) {
    if (!is_one) text += i == 0 ? '(' : ',';
    append_polygon(text, feature.geometry[i], frame);
  }
  if (!is_one) text += ')';
  return text;
}

}  // namespace strata::net
