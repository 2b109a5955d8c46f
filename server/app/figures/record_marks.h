#pragma once

#include "app/figures/figures.h"
#include "domain/tables/surface_feature.h"

namespace strata::app {

// The lines and points of records in a drawing.

// Returns the sequence of the layer's table at the state that the figure shows. nullopt: the
// current state.
Result<std::optional<std::int64_t>> table_sequence(store::Store& store,
                                                   const FigureRequest& request,
                                                   const Layer& layer);
// Returns the lines and points of a layer of records, by key. Blocks.
Result<std::vector<KeyFeature>> features_in(store::Store& store, const FigureRequest& request,
                                            const Layer& layer);

// Finds out which points of features are in the drawing and not hidden by a surface. As in the
// image (feature_sight_pass.comp), a point in front of the surface is visible. A point behind it is
// visible up to a small distance, measured perpendicular to the surface.
class MarkSight {
 public:
  // Both must exist as long as this object.
  MarkSight(const FigureRequest& request, const Camera& camera);
  Result<bool> sees(const glm::dvec3& place) const;
  // In pixels of the camera's window, from its top left.
  glm::dvec2 pixel_of(const glm::dvec3& place) const;

 private:
  const FigureRequest& request_;
  const Camera& camera_;
  double reach_ = 0;
};

}  // namespace strata::app
