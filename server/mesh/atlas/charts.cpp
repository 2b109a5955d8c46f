#include "mesh/atlas/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

#include "mesh/analysis/smooth.h"
#include "mesh/atlas/occupancy.h"
#include "mesh/parallel.h"
#include "mesh/surface/connectivity.h"
#include "mesh/surface/face_neighbours.h"

namespace strata::mesh {
namespace {

constexpr std::uint32_t kNoChart = 0xffffffffu, kKept = 0xfffffffeu;
constexpr std::size_t kWorthRegrowing = 16;  // faces
// number of faces; smaller charts give their faces to neighbors where possible
constexpr std::size_t kTinyChart = 24;
constexpr float kLikeTrend = 0.5f;
// side of the window, in half sides of a chart; long faces extend beyond a chart
constexpr double kWindow = 3;
constexpr double kSeedPiece = 2048;  // in texels; flat pieces at least this large seed charts first

void set_axis(Chart& chart, glm::vec3 axis) {
  chart.axis = axis;
  const glm::vec3 across = std::abs(axis.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  chart.u = glm::normalize(glm::cross(axis, across));
  chart.v = glm::cross(axis, chart.u);
}

Chart single_face_chart(const ChartSurface& surface, std::uint32_t face) {
  Chart chart;
  chart.uses_smoothed = false;
  chart.origin = surface.mesh.corner(face, 0);
  const glm::vec3 normal = surface.original_frames.normals[face];
  set_axis(chart, glm::dot(normal, normal) > 0.5f ? normal : glm::vec3(0, 0, 1));
  chart.faces = {face};
  return chart;
}

class Grower {
 public:
  Grower(const ChartSurface& surface, const ChartOptions& options)
      : surface_(surface),
        options_(options),
        density_(static_cast<float>(options.texels_per_unit)),
        smallest_cosine_(std::cos(glm::radians(options.cone_degrees))),
        occupancy_(static_cast<int>(kWindow) * options.largest_half_side),
        chart_of_face_(surface.mesh.triangle_count(), kNoChart),
        queued_at_(surface.mesh.triangle_count(), 0) {
    measure_pieces();
  }

  // Keeps the charts of all faces except the given faces.
  void keep_all_but(std::span<const std::uint32_t> faces) {
    std::fill(chart_of_face_.begin(), chart_of_face_.end(), kKept);
    for (const auto face : faces) chart_of_face_[face] = kNoChart;
    for (std::uint32_t piece = 0; piece < piece_kinds_.size(); ++piece)
      for (const auto face : surface_.flat.faces_of(piece))
        if (chart_of_face_[face] == kKept) piece_kinds_[piece] = PieceKind::loose;
  }
  bool grow_all(Progress* shown, const Progress& progress);  // false when cancelled
  void absorb_tiny();
  std::vector<Chart> take() { return std::move(charts_); }

 private:
  // Specifies whether the faces of a flat piece are added together or one by one. A piece that is
  // too_large is larger than the window in which charts grow.
  enum class PieceKind : std::uint8_t { loose, whole, too_large };

  void measure_pieces();
  PieceKind kind_of(std::uint32_t face) const {
    const std::uint32_t piece = surface_.flat.piece_of(face);
    return piece == FlatPieces::kNone ? PieceKind::loose : piece_kinds_[piece];
  }
  // Returns the faces that are added together with this face, including the face itself.
  std::span<const std::uint32_t> unit_of(const std::uint32_t& face) const {
    return kind_of(face) == PieceKind::loose ? std::span(&face, 1)
                                             : surface_.flat.faces_of(surface_.flat.piece_of(face));
  }
  bool can_project(std::uint32_t face, glm::vec3 axis) const {
    const float cosine = glm::dot(surface_.smoothed_frames.normals[face], axis);
    return cosine >= options_.smallest_footprint &&
           surface_.smoothed_frames.areas[face] * cosine >=
               options_.smallest_footprint * surface_.original_frames.areas[face];
  }
  std::array<glm::vec2, 3> texels_of(const Chart& chart, std::uint32_t face) const {
    std::array<glm::vec2, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = chart.project(surface_.corner(chart, face, k)) * density_;
    return p;
  }
  bool begins_near(const Chart& chart, std::span<const std::uint32_t> faces) const {
    const auto half = static_cast<float>(options_.largest_half_side - 1);
    return std::any_of(faces.begin(), faces.end(), [&](auto face) {
      const auto p = texels_of(chart, face);
      return std::any_of(p.begin(), p.end(),
                         [&](auto q) { return std::max(std::abs(q.x), std::abs(q.y)) < half; });
    });
  }
  bool claim(const Chart& chart, std::uint32_t face, Occupancy::Overlap overlap) {
    const auto p = texels_of(chart, face);
    return occupancy_.claim(p[0], p[1], p[2], overlap);
  }
  // Claims either all of the faces or none of them.
  bool claim(const Chart& chart, std::span<const std::uint32_t> faces, Occupancy::Overlap overlap) {
    if (faces.size() == 1) return claim(chart, faces.front(), overlap);
    if (overlap == Occupancy::Overlap::refuse)
      for (const auto face : faces)
        if (const auto p = texels_of(chart, face); !occupancy_.is_free(p[0], p[1], p[2]))
          return false;
    for (const auto face : faces) claim(chart, face, Occupancy::Overlap::allow);
    return true;
  }
  void grow(std::uint32_t seed, glm::vec3 axis, std::uint32_t id, Chart& chart);
  void add_chart(std::uint32_t seed);
  std::uint32_t next_seed();
  std::uint32_t best_host(std::span<const std::uint32_t> unit) const;

  const ChartSurface& surface_;
  const ChartOptions& options_;
  const float density_;
  const float smallest_cosine_;
  Occupancy occupancy_;
  std::vector<PieceKind> piece_kinds_;
  std::vector<std::uint32_t> chart_of_face_;
  std::vector<std::uint32_t> queued_at_;  // number of the last growth that queued the face
  std::uint32_t growth_ = 0;
  std::vector<Chart> charts_;
  std::vector<std::uint32_t> front_;  // faces next to finished charts, the next seeds
  std::size_t seed_pieces_ = 0;       // flat pieces that seed charts first
  std::size_t piece_cursor_ = 0, front_cursor_ = 0, scan_cursor_ = 0;
};

void Grower::measure_pieces() {
  if (!options_.keeps_flat_pieces) return;
  const double largest = kWindow * options_.largest_half_side / options_.texels_per_unit;
  const double seed_area = kSeedPiece / (options_.texels_per_unit * options_.texels_per_unit);
  piece_kinds_.resize(surface_.flat.count());
  for (std::uint32_t piece = 0; piece < piece_kinds_.size(); ++piece) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    double area = 0;
    for (const auto face : surface_.flat.faces_of(piece)) {
      area += double{surface_.original_frames.areas[face]};
      for (int k = 0; k < 3; ++k) {
        low = glm::min(low, surface_.mesh.corner(face, k));
        high = glm::max(high, surface_.mesh.corner(face, k));
      }
    }
    piece_kinds_[piece] =
        double{glm::length(high - low)} > largest ? PieceKind::too_large : PieceKind::whole;
    if (area >= seed_area || piece_kinds_[piece] == PieceKind::too_large) seed_pieces_ = piece + 1;
  }
}

void Grower::grow(std::uint32_t seed, glm::vec3 axis, std::uint32_t id, Chart& chart) {
  set_axis(chart, axis);
  chart.origin = surface_.smoothed[surface_.mesh.triangles[3 * seed]];
  chart.faces.clear();
  occupancy_.clear();
  ++growth_;
  const float reach = 1.f / static_cast<float>(options_.largest_half_side);
  using Candidate = std::pair<float, std::uint32_t>;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
  queue.push({0.f, seed});
  queued_at_[seed] = growth_;
  while (!queue.empty()) {
    const std::uint32_t face = queue.top().second;
    queue.pop();
    if (chart_of_face_[face] == id) continue;  // the face was added with its flat piece
    const bool is_seed = face == seed;
    if (!is_seed && (glm::dot(surface_.trend_normals[face], axis) < smallest_cosine_ ||
                     !can_project(face, axis)))
      continue;
    const bool is_too_large = kind_of(face) == PieceKind::too_large;
    if (is_too_large && !is_seed) continue;
    const auto unit = unit_of(face);
    if (!is_seed && !begins_near(chart, unit)) continue;
    if (!is_too_large &&
        !claim(chart, unit, is_seed ? Occupancy::Overlap::allow : Occupancy::Overlap::refuse))
      continue;
    chart.faces.insert(chart.faces.end(), unit.begin(), unit.end());
    for (const auto taken : unit) chart_of_face_[taken] = id;
    if (is_too_large) return;
    for (const auto taken : unit)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t next = surface_.neighbours[3 * taken + k];
        if (next == kNoTriangle || chart_of_face_[next] != kNoChart || queued_at_[next] == growth_)
          continue;
        queued_at_[next] = growth_;
        const float tilt = 1 - glm::dot(surface_.trend_normals[next], axis);
        const float texels = glm::length(surface_.corner(chart, next, 0) - chart.origin) * density_;
        queue.push({2 * tilt + 0.5f * texels * reach, next});
      }
  }
}

void Grower::add_chart(std::uint32_t seed) {
  const auto id = static_cast<std::uint32_t>(charts_.size());
  const glm::vec3 trend = surface_.trend_normals[seed],
                  own = surface_.smoothed_frames.normals[seed];
  Chart chart;
  if (glm::vec3 axis = glm::dot(trend, own) > 0.3f ? trend : own; can_project(seed, axis)) {
    grow(seed, axis, id, chart);
    if (chart.faces.size() > kWorthRegrowing && kind_of(seed) != PieceKind::too_large) {
      glm::vec3 mean(0);
      for (const auto face : chart.faces)
        mean += surface_.trend_normals[face] * surface_.smoothed_frames.areas[face];
      mean = glm::normalize(mean);
      if (glm::dot(trend, mean) > smallest_cosine_ && can_project(seed, mean)) {
        for (const auto face : chart.faces) chart_of_face_[face] = kNoChart;
        grow(seed, mean, id, chart);
      }
    }
  }
  if (chart.faces.size() <= 1) chart = single_face_chart(surface_, seed);
  for (const auto face : chart.faces) chart_of_face_[face] = id;
  for (const auto face : chart.faces)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = surface_.neighbours[3 * face + k];
      if (next != kNoTriangle && chart_of_face_[next] == kNoChart) front_.push_back(next);
    }
  charts_.push_back(std::move(chart));
}

