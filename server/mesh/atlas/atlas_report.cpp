#include "mesh/atlas/atlas_report.h"

#include <algorithm>
#include <cmath>

#include "mesh/parallel.h"
#include "mesh/texels/texel_pieces.h"
#include "mesh/texels/texel_raster.h"

namespace strata::mesh {
namespace {

double area_of(const TriangleMesh& mesh, std::size_t f) {
  const auto a = mesh.positions[mesh.triangles[3 * f]];
  return glm::length(glm::cross(mesh.positions[mesh.triangles[3 * f + 1]] - a,
                                mesh.positions[mesh.triangles[3 * f + 2]] - a)) /
         2;
}

struct Stretch {
  float ratio;  // surface area per uv area
  float area;
};

// The stretch of a triangle is limited to this multiple of the mean, because the ratio of a sliver
// is not meaningful for the atlas.
constexpr double kMaxStretch = 50;
constexpr int kMaxMeasured = 8192;                         // finer grids would take seconds
constexpr std::size_t kBandTexels = std::size_t{1} << 22;  // texels measured at a time

void sum_stretch(std::vector<Stretch> faces, double area, double uv_area, AtlasMeasure& measure) {
  if (area <= 0 || uv_area <= 0) return;
  const double mean_ratio = area / uv_area;
  double sum = 0;
  for (auto& face : faces) {
    face.ratio = static_cast<float>(std::min(kMaxStretch, face.ratio / mean_ratio));
    sum += double{face.ratio} * face.area;
  }
  measure.stretch_mean = sum / area;
  std::sort(faces.begin(), faces.end(),
            [](const Stretch& a, const Stretch& b) { return a.ratio < b.ratio; });
  double below = 0;
  for (const auto& face : faces) {
    below += face.area;
    measure.stretch_p99 = face.ratio;
    if (below >= 0.99 * area) break;
  }
}

// Returns the factor that scales the areas of the triangles so that their mean is 1. With this
// factor, nanometer and megameter models stay within the range of float.
double scale_of(const TriangleMesh& mesh, double area) {
  return area > 0 ? static_cast<double>(mesh.triangle_count()) / area : 1;
}

}  // namespace

AtlasMeasure measure_areas(const TriangleMesh& mesh, std::span<const glm::vec2> uvs) {
  AtlasMeasure measure;
  measure.area = surface_area(mesh);
  const double scale = scale_of(mesh, measure.area);
  std::vector<Stretch> faces;
  faces.reserve(mesh.triangle_count());
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f) {
    const double area = area_of(mesh, f);
    const glm::dvec2 a = uvs[3 * f], ab = glm::dvec2(uvs[3 * f + 1]) - a,
                     ac = glm::dvec2(uvs[3 * f + 2]) - a;
    const double uv_area = std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
    if (uv_area == 0) measure.area_without_uv += area;
    if (area == 0) continue;
    measure.uv_area += uv_area;
    faces.push_back({static_cast<float>(area * scale / std::max(uv_area, 1e-18)),
                     static_cast<float>(area * scale)});
  }
  sum_stretch(std::move(faces), measure.area * scale, measure.uv_area, measure);
  return measure;
}

