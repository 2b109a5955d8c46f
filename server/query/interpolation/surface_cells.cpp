#include "query/interpolation/surface_cells.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <unordered_map>
#include <utility>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/texel_discs.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;
using mesh::Way;

glm::dvec3 place(const mesh::SurfaceMap& map, std::uint32_t texel) {
  return glm::dvec3(map.position(texel / 64, static_cast<int>(texel % 64)));
}

// Chooses the centers and gives each texel to the nearest of them.
class CellMaker {
 public:
  CellMaker(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, double spacing)
      : map_(map),
        graph_(graph),
        spacing_(spacing),
        slack_(kSlackTexels * mean_texel_size(map)),
        distance_(map.block_of_slot.size() * 64, std::numeric_limits<float>::infinity()),
        seen_by_(distance_.size(), kNoCell) {
    cells_.spacing = spacing;
    cells_.of_texel.assign(distance_.size(), kNoCell);
  }

  // Returns false if there would be more than max_cells.
  Result<bool> make(std::span<const std::uint32_t> starts, std::size_t max_cells,
                    const Progress& progress) {
    for (const std::uint32_t start : starts) {
      waiting_.assign(1, start);
      while (!waiting_.empty()) {
        const std::uint32_t texel = waiting_.front();
        waiting_.pop_front();
        if (cells_.of_texel[texel] != kNoCell) continue;
        if (cells_.count() == max_cells) return false;
        if (progress.cancelled()) return cancelled_problem();
        add_cell(texel);
      }
    }
    return true;
  }

  SurfaceCells take_cells() { return std::move(cells_); }

 private:
  // A texel belongs to the disc around a center if the path of steps to it is at most this much
  // longer than the straight line. Around the rim of a thin wall, paths are much longer.
  static constexpr double kLongestPath = 2, kSlackTexels = 3;

  void add_cell(std::uint32_t texel) {
    const auto cell = static_cast<std::uint32_t>(cells_.count());
    const glm::dvec3 center = place(map_, texel);
    cells_.centers.push_back(center);
    seen_by_[texel] = cell;
    open_.assign(1, {texel, 0.0});
    for (std::size_t next = 0; next < open_.size(); ++next) {
      const auto [from, path] = open_[next];
      const glm::dvec3 from_place = place(map_, from);
      if (const auto distance = static_cast<float>(glm::distance(from_place, center));
          distance < distance_[from]) {
        distance_[from] = distance;
        cells_.of_texel[from] = cell;
      }
      mesh::for_each_neighbour(
          map_, graph_, from, [&, from_path = path, this](std::uint32_t other) {
            if (seen_by_[other] == cell) return;
            seen_by_[other] = cell;
            const glm::dvec3 to_place = place(map_, other);
            const double straight = glm::distance(to_place, center),
                         to_path = from_path + glm::distance(from_place, to_place);
            if (straight <= spacing_ && to_path <= kLongestPath * straight + slack_)
              open_.emplace_back(other, to_path);
            else if (cells_.of_texel[other] == kNoCell)
              waiting_.push_back(other);
          });
    }
  }

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const double spacing_, slack_;
  SurfaceCells cells_;
  std::vector<float> distance_;         // of each texel from the center of its cell
  std::vector<std::uint32_t> seen_by_;  // the last cell that reached the texel
  std::vector<std::pair<std::uint32_t, double>> open_;
  std::deque<std::uint32_t> waiting_;  // texels next to the cells
};

// The borders between cells as vectors: the normal times the length. Vectors of the sides of texels
// add up to that of the whole border, however many steps the border has.
class Borders {
 public:
  Borders(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, const SurfaceCells& cells)
      : map_(map), graph_(graph), cells_(cells) {}

  Result<void> measure(const Progress& progress) {
    for (std::uint32_t slot = 0; slot < map_.block_of_slot.size(); ++slot) {
      if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
      for (std::uint64_t left = map_.surface_mask[slot]; left != 0; left &= left - 1) {
        const std::uint32_t texel = slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
        if (cells_.of_texel[texel] == kNoCell) continue;
        add_to_neighbour(texel, Way::right);
        add_to_neighbour(texel, Way::upper);
        if ((graph_.has_links[slot] >> texel % 64 & 1u) != 0) add_to_links(texel);
      }
    }
    return {};
  }