std::uint32_t Grower::next_seed() {
  for (; piece_cursor_ < seed_pieces_; ++piece_cursor_) {
    const std::uint32_t face =
        surface_.flat.faces_of(static_cast<std::uint32_t>(piece_cursor_)).front();
    if (piece_kinds_[piece_cursor_] != PieceKind::loose && chart_of_face_[face] == kNoChart)
      return face;
  }
  for (; front_cursor_ < front_.size(); ++front_cursor_)
    if (chart_of_face_[front_[front_cursor_]] == kNoChart) return front_[front_cursor_];
  front_.clear();
  front_cursor_ = 0;
  for (; scan_cursor_ < chart_of_face_.size(); ++scan_cursor_)
    if (chart_of_face_[scan_cursor_] == kNoChart) return static_cast<std::uint32_t>(scan_cursor_);
  return kNoTriangle;
}

bool Grower::grow_all(Progress* shown, const Progress& progress) {
  std::size_t done = 0;
  for (std::uint32_t seed = next_seed(); seed != kNoTriangle; seed = next_seed()) {
    if (progress.cancelled()) return false;
    add_chart(seed);
    done += charts_.back().faces.size();
    if (shown && charts_.size() % 16 == 0)
      shown->report(options_.progress_from + (options_.progress_to - options_.progress_from) *
                                                 static_cast<double>(done) /
                                                 static_cast<double>(chart_of_face_.size()),
                    "Cutting the surface into charts");
  }
  return true;
}

