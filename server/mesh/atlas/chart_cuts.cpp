#include "mesh/atlas/chart_cuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mesh/atlas/outline.h"

namespace strata::mesh {
namespace {

constexpr float kMinFill = 0.45f;     // share of its box that an uncut chart fills
constexpr float kJoinedFill = 0.65f;  // share of its box that joined faces must fill
constexpr std::size_t kFewFaces = 64;
constexpr int kMaxRounds = 8;

float area_in_plane(std::span<const glm::vec2> plane, const Chart& chart) {
  float sum = 0;
  for (const auto face : chart.faces) {
    const glm::vec2* p = &plane[3 * std::size_t{face}];
    const glm::vec2 ab = p[1] - p[0], ac = p[2] - p[0];
    sum += std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
  }
  return sum;
}

// Cuts a chart with many faces into two halves. A face belongs to the half that contains its
// center. The cut is perpendicular to the box's longer side and passes through its middle.
std::vector<Chart> halves_of(const Chart& chart, const Outline& outline,
                             std::span<const glm::vec2> plane) {
  std::vector<Chart> halves{chart, chart};
  for (auto& half : halves) half.faces.clear();
  const int axis = outline.size.x >= outline.size.y ? 0 : 1;
  for (const auto face : chart.faces) {
    const glm::vec2* p = &plane[3 * std::size_t{face}];
    const glm::vec2 middle = outline.from_chart((p[0] + p[1] + p[2]) / 3.f);
    halves[middle[axis] < outline.size[axis] / 2 ? 0 : 1].faces.push_back(face);
  }
  return halves;
}

// Joins single faces, one by one, into the parts that fill their boxes best. For charts with few
// faces, such as the eight faces of a frame. No straight line can cut such a frame into its bars.
class Joiner {
 public:
  Joiner(const ChartSurface& surface, std::span<const glm::vec2> plane, const Chart& chart)
      : surface_(surface), plane_(plane), part_of_(chart.faces.size()) {
    for (std::size_t i = 0; i < chart.faces.size(); ++i) {
      parts_.push_back(chart);
      parts_.back().faces = {chart.faces[i]};
      part_of_[i] = i;
      number_of_[chart.faces[i]] = i;
    }
  }

  std::vector<Chart> join() {
    for (;;) {
      float best = kJoinedFill;
      std::array<std::size_t, 2> pair{};
      std::map<std::array<std::size_t, 2>, bool> seen;
      for (const auto& [face, number] : number_of_)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto next = number_of_.find(surface_.neighbours[3 * std::size_t{face} + k]);
          if (next == number_of_.end()) continue;
          const auto [a, b] = std::minmax(part_of_[number], part_of_[next->second]);
          if (a == b || !seen.try_emplace({a, b}, true).second) continue;
          if (const float fill = fill_of(a, b); fill > best) best = fill, pair = {a, b};
        }
      if (pair[0] == pair[1]) break;
      auto& joined = parts_[pair[0]].faces;
      joined.insert(joined.end(), parts_[pair[1]].faces.begin(), parts_[pair[1]].faces.end());
      parts_[pair[1]].faces.clear();
      std::replace(part_of_.begin(), part_of_.end(), pair[1], pair[0]);
    }
    std::erase_if(parts_, [](const Chart& part) { return part.faces.empty(); });
    return std::move(parts_);
  }

 private:
  float fill_of(std::size_t a, std::size_t b) {
    auto& known = fills_[{parts_[a].faces.front(), parts_[a].faces.size(), parts_[b].faces.front(),
                          parts_[b].faces.size()}];
    if (known > 0) return known;
    Chart joined = parts_[a];
    joined.faces.insert(joined.faces.end(), parts_[b].faces.begin(), parts_[b].faces.end());
    const glm::vec2 size = make_outline_of(joined, plane_).size;
    return known = std::max(area_in_plane(plane_, joined) / (size.x * size.y), 1e-6f);
  }

  const ChartSurface& surface_;
  std::span<const glm::vec2> plane_;
  std::vector<Chart> parts_;
  std::vector<std::size_t> part_of_;  // for each face of the chart
  std::map<std::uint32_t, std::size_t> number_of_;
  // key: first face and number of faces of each part
  std::map<std::array<std::size_t, 4>, float> fills_;
};

}  // namespace

bool cut_hollow_charts(const ChartSurface& surface, std::span<const glm::vec2> plane,
                       float least_box, std::vector<Chart>& charts) {
  bool any = false;
  std::vector<std::uint8_t> pending(surface.mesh.triangle_count(), 0);
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto outlines = make_outlines(surface, charts, plane);
    std::vector<Chart> parts;
    for (std::size_t c = 0; c < charts.size(); ++c) {
      const float box = outlines[c].size.x * outlines[c].size.y;
      if (charts[c].faces.size() > 1 && box > least_box &&
          area_in_plane(plane, charts[c]) < kMinFill * box)
        for (const Chart& part : charts[c].faces.size() <= kFewFaces
                                     ? Joiner(surface, plane, charts[c]).join()
                                     : halves_of(charts[c], outlines[c], plane))
          append_connected_parts(surface, part, pending, parts);
      else
        parts.push_back(std::move(charts[c]));
    }
    const bool has_more = parts.size() > charts.size();
    charts = std::move(parts);
    if (!has_more) break;
    any = true;
  }
  return any;
}

}  // namespace strata::mesh