  // Calls visit(a, b, conductance) in ascending order, with a < b.
  template <class Visit>
  void for_each(Visit&& visit) const {
    std::vector<std::pair<std::uint64_t, glm::dvec3>> list(border_of_.begin(), border_of_.end());
    std::ranges::sort(list, {}, [](const auto& entry) { return entry.first; });
    for (const auto& [pair, border] : list) {
      const auto a = static_cast<std::uint32_t>(pair >> 32), b = static_cast<std::uint32_t>(pair);
      const glm::dvec3 way = cells_.centers[b] - cells_.centers[a];
      const double distance = std::max(glm::length(way), kLeastDistance * cells_.spacing);
      // At a fold the vectors of both sides differ.
      const double length =
          std::max(glm::dot(border, way) / distance, kLeastShare * glm::length(border));
      visit(a, b, std::max(length / distance, kLeastConductance));
    }
  }

 private:
  static constexpr double kLeastDistance = 0.1, kLeastShare = 0.1, kLeastConductance = 1e-3;

  // Returns a step to the right or upwards in the atlas, on the surface, or 0 if it is not known.
  glm::dvec3 step(std::uint32_t texel, Way forwards, Way backwards) const {
    const std::uint32_t next = mesh::neighbour(map_, graph_, texel, forwards),
                        last = mesh::neighbour(map_, graph_, texel, backwards);
    if (next == kNoNeighbour && last == kNoNeighbour) return glm::dvec3(0);
    const glm::dvec3 step = place(map_, next == kNoNeighbour ? texel : next) -
                            place(map_, last == kNoNeighbour ? texel : last);
    return next != kNoNeighbour && last != kNoNeighbour ? step / 2.0 : step;
  }
  glm::dvec3 x_step(std::uint32_t texel) const { return step(texel, Way::right, Way::left); }
  glm::dvec3 y_step(std::uint32_t texel) const { return step(texel, Way::upper, Way::lower); }

  // Returns the vector of a side of a texel. The side has the vector `along` and is crossed by a
  // step `across`.
  static glm::dvec3 side_vector(glm::dvec3 across, glm::dvec3 along) {
    const double area = glm::length(glm::cross(across, along));
    if (!(area > 1e-3 * glm::dot(across, across))) return across;  // an unknown or a flat texel
    return (across * glm::dot(along, along) - along * glm::dot(across, along)) / area;
  }

  void add(std::uint32_t from, std::uint32_t to, glm::dvec3 vector) {
    const std::uint32_t a = cells_.of_texel[from], b = cells_.of_texel[to];
    if (a == b) return;
    const auto [low, high] = std::minmax(a, b);
    border_of_.try_emplace(std::uint64_t{low} << 32 | high, glm::dvec3(0)).first->second +=
        a < b ? vector : -vector;
  }

  void add_to_neighbour(std::uint32_t texel, Way way) {
    const std::uint32_t other = mesh::neighbour(map_, graph_, texel, way);
    if (other == kNoNeighbour || cells_.of_texel[other] == cells_.of_texel[texel]) return;
    const glm::dvec3 along =
        way == Way::right ? y_step(texel) + y_step(other) : x_step(texel) + x_step(other);
    add(texel, other, side_vector(place(map_, other) - place(map_, texel), along / 2.0));
  }

  // Divides the sides of a texel that have no neighbor among its links. Each link is listed in both
  // directions, so that the border is the mean of both sides.
  void add_to_links(std::uint32_t texel) {
    const auto links = graph_.links_of(texel);
    const glm::dvec3 x = x_step(texel), y = y_step(texel);
    const glm::dvec3 right = side_vector(x, y), upper = side_vector(y, x);
    glm::dvec3 open(0);
    const auto is_open = [&](Way way) {
      return mesh::neighbour(map_, graph_, texel, way) == kNoNeighbour;
    };
    if (is_open(Way::right)) open += right;
    if (is_open(Way::left)) open -= right;
    if (is_open(Way::upper)) open += upper;
    if (is_open(Way::lower)) open -= upper;
    for (const auto& link : links)
      add(texel, link.second, open / (2.0 * static_cast<double>(links.size())));
  }

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const SurfaceCells& cells_;
  std::unordered_map<std::uint64_t, glm::dvec3> border_of_;  // from the lower to the higher cell
};

