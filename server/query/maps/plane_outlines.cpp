#include "query/maps/plane_outlines.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <unordered_map>

#include "core/log.h"
#include "core/polygon_area.h"
#include "domain/people/question.h"
#include "mesh/surface/chart_rims.h"
#include "mesh/surface/uv_lookup.h"
#include "mesh/texels/slot_bits.h"
#include "query/conditions/texel_values.h"
#include "query/maps/texel_regions.h"

namespace strata::query {
namespace {

constexpr double kGridOfTexel = 1.0 / 256;  // spacing of the grid for corners at seams
constexpr double kSimplifiedTexels = 0.5;
constexpr double kSliverTexels = 1.0 / 64;
constexpr std::size_t kBytesOfCorner = 400;    // maximum memory of GEOS and the rings
constexpr std::size_t kBytesOfTriangle = 110;  // memory to build the rims and the lookup

// Assigns labels to texels. Texels with the same label have one class, and their surface faces the
// same side of the plane. Without labels, the rings of a surface that folds over itself in the
// plane would cancel the area that they enclose.
class Labels {
 public:
  Labels(const LayerView& view, const mesh::SurfaceMap& map, const ValueClasses& classes,
         const OutlinePlane& plane, const std::set<std::uint32_t>* only)
      : map_(map), plane_(plane), of_texel_(map.block_of_slot.size() * 64, 0) {
    const QuestionTurn turn;
    for (const auto& [address, tile] : sorted_tiles(view.snapshot.tiles)) {
      turn.check(kTexelsPerTile);
      for_each_value(*tile, address, view.layer.type, map, nullptr,
                     [&](std::uint32_t slot, int texel, std::uint32_t bits, double value) {
                       const std::uint32_t a_class = classes.of(bits, value);
                       if (only && !only->contains(a_class)) return;
                       const auto [known, is_new] = number_of_.try_emplace(
                           a_class, static_cast<std::uint32_t>(classes_.size()));
                       if (is_new) classes_.push_back(known->first);
                       const bool turned = is_turned(slot, texel);
                       of_texel_[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)] =
                           2 * known->second + (turned ? 1 : 0) + 1;
                     });
    }
    // Also labels the gutter texels, because a chart covers parts of them.
    mesh::for_each_gutter_texel(map, [&](mesh::SlotTexel gutter, mesh::SlotTexel owner) {
      of_texel_[std::size_t{gutter.slot} * 64 + static_cast<std::size_t>(gutter.texel)] =
          of_texel_[std::size_t{owner.slot} * 64 + static_cast<std::size_t>(owner.texel)];
    });
  }

  const std::vector<std::uint32_t>& of_texel() const { return of_texel_; }
  const std::vector<std::uint32_t>& classes() const { return classes_; }
  static std::size_t class_number(std::uint32_t label) { return (label - 1) / 2; }

 private:
  std::optional<glm::dvec2> place(int x, int y) const {
    if (x < 0 || y < 0) return std::nullopt;
    const std::uint32_t slot = mesh::slot_at(map_, x / kBlockSize, y / kBlockSize);
    if (slot == mesh::kNoSlot) return std::nullopt;
    const int texel = y % kBlockSize * kBlockSize + x % kBlockSize;
    if ((map_.surface_mask[slot] >> texel & 1u) == 0) return std::nullopt;
    const glm::vec3 at = map_.position(slot, texel);
    return glm::dvec2(at[plane_.right], at[plane_.up]);
  }
  glm::dvec2 difference(int x, int y, int dx, int dy, const glm::dvec2& here) const {
    return place(x + dx, y + dy).value_or(here) - place(x - dx, y - dy).value_or(here);
  }
  // Returns true if the atlas is mirrored in the plane.
  bool is_turned(std::uint32_t slot, int texel) const {
    const auto block = static_cast<int>(map_.block_of_slot[slot]);
    const int x = block % map_.blocks_per_side * kBlockSize + texel % kBlockSize;
    const int y = block / map_.blocks_per_side * kBlockSize + texel / kBlockSize;
    const glm::dvec2 here = *place(x, y);
    const glm::dvec2 along = difference(x, y, 1, 0, here), across = difference(x, y, 0, 1, here);
    return along.x * across.y - along.y * across.x < 0;
  }

  const mesh::SurfaceMap& map_;
  const OutlinePlane plane_;
  std::unordered_map<std::uint32_t, std::uint32_t> number_of_;
  std::vector<std::uint32_t> classes_;
  std::vector<std::uint32_t> of_texel_;
};

// Adds the areas of a chart. Parts of a chart that meet in one vertex have separate outer rings.
// Outer rings have the direction of the widest ring, and holes have the opposite direction.
void add_chart_areas(const mesh::Geometry& geometry, const mesh::ChartRims& chart,
                     double resolution, std::vector<FlatArea>& areas) {
  std::vector<FlatRing> rings;
  for (const auto& rim : chart.rings) {
    FlatRing& ring = rings.emplace_back();
    for (const std::uint32_t vertex : rim)
      ring.emplace_back(glm::dvec2(geometry.vertices[vertex].uv) * resolution, 0.0);
  }
  const auto size = [](const FlatRing& ring) { return std::abs(ring_area(ring)); };
  const double widest = ring_area(*std::ranges::max_element(rings, {}, size));
  const auto holes = std::ranges::partition(
      rings, [&](const FlatRing& ring) { return ring_area(ring) * widest > 0; });
  for (FlatRing& outer : std::span(rings.begin(), holes.begin())) {
    const std::vector<std::vector<glm::dvec2>> flat{{outer.begin(), outer.end()}};
    const PolygonArea inside(flat);
    FlatPolygon polygon{{std::move(outer)}};
    // Tests the middle of an edge, because rings may share corners but not edges.
    for (const FlatRing& hole : holes)
      if (inside.contains(glm::dvec2(hole[0] + hole[1]) / 2.0)) polygon.rings.push_back(hole);
    areas.emplace_back(polygon);
  }
}

FlatArea region_area(const TexelRegion& region) {
  FlatPolygon polygon;
  for (const auto& corners : region.rings) {
    FlatRing& ring = polygon.rings.emplace_back();
    for (const glm::ivec2 corner : corners) ring.emplace_back(corner.x, corner.y, 0.0);
  }
  return FlatArea(polygon);
}

// Projects pieces of the atlas onto the plane, in model space.
class Laying {
 public:
  Laying(const mesh::Geometry& geometry, double resolution, const OutlinePlane& plane)
      : lookup_(geometry), resolution_(resolution), plane_(plane) {}

