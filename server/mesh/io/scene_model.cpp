#include "mesh/io/scene_model.h"

#include "domain/scene/up.h"

namespace strata::mesh {

std::array<glm::dvec3, 3> scene_axes(const SceneModel& model) {
  const UpFrame frame = up_frame(model.up);
  return {frame.right, frame.up, -frame.into};
}

}  // namespace strata::mesh