// Returns the large neighboring chart on whose plane the unit has the largest footprint.
std::uint32_t Grower::best_host(std::span<const std::uint32_t> unit) const {
  std::uint32_t best = kNoChart;
  float best_cosine = options_.smallest_footprint;
  for (const auto face : unit)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = surface_.neighbours[3 * face + k];
      if (next == kNoTriangle) continue;
      const std::uint32_t host = chart_of_face_[next];
      if (host == chart_of_face_[face] || charts_[host].faces.size() < kTinyChart) continue;
      if (kind_of(charts_[host].faces.front()) == PieceKind::too_large) continue;
      const glm::vec3 axis = charts_[host].axis;
      const float cosine = glm::dot(surface_.smoothed_frames.normals[face], axis);
      if (cosine > best_cosine && can_project(face, axis)) best = host, best_cosine = cosine;
    }
  return best;
}

void Grower::absorb_tiny() {
  for (int pass = 0; pass < 4; ++pass) {
    // the first face of each unit
    std::map<std::uint32_t, std::vector<std::uint32_t>> guests_of_host;
    for (const Chart& chart : charts_)
      if (chart.faces.size() < kTinyChart)
        for (const auto face : chart.faces)
          if (const auto unit = unit_of(face); unit.front() == face)
            if (const auto host = best_host(unit); host != kNoChart)
              guests_of_host[host].push_back(face);
    std::size_t moved = 0;
    for (const auto& [host, guests] : guests_of_host) {
      occupancy_.clear();
      for (const auto face : charts_[host].faces)
        claim(charts_[host], face, Occupancy::Overlap::allow);
      for (const auto& guest : guests) {
        const auto unit = unit_of(guest);
        if (!claim(charts_[host], unit, Occupancy::Overlap::refuse)) continue;
        for (const auto face : unit) {
          std::erase(charts_[chart_of_face_[face]].faces, face);
          charts_[host].faces.push_back(face);
          chart_of_face_[face] = host;
        }
        ++moved;
      }
    }
    if (moved == 0) break;
  }
}

}  // namespace