  void lay(const FlatArea& in_atlas, std::vector<FlatArea>& laid) const {
    for (FlatPolygon& polygon : in_atlas.polygons()) {
      for (FlatRing& ring : polygon.rings)
        for (glm::dvec3& corner : ring)
          if (const auto place = lookup_.place_at(glm::dvec2(corner) / resolution_))
            corner = {(*place)[plane_.right], (*place)[plane_.up], (*place)[plane_.depth]};
      laid.emplace_back(polygon);
    }
  }

 private:
  const mesh::UvLookup lookup_;
  const double resolution_;
  const OutlinePlane plane_;
};

// Removes areas between lines that are equal except for rounding.
void drop_slivers(std::vector<FlatPolygon>& polygons, double least_area) {
  const auto is_sliver = [&](const FlatRing& ring) {
    return std::abs(ring_area(ring)) < least_area;
  };
  std::erase_if(polygons,
                [&](const FlatPolygon& polygon) { return is_sliver(polygon.rings.front()); });
  for (FlatPolygon& polygon : polygons) std::erase_if(polygon.rings, is_sliver);
}

Result<PlaneOutlines> outlines_of(const Labels& labels, const std::vector<TexelRegion>& regions,
                                  const mesh::Geometry& geometry, const mesh::SurfaceMap& map,
                                  const OutlinePlane& plane) {
  const QuestionTurn turn;
  std::vector<FlatArea> charts;
  for (const mesh::ChartRims& chart : mesh::find_chart_rims(geometry)) {
    turn.check();
    add_chart_areas(geometry, chart, map.resolution, charts);
  }
  const FlatAreaTree tree(charts);
  const Laying laying(geometry, map.resolution, plane);
  std::vector<std::vector<FlatArea>> laid(labels.classes().size());
  for (const TexelRegion& region : regions) {
    turn.check();
    const FlatArea area = region_area(region);
    tree.find(area, [&](const FlatArea& chart) {
      laying.lay(area.cut_with(chart), laid[Labels::class_number(region.label)]);
    });
  }
  const double texel = std::sqrt(
      map.area_total / static_cast<double>(std::max<std::uint64_t>(map.surface_texels, 1)));
  const glm::dvec3 origin(geometry.origin[plane.right], geometry.origin[plane.up],
                          geometry.origin[plane.depth]);
  PlaneOutlines outlines;
  for (std::size_t i = 0; i < laid.size(); ++i) {
    turn.check();
    const FlatArea all = FlatArea::joined(std::move(laid[i]), texel * kGridOfTexel);
    auto& polygons = outlines[labels.classes()[i]] =
        all.simplified(texel * kSimplifiedTexels).polygons();
    drop_slivers(polygons, texel * texel * kSliverTexels);
    for (FlatPolygon& polygon : polygons)
      for (FlatRing& ring : polygon.rings)
        for (glm::dvec3& corner : ring) corner += origin;
  }
  return outlines;
}

}  // namespace

Result<PlaneOutlines> plane_outlines(const LayerView& view, const mesh::Geometry& geometry,
                                     const mesh::SurfaceMap& map, const ValueClasses& classes,
                                     const OutlinePlane& plane,
                                     const std::set<std::uint32_t>* only) {
  const QuestionMemory memory(map.block_of_slot.size() * 64 * sizeof(std::uint32_t) +
                              geometry.triangle_count() * kBytesOfTriangle);
  const Labels labels(view, map, classes, plane, only);
  if (labels.classes().empty()) return PlaneOutlines{};
  std::vector<TexelRegion> regions;
  if (!find_regions(map, labels.of_texel(), kMaxOutlineCorners, regions))
    return fail(ErrorCode::invalid, "Outlines too long",
                "The borders of the painted areas have more than " +
                    std::to_string(kMaxOutlineCorners) +
                    " corners. Request texels.tif instead, or choose a layer with fewer areas.",
                "layer");
  std::size_t corners = 0;
  for (const TexelRegion& region : regions)
    for (const auto& ring : region.rings) corners += ring.size();
  const QuestionMemory of_corners(corners * kBytesOfCorner);
  try {
    return outlines_of(labels, regions, geometry, map, plane);
  } catch (const std::runtime_error& error) {
    log::error(std::string("outlines of a layer: ") + error.what());
    return fail(ErrorCode::internal, "Cannot create outlines",
                "The server could not project the areas onto the plane. Request outlines along "
                "another axis, or request texels.tif. See the log of the server for the reason.",
                "along");
  }
}

}  // namespace strata::query
