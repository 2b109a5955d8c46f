#include "mesh/analysis/surface_samples.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "mesh/buckets.h"
#include "mesh/longest_axis.h"

namespace strata::mesh {
namespace {

constexpr int kCellsPerRadius = 5;
constexpr float kEdgesPerRadius = 2;  // of the pieces of triangles that are cut for `vertices`
constexpr double kMaxPieces = 2e7;
// A group stores its cell with 20 bits per axis.
constexpr double kMaxCells = 1 << 20;
constexpr int kMaxBands = 64;
// For triangles with more cuts, only the pieces that may be in a band are made.
constexpr int kManyCuts = 8;
constexpr const char* kSampling = "Sampling the surface";

struct Piece {
  std::uint64_t group;  // fine cell and facing direction
  glm::vec3 position, normal;
  float area, vertices;
};

// Returns the number of the axis direction, one of six, that is nearest to a normal.
std::uint64_t facing(const glm::vec3& n) {
  const glm::vec3 size = glm::abs(n);
  const int axis = longest_axis(size);
  return std::uint64_t{2} * static_cast<std::uint64_t>(axis) + (n[axis] < 0 ? 1u : 0u);
}

}  // namespace

// Makes, groups and discards the pieces in bands perpendicular to the model's longest axis. The
// bands do not depend on the number of threads.
class SampleBands {
 public:
  SampleBands(const Geometry& geometry, SurfaceSamples& samples, SurfaceSamples::Pieces pieces)
      : geometry_(geometry),
        samples_(samples),
        at_vertices_(pieces == SurfaceSamples::Pieces::vertices),
        cell_(samples.radius_ / kCellsPerRadius),
        edge_(at_vertices_ ? samples.radius_ / kEdgesPerRadius : cell_) {
    const glm::vec3 extent = geometry.box_max - geometry.box_min;
    axis_ = longest_axis(extent);
    cells_ = static_cast<int>(
        std::min(std::floor(extent[axis_] / cell_) + 1.0f, static_cast<float>(kMaxCells)));
    bands_.resize(std::min(kMaxBands, cells_));
    triangles_of_band_ = triangles_by_band();
  }

  int count() const { return static_cast<int>(bands_.size()); }

  // Several threads may process different bands at the same time.
  void sample(int which) {
    Band& band = bands_[which];
    const int first_cell = first_cell_of(which), end_cell = first_cell_of(which + 1);
    std::vector<Piece> pieces;
    const auto triangles = triangles_of_band_[which];
    pieces.reserve(2 * triangles.size());
    for (const std::uint32_t t : triangles) cut(t, first_cell, end_cell, pieces);
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& p, const Piece& q) { return p.group < q.group; });