void add_areas(const mesh::SurfaceMap& map, SurfaceCells& cells) {
  cells.areas.assign(cells.count(), 0);
  for (std::uint32_t texel = 0; texel < cells.of_texel.size(); ++texel)
    if (const std::uint32_t cell = cells.of_texel[texel]; cell != kNoCell)
      cells.areas[cell] += double{map.area[texel]};
  // Some texels have no area of their own.
  const double least = 1e-3 * cells.spacing * cells.spacing;
  for (double& area : cells.areas) area = std::max(area, least);
}

void add_sides(const Borders& borders, SurfaceCells& cells) {
  std::vector<std::vector<SurfaceCells::Side>> sides(cells.count());
  borders.for_each([&](std::uint32_t a, std::uint32_t b, double conductance) {
    sides[a].push_back({b, conductance, {}});
    sides[b].push_back({a, conductance, {}});
  });
  cells.first_side.assign(1, 0);
  for (auto& of_cell : sides) {
    std::ranges::sort(of_cell, {}, &SurfaceCells::Side::other);
    cells.sides.insert(cells.sides.end(), of_cell.begin(), of_cell.end());
    cells.first_side.push_back(cells.sides.size());
  }
}

// Adds the neighbors of neighbors too, because four cells can meet at a corner.
void add_near_cells(SurfaceCells& cells) {
  const double reach = (SurfaceCells::kReach + 1) * cells.spacing;
  std::vector<std::uint32_t> found;
  cells.first_near.assign(1, 0);
  for (std::uint32_t cell = 0; cell < cells.count(); ++cell) {
    found.assign(1, cell);
    for (const auto& side : cells.sides_of(cell)) {
      found.push_back(side.other);
      for (const auto& next : cells.sides_of(side.other)) found.push_back(next.other);
    }
    std::ranges::sort(found);
    found.erase(std::ranges::unique(found).begin(), found.end());
    for (const std::uint32_t other : found)
      if (glm::distance(cells.centers[cell], cells.centers[other]) < reach)
        cells.near.push_back(other);
    cells.first_near.push_back(cells.near.size());
  }
}

// Fits gradients by least squares. Directions in which the cells around hardly extend, such as the
// normal, do not count.
void add_gradients(SurfaceCells& cells) {
  constexpr double kLeastExtent = 0.1;
  for (std::uint32_t cell = 0; cell < cells.count(); ++cell) {
    const std::span sides =
        std::span(cells.sides)
            .subspan(cells.first_side[cell], cells.first_side[cell + 1] - cells.first_side[cell]);
    const auto way_to = [&](const SurfaceCells::Side& side) {
      const glm::dvec3 way = cells.centers[side.other] - cells.centers[cell];
      return Eigen::Vector3d(way.x, way.y, way.z);
    };
    Eigen::Matrix3d extent = Eigen::Matrix3d::Zero();
    for (const auto& side : sides)
      extent += side.conductance * way_to(side) * way_to(side).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(extent);
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i)
      if (axes.eigenvalues()[i] > kLeastExtent * axes.eigenvalues()[2])
        inverse += axes.eigenvectors().col(i) * axes.eigenvectors().col(i).transpose() /
                   axes.eigenvalues()[i];
    for (auto& side : sides) {
      const Eigen::Vector3d gradient = side.conductance * (inverse * way_to(side));
      side.gradient = {gradient.x(), gradient.y(), gradient.z()};
    }
  }
}

}  // namespace

Result<std::optional<SurfaceCells>> make_surface_cells(const mesh::SurfaceMap& map,
                                                       const mesh::TexelGraph& graph,
                                                       std::span<const std::uint32_t> starts,
                                                       double spacing, std::size_t max_cells,
                                                       const Progress& progress) {
  std::optional<SurfaceCells> cells;
  {
    CellMaker maker(map, graph, spacing);
    if (!STRATA_TRY(maker.make(starts, max_cells, progress))) return cells;
    cells = maker.take_cells();
  }
  Borders borders(map, graph, *cells);
  STRATA_TRY(borders.measure(progress));
  add_areas(map, *cells);
  add_sides(borders, *cells);
  add_near_cells(*cells);
  add_gradients(*cells);
  return cells;
}

}  // namespace strata::query