ChartSurface make_chart_surface(const UnitMesh& mesh, int smoothing) {
  ChartSurface surface{mesh, {}, {}, {}, {}, {}, {}};
  std::optional<Connectivity> connectivity;
  parallel_for(2, 2, [&](int i) {
    if (i == 0) {
      connectivity.emplace(mesh.triangles, mesh.positions.size());
      surface.neighbours = face_neighbours(*connectivity);
    } else {
      surface.original_frames = face_frames(mesh.triangles, mesh.positions);
    }
  });
  surface.flat = find_flat_pieces(mesh, surface.neighbours, surface.original_frames);
  // Flat pieces have no noise. Smoothing would round off their edges and shrink a cube of twelve
  // triangles to a ball.
  std::vector<std::uint8_t> stays;
  if (surface.flat.count() > 0) stays.assign(mesh.positions.size(), 0);
  for (const auto face : surface.flat.faces)
    for (int k = 0; k < 3; ++k) stays[mesh.triangles[3 * std::size_t{face} + k]] = 1;
  surface.smoothed =
      laplacian_smoothed(mesh.triangles, *connectivity, mesh.positions, smoothing, stays);
  connectivity.reset();  // later steps use `neighbours`, which takes a fifth of the memory
  surface.smoothed_frames = face_frames(mesh.triangles, surface.smoothed);
  surface.trend_normals =
      averaged_normals(mesh.triangles, mesh.positions.size(), surface.smoothed_frames, 3);
  for (std::uint32_t piece = 0; piece < surface.flat.count(); ++piece)
    for (const auto face : surface.flat.faces_of(piece))
      surface.trend_normals[face] = surface.flat.normals[piece];
  // Around the ends of long faces the mean normal is not meaningful.
  for (std::size_t face = 0; face < mesh.triangle_count(); ++face)
    if (glm::dot(surface.trend_normals[face], surface.smoothed_frames.normals[face]) < kLikeTrend)
      surface.trend_normals[face] = surface.smoothed_frames.normals[face];
  return surface;
}

void append_connected_parts(const ChartSurface& surface, const Chart& chart,
                            std::vector<std::uint8_t>& pending, std::vector<Chart>& charts) {
  for (const auto face : chart.faces) pending[face] = 1;
  std::vector<std::uint32_t> part;
  for (const auto first : chart.faces) {
    if (!pending[first]) continue;
    part.assign(1, first);
    pending[first] = 0;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t next = surface.neighbours[3 * part[i] + k];
        if (next == kNoTriangle || !pending[next]) continue;
        pending[next] = 0;
        part.push_back(next);
      }
    Chart whole = part.size() == 1 ? single_face_chart(surface, part.front()) : chart;
    whole.faces = part;
    charts.push_back(std::move(whole));
  }
}

std::optional<std::vector<Chart>> grow_charts(const ChartSurface& surface,
                                              const ChartOptions& options, Progress& progress) {
  Grower grower(surface, options);
  if (!grower.grow_all(&progress, progress)) return std::nullopt;
  grower.absorb_tiny();
  std::vector<Chart> connected;
  std::vector<std::uint8_t> pending(surface.mesh.triangle_count(), 0);
  for (const Chart& chart : grower.take())
    append_connected_parts(surface, chart, pending, connected);
  return connected;
}

std::optional<std::size_t> split_off(const ChartSurface& surface,
                                     std::span<const std::uint32_t> faces,
                                     const ChartOptions& options, const Progress& progress,
                                     std::vector<Chart>& charts) {
  std::vector<std::uint8_t> leaves(surface.mesh.triangle_count(), 0);
  std::vector<std::uint8_t> pending(surface.mesh.triangle_count(), 0);
  std::vector<std::uint32_t> leaving;
  const auto leave = [&](std::uint32_t face) {
    if (!leaves[face]) leaving.push_back(face);
    leaves[face] = 1;
  };
  for (const auto face : faces) {
    leave(face);
    const std::uint32_t piece =
        options.keeps_flat_pieces ? surface.flat.piece_of(face) : FlatPieces::kNone;
    if (piece != FlatPieces::kNone)
      for (const auto other : surface.flat.faces_of(piece)) leave(other);
  }
  std::vector<Chart> result;
  for (Chart& chart : charts) {
    if (std::erase_if(chart.faces, [&](std::uint32_t face) { return leaves[face] != 0; }) == 0)
      result.push_back(std::move(chart));
    else if (!chart.faces.empty())
      append_connected_parts(surface, chart, pending, result);
  }
  const std::size_t first = result.size();
  Grower grower(surface, options);
  grower.keep_all_but(leaving);
  if (!grower.grow_all(nullptr, progress)) return std::nullopt;
  for (Chart& chart : grower.take()) result.push_back(std::move(chart));
  charts = std::move(result);
  return first;
}

}  // namespace strata::mesh
