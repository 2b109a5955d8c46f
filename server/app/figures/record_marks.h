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
// visible up to the same distance as there, measured perpendicular to the surface.
class MarkSight {
 public:
  // Both must exist as long as this object. The camera is orthographic.
  MarkSight(const FigureRequest& request, const Camera& camera);

  // Returns the largest distance below the surface at which the places of a feature are visible.
  double reach_of(const std::vector<glm::dvec3>& places) const;
  // Returns whether no surface hides a place of a feature with this reach. The place must be in a
  // part that part_in_drawing returns.
  Result<bool> sees(const glm::dvec3& place, double reach) const;
  // Returns the begin and the end of the part of a segment that is in the window and that the
  // section keeps, as shares of the segment. Returns nothing if there is no such part.
  std::optional<std::pair<double, double>> part_in_drawing(const glm::dvec3& from,
                                                           const glm::dvec3& to) const;
  // In pixels of the camera's window, from its top left.
  glm::dvec2 pixel_of(const glm::dvec3& place) const;

 private:
  const FigureRequest& request_;
  const Camera& camera_;
  double pixel_ = 0, model_size_ = 0;  // in world units
};

}  // namespace strata::app
