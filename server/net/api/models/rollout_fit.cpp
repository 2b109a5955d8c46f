#include "net/api/models/rollout_fit.h"

#include <glm/trigonometric.hpp>

namespace strata::net {
namespace {

mesh::DevelopedShape shape_of(protocol::RolloutShape shape) {
  switch (shape) {
    case protocol::RolloutShape::cylinder: return mesh::DevelopedShape::cylinder;
    case protocol::RolloutShape::cone: return mesh::DevelopedShape::cone;
    case protocol::RolloutShape::general_cylinder: return mesh::DevelopedShape::general_cylinder;
  }
  return {};
}

}  // namespace

Result<SheetRequest> read_sheet(const protocol::FigureRollout& body) {
  SheetRequest sheet;
  mesh::FitRequest& fit = sheet.fit;
  if (body.axis) {
    if (!(glm::length(body.axis->direction) > 1e-12))
      return fail(ErrorCode::invalid, "Invalid direction",
                  "The length of the direction must not be 0. For example, [0, 0, 1] is an axis "
                  "along z.",
                  "axis.direction");
    fit.axis = {body.axis->point, body.axis->direction};
  }
  if (body.radius && !body.axis)
    return fail(ErrorCode::invalid, "Radius without an axis",
                "The radius is that at `axis.point`. Send the axis, too.", "radius");
  if (body.half_angle && !body.radius)
    return fail(ErrorCode::invalid, "Angle without a radius",
                "The angle of a cone has an effect only together with its radius.", "half_angle");
  if (body.shape && body.radius)
    return fail(ErrorCode::invalid, "Shape together with a radius",
                "The radius and `half_angle` define the shape. Leave out `shape`.", "shape");
  fit.radius = body.radius;
  if (body.half_angle) fit.half_angle = glm::radians(*body.half_angle);
  if (body.shape) fit.shape = shape_of(*body.shape);
  if (body.side)
    fit.side = *body.side == protocol::RolloutSide::inside ? mesh::RolloutSide::inside
                                                           : mesh::RolloutSide::outside;
  if (body.cut) sheet.cut = glm::radians(*body.cut);
  return sheet;
}

}  // namespace strata::net