double largest_texel_area(const TriangleMesh& mesh, std::span<const glm::vec2> uvs,
                          int resolution) {
  const auto side = static_cast<std::size_t>(resolution);
  const double scale = scale_of(mesh, surface_area(mesh));
  // The atlas is measured in bands, because the whole atlas at 8192² would take 268 MB.
  const int rows = static_cast<int>(std::max<std::size_t>(1, kBandTexels / side));
  std::vector<float> texel_areas(side * static_cast<std::size_t>(rows));
  float largest = 0;
  TexelPieces pieces;
  for (int row_begin = 0; row_begin < resolution; row_begin += rows) {
    const int row_end = std::min(resolution, row_begin + rows);
    std::fill(texel_areas.begin(), texel_areas.end(), 0.f);
    const auto texel = [&](int x, int y) -> float& {
      const std::size_t column = std::min(static_cast<std::size_t>(x), side - 1);
      return texel_areas[static_cast<std::size_t>(y - row_begin) * side + column];
    };
    for (std::size_t f = 0; f < mesh.triangle_count(); ++f) {
      const glm::dvec2 a = glm::dvec2(uvs[3 * f]) * double(resolution),
                       b = glm::dvec2(uvs[3 * f + 1]) * double(resolution),
                       c = glm::dvec2(uvs[3 * f + 2]) * double(resolution);
      if (std::max({a.y, b.y, c.y}) < row_begin || std::min({a.y, b.y, c.y}) > row_end) continue;
      const double area = area_of(mesh, f) * scale;
      if (area == 0) continue;
      pieces.set(a, b, c);
      if (pieces.is_line()) {
        const int row = std::min(static_cast<int>(pieces.centroid().y), resolution - 1);
        if (row >= row_begin && row < row_end)
          texel(static_cast<int>(pieces.centroid().x), row) += static_cast<float>(area);
      } else {
        const double area_per_texel = area / pieces.area();
        pieces.for_each(row_begin, row_end, [&](int x, int y, double piece) {
          texel(x, y) += static_cast<float>(piece * area_per_texel);
        });
      }
    }
    largest = std::max(largest, *std::max_element(texel_areas.begin(), texel_areas.end()));
  }
  return double{largest} / scale;
}

TexelCounts count_owners(const TriangleMesh& mesh, std::span<const glm::vec2> uvs, int resolution) {
  TexelCounts result;
  const auto side = static_cast<std::size_t>(resolution);
  std::vector<std::uint8_t> owners(side * side, 0);  // 2: two or more
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f) {
    const auto snapped = [&](int k) {
      const glm::vec2 uv = uvs[3 * f + k];
      return snap_to_subtexels(double{uv.x} * resolution, double{uv.y} * resolution);
    };
    bool is_second = false;
    CoverageRaster(snapped(0), snapped(1), snapped(2))
        .for_each_span(0, resolution, 0, resolution, [&](int y, int begin, int end) {
          std::uint8_t* row = owners.data() + y * side;
          for (int x = begin; x < end; ++x) {
            result.covered += row[x] == 0;
            result.shared += row[x] == 1;
            is_second |= row[x] != 0;
            row[x] = row[x] == 0 ? 1 : 2;
          }
          return true;
        });
    if (is_second) result.shared_by.push_back(static_cast<std::uint32_t>(f));
  }
  return result;
}

AtlasReport make_report(const TriangleMesh& mesh, std::span<const glm::vec2> uvs,
                        int lowest_resolution, const TexelCounts& owners,
                        const AtlasMeasure& measure) {
  AtlasReport report;
  report.lowest_resolution = lowest_resolution;
  const auto covered = static_cast<double>(owners.covered);
  report.coverage = covered / (double(lowest_resolution) * lowest_resolution);
  report.overlap = covered > 0 ? static_cast<double>(owners.shared) / covered : 0;
  report.stretch_mean = measure.stretch_mean;
  report.stretch_p99 = measure.stretch_p99;
  for (int resolution = lowest_resolution;
       resolution <= std::min(4 * lowest_resolution, kMaxMeasured); resolution *= 2) {
    const double texels = measure.uv_area * resolution * resolution;
    report.texel_sizes.push_back({resolution, texels > 0 ? measure.area / texels : 0, 0});
  }
  const int count = static_cast<int>(report.texel_sizes.size());
  parallel_for(2, count, [&](int i) {  // starts with the largest resolution
    auto& size = report.texel_sizes[count - 1 - i];
    size.area_max = largest_texel_area(mesh, uvs, size.resolution);
  });
  report.texel_area_max = report.texel_sizes.empty() ? 0 : report.texel_sizes.front().area_max;
  return report;
}

}  // namespace strata::mesh
