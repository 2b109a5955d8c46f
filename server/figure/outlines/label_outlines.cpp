#include "figure/outlines/label_outlines.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "figure/outlines/noncrossing_arcs.h"

namespace strata::figure {
namespace {

// Joins lines to polygons.
class Assembly {
 public:
  Assembly(const LabelFaces& faces, const BorderGraph& graph, const std::vector<SmoothArc>& arcs)
      : faces_(faces), graph_(graph), arcs_(arcs), of_face_(faces.label.size()) {}

  LabelOutlines join() {
    for (const std::vector<HalfArc>& walk : graph_.walks())
      if (faces_.label[graph_.face_left_of(walk.front())] != kNoLabel) add_rings(walk);
    LabelOutlines outlines;
    for (std::size_t face = 0; face < of_face_.size(); ++face) {
      if (of_face_[face].rings.empty()) continue;
      for (const OutlineRing& ring : of_face_[face].rings) outlines.points += ring.size();
      outlines.areas[faces_.label[face]].push_back(std::move(of_face_[face]));
    }
    return outlines;
  }

 private:
  // Splits a walk around a face at the nodes that it passes twice, so each ring is simple.
  void add_rings(const std::vector<HalfArc>& walk) {
    OutlinePolygon& polygon = of_face_[graph_.face_left_of(walk.front())];
    if (graph_.arcs[walk.front() / 2].is_ring()) {
      add_ring(polygon, walk);
      return;
    }
    std::vector<HalfArc> open;
    std::unordered_map<std::uint32_t, std::size_t> position;  // in `open`, by node
    for (const HalfArc half : walk) {
      const std::uint32_t node = graph_.start_of(half);
      if (const auto known = position.find(node); known != position.end()) {
        const auto begin = open.begin() + static_cast<std::ptrdiff_t>(known->second);
        add_ring(polygon, {begin, open.end()});
        for (auto each = begin + 1; each != open.end(); ++each)
          position.erase(graph_.start_of(*each));
        open.erase(begin, open.end());
      }
      position[node] = open.size();
      open.push_back(half);
    }
    add_ring(polygon, open);
  }

  void add_ring(OutlinePolygon& polygon, const std::vector<HalfArc>& halves) const {
    OutlineRing ring;
    for (const HalfArc half : halves) {
      const auto& points = arcs_[half / 2].points;
      // The last point of a line with nodes is the first point of the next one.
      const std::size_t count = points.size() - (graph_.arcs[half / 2].is_ring() ? 0 : 1);
      if (half % 2 == 0)
        ring.insert(ring.end(), points.begin(),
                    points.begin() + static_cast<std::ptrdiff_t>(count));
      else
        ring.insert(ring.end(), points.rbegin(),
                    points.rbegin() + static_cast<std::ptrdiff_t>(count));
    }
    const bool is_outer = signed_area(ring) > 0;
    polygon.rings.insert(is_outer ? polygon.rings.begin() : polygon.rings.end(), std::move(ring));
  }

  const LabelFaces& faces_;
  const BorderGraph& graph_;
  const std::vector<SmoothArc>& arcs_;
  std::vector<OutlinePolygon> of_face_;
};

}  // namespace

double signed_area(const OutlineRing& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    twice += a.x * b.y - b.x * a.y;
  }
  return -twice / 2;  // y points down
}

Result<LabelOutlines> label_outlines(LabelGrid grid, const OutlineSettings& settings,
                                     const Progress& progress) {
  const auto smallest = static_cast<std::size_t>(std::ceil(std::max(0.0, settings.smallest_area)));
  const LabelFaces faces = STRATA_TRY(label_faces(std::move(grid), smallest, progress));
  const BorderGraph graph = STRATA_TRY(border_arcs(faces, settings.most_sides, progress));
  const auto arcs =
      STRATA_TRY(noncrossing_arcs(faces, graph, std::max(0.0, settings.tolerance), progress));
  LabelOutlines outlines = Assembly(faces, graph, arcs).join();
  outlines.dropped_pieces = faces.dropped_faces;
  outlines.dropped_area = static_cast<double>(faces.dropped_cells);
  return outlines;
}

}  // namespace strata::figure
