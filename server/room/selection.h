#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "expression/expression.h"
#include "mesh/rollout/fit_developed_surface.h"
#include "mesh/rollout/sheet_area.h"
#include "query/conditions/texel_selection.h"
#include "room/at.h"
#include "room/place.h"

namespace strata::room {

// The kinds of regions of a selection. `Selection` names them without the prefix.
struct RegionAround {
  // The connected surface within a distance from a position (query::select_near).
  Place at;
  double radius = 0;  // in model units
};
struct RegionLike {
  // The surface that looks like the surface at a position, around this position or, with a path,
  // around the surface under the path (query::Similarity).
  enum class By { color, normal, value };
  Place at;
  std::vector<glm::dvec2> path{};  // pixels in the window of the camera of `at`
  By by = By::color;
  std::string layer{};                    // for By::value: the slug
  std::optional<SurfaceImageId> image{};  // for By::color; nullopt: as visible by default
  double tolerance = 0;
  bool contiguous = true;
  std::optional<double> radius{};  // in model units; nullopt: no limit, only without a path
};
struct RegionWhere {  // the surface where a condition is true
  Expression condition;
  std::string text{};  // of the condition
};
struct RegionUnrolled {         // the surface that a rollout shows in an area of its sheet
  mesh::FitRequest fit{};       // without `up` and `zero`, see mesh::fit_sheet
  std::optional<double> cut{};  // in radians
  // On the sheet, in model units (mesh::SheetArea).
  std::vector<std::vector<glm::dvec2>> polygons{};
  std::vector<mesh::SheetArea::Stroke> strokes{};
};
struct Region;
struct RegionCombined {  // parts that are combined in this order; the first one is added
  std::vector<Region> parts;
};
// A part of the surface, and its changes: first its growth, then its smoothing.
struct Region {
  std::variant<RegionAround, Outline, RegionLike, RegionWhere, RegionUnrolled, RegionCombined>
      area{};
  // Grows by this distance, or shrinks if negative (query::grow). In model units.
  double grow = 0;
  // Smooths with this width (query::smooth). In model units; 0: no change.
  double smooth = 0;
  std::string field = "within";                // its name in errors
  Combination combination = Combination::add;  // with the parts before it
};

// A part of the surface, selected by the values of layers and by its position.
struct Selection {
  using Around = RegionAround;
  using Like = RegionLike;
  using Where = RegionWhere;
  using Unrolled = RegionUnrolled;
  using Combined = RegionCombined;
  using Region = room::Region;
  std::optional<Expression> where{};  // a condition
  std::optional<Region> within{};
  // The texels where any of these layers differs between two states.
  struct Changed {
    std::vector<std::string> layers;  // slugs
    std::int64_t from = 0;
    std::int64_t to = 0;
  };
  std::optional<Changed> changed{};
  At at{};                     // the state of the layers
  Role seen_by = Role::owner;  // conditions can only contain layers that this role sees
  // If set, the conditions in `within` can only read data that all users of a layer with this
  // visibility see, because the selection will be painted on it.
  std::optional<Visibility> painted_for{};
  // The field of a personal saved selection that `within` uses. Empty: none.
  std::string personal_field{};
  bool whole() const { return !where && !within && !changed; }
};

// Combines the selected texels with the texels of another part of the same map.
void combine(query::TexelSelection& selected, const query::TexelSelection& other,
             Combination combination);

// Calls visit(region) for each region that is not a combination, until one returns an error.
template <class Visit>
Result<void> for_each_leaf(const Selection::Region& region, const Visit& visit) {
  const auto* combined = std::get_if<Selection::Combined>(&region.area);
  if (!combined) return visit(region);
  for (const Selection::Region& part : combined->parts) STRATA_TRY(for_each_leaf(part, visit));
  return {};
}

// A layer that a leaf of a region reads, with the field that names it.
struct LayerRead {
  std::string slug;
  std::string field;
};
// Returns the layers that are compared with their value at a position. These layers, unlike those
// in conditions, are not checked when the region is evaluated.
std::vector<LayerRead> layers_compared(const Selection& selection);
// Returns the slugs of the layers that determine what is selected.
std::vector<std::string> layers_read_by(const Selection& selection);

}  // namespace strata::room