    struct Keyed {
      std::uint64_t cell;
      SurfaceSamples::Sample sample;
    };
    std::vector<Keyed> keyed;
    for (std::size_t i = 0; i < pieces.size();) {
      glm::dvec3 position(0), normal(0);
      double area = 0;
      float vertices = 0;
      const auto group = pieces[i].group;
      for (; i < pieces.size() && pieces[i].group == group; ++i) {
        area += pieces[i].area;
        vertices += pieces[i].vertices;
        position += double{pieces[i].area} * glm::dvec3(pieces[i].position);
        normal += double{pieces[i].area} * glm::dvec3(pieces[i].normal);
      }
      const SurfaceSamples::Sample sample{glm::vec3(position / area),
                                          glm::vec3(glm::normalize(normal)),
                                          static_cast<float>(area), vertices};
      keyed.push_back({SurfaceSamples::key_of(samples_.cell_of(sample.position)), sample});
    }
    pieces = {};
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const Keyed& p, const Keyed& q) { return p.cell < q.cell; });
    band.samples.reserve(keyed.size());
    for (const Keyed& k : keyed) {
      if (band.runs.empty() || band.runs.back().cell != k.cell) band.runs.push_back({k.cell, 0});
      ++band.runs.back().count;
      band.samples.push_back(k.sample);
    }
  }

  // Merges the samples that several bands have in the same cell. Call it after all bands are
  // sampled.
  void gather() {
    auto& cells = samples_.cells_;
    std::uint32_t total = 0;
    for (const Band& band : bands_)
      for (const Run& run : band.runs) cells[run.cell].count += run.count;
    for (const Band& band : bands_)
      for (const Run& run : band.runs)
        if (auto& range = cells[run.cell]; range.first == SurfaceSamples::kUnplaced) {
          range.first = total;
          total += range.count;
          range.count = 0;
        }
    samples_.samples_.resize(total);
    for (Band& band : bands_) {
      auto from = band.samples.begin();
      for (const Run& run : band.runs) {
        auto& range = cells[run.cell];
        std::copy_n(from, run.count, samples_.samples_.begin() + range.first + range.count);
        range.count += run.count;
        from += run.count;
      }
      band = {};
    }
  }

 private:
  struct Run {  // samples of one cell
    std::uint64_t cell;
    std::uint32_t count;
  };
  struct Band {
    std::vector<SurfaceSamples::Sample> samples;
    std::vector<Run> runs;
  };

  int first_cell_of(int band) const {
    return static_cast<int>(static_cast<std::int64_t>(cells_) * band / count());
  }
  // Also accepts cells outside the bounding box.
  int band_of(int cell) const {
    const auto inside = static_cast<std::int64_t>(std::clamp(cell, 0, cells_ - 1));
    return static_cast<int>(((inside + 1) * count() - 1) / cells_);
  }
  glm::vec3 corner(std::uint32_t triangle, int k) const {
    return geometry_.vertices[geometry_.indices[3 * std::size_t{triangle} + k]].position;
  }

  Buckets triangles_by_band() const {
    return {count(), static_cast<std::uint32_t>(geometry_.triangle_count()), [&](std::uint32_t t) {
              const float a = corner(t, 0)[axis_], b = corner(t, 1)[axis_], c = corner(t, 2)[axis_];
              // The range is one cell wider on each side, to allow for rounding.
              const auto cell_at = [&](float at) {
                return static_cast<int>(std::floor((at - samples_.low_[axis_]) / cell_));
              };
              return std::pair{band_of(cell_at(std::min({a, b, c})) - 1),
                               band_of(cell_at(std::max({a, b, c})) + 1)};
            }};
  }

  // Appends the pieces of a triangle that are in cells [first, end) along the axis.
  void cut(std::uint32_t triangle, int first, int end, std::vector<Piece>& pieces) const {
    const glm::vec3 a = corner(triangle, 0), ab = corner(triangle, 1) - a,
                    ac = corner(triangle, 2) - a;
    const glm::vec3 cross = glm::cross(ab, ac);
    const float length = glm::length(cross);
    if (!(length > 0)) return;
    const glm::vec3 normal = cross / length;
    const float longest =
        std::sqrt(std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(ac - ab, ac - ab)}));
    const int cuts = std::max(1, static_cast<int>(std::ceil(longest / edge_)));
    // A triangle has three pieces at its vertices, or else `cuts`² pieces. Together they count as
    // half a vertex.
    const bool at_vertices = at_vertices_ && cuts == 1;
    const float parts = at_vertices ? 3.0f : static_cast<float>(cuts) * static_cast<float>(cuts);
    const float area = length / 2 / parts, vertices = 0.5f / parts;
    const auto add = [&](float i, float j) {
      const glm::vec3 position = a + (i * ab + j * ac) / static_cast<float>(cuts);
      const glm::ivec3 fine(glm::floor((position - samples_.low_) / cell_));
      const int along = std::clamp(fine[axis_], 0, cells_ - 1);
      if (along < first || along >= end) return;
      const std::uint64_t group = (std::uint64_t(std::uint32_t(fine.x) & 0xfffff) << 3) |
                                  (std::uint64_t(std::uint32_t(fine.y) & 0xfffff) << 23) |
                                  (std::uint64_t(std::uint32_t(fine.z) & 0xfffff) << 43) |
                                  facing(normal);
      pieces.push_back({group, position, normal, area, vertices});
    };
    if (at_vertices) {
      add(0, 0);
      add(1, 0);
      add(0, 1);
      return;
    }
    for (int i = 0; i < cuts; ++i) {
      int j_begin = 0, j_end = cuts - i;
      if (cuts > kManyCuts) {
        // Selects the pieces in [first, end). Adds 2 edges and 1 piece for their size and rounding.
        const double at = (a[axis_] + double{ab[axis_]} * i / cuts - samples_.low_[axis_]) / cell_;
        const double step = double{ac[axis_]} / cuts / cell_;
        const double margin = 2 * edge_ / cell_;
        const double low = (first - margin - at) / step, high = (end + margin - at) / step;
        if (!std::isnan(low) && !std::isnan(high)) {
          // The bounds are infinite for a row parallel to the band, inside or outside it.
          j_begin = static_cast<int>(std::clamp(std::min(low, high) - 1, 0.0, double(j_end)));
          j_end = static_cast<int>(std::clamp(std::max(low, high) + 2, 0.0, double(j_end)));
        }
      }
      for (int j = j_begin; j < j_end; ++j) {
        add(static_cast<float>(i) + 1.0f / 3, static_cast<float>(j) + 1.0f / 3);
        if (i + j + 1 < cuts)
          add(static_cast<float>(i) + 2.0f / 3, static_cast<float>(j) + 2.0f / 3);
      }
    }
  }

  const Geometry& geometry_;
  SurfaceSamples& samples_;
  const bool at_vertices_;
  const float cell_;
  const float edge_;  // the longest edge of a piece
  int axis_ = 0, cells_ = 1;
  std::vector<Band> bands_;
  Buckets triangles_of_band_;
};

double SurfaceSamples::least_radius(double area, const glm::dvec3& extent) {
  const double by_pieces = kCellsPerRadius * std::sqrt(2 * area / kMaxPieces);
  const double by_cells = kCellsPerRadius * std::max({extent.x, extent.y, extent.z}) / kMaxCells;
  return std::max(by_pieces, by_cells);
}

Result<SurfaceSamples> SurfaceSamples::make(const Geometry& geometry, float radius,
                                            Progress& progress, int threads, Pieces pieces) {
  progress.report(0, kSampling);
  SurfaceSamples samples(geometry.box_min, radius);
  SampleBands bands(geometry, samples, pieces);
  std::atomic<int> done{0};
  parallel_for(threads, bands.count(), [&](int band) {
    if (progress.cancelled()) return;
    bands.sample(band);
    progress.report(static_cast<double>(++done) / bands.count(), kSampling);
  });
  if (progress.cancelled()) return cancelled_problem();
  bands.gather();
  samples.find_near_wide_cells();
  return samples;
}

void SurfaceSamples::find_near_wide_cells() {
  std::unordered_map<std::uint64_t, glm::ivec3> with_samples;
  for (const auto& [key, range] : cells_) {
    const glm::ivec3 cell = wide(cell_of(samples_[range.first].position));
    with_samples.emplace(key_of(cell), cell);
  }
  for (const auto& [key, cell] : with_samples)
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) near_wide_cells_.insert(key_of(cell + glm::ivec3(x, y, z)));
}

std::span<const SurfaceSamples::Sample> SurfaceSamples::in_cell(const glm::ivec3& cell) const {
  const auto found = cells_.find(key_of(cell));
  if (found == cells_.end()) return {};
  return {samples_.data() + found->second.first, found->second.count};
}

}  // namespace strata::mesh
