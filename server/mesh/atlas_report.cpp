#include "mesh/atlas_report.h"

#include <algorithm>
#include <cmath>

#include "mesh/texel_pieces.h"
#include "mesh/texel_raster.h"

namespace strata::mesh {
namespace {

double area_of(const TriangleMesh& mesh, std::size_t f) {
  const auto a = mesh.positions[mesh.triangles[3 * f]];
  return glm::length(
             glm::cross(mesh.positions[mesh.triangles[3 * f + 1]] - a, mesh.positions[mesh.triangles[3 * f + 2]] - a)) /
         2;
}

struct Stretch {
  float ratio;  // surface area per uv area
  float area;
};

// Stretch beyond this factor of the mean counts as this factor: a sliver's ratio says nothing about the atlas.
constexpr double kLargestStretch = 50;

void sum_stretch(std::vector<Stretch> faces, double area, double uv_area, AtlasMeasure& measure) {
  if (area <= 0 || uv_area <= 0) return;
  const double mean_ratio = area / uv_area;
  double sum = 0;
  for (auto& face : faces) {
    face.ratio = static_cast<float>(std::min(kLargestStretch, face.ratio / mean_ratio));
    sum += double{face.ratio} * face.area;
  }
  measure.stretch_mean = sum / area;
  std::sort(faces.begin(), faces.end(), [](const Stretch& a, const Stretch& b) { return a.ratio < b.ratio; });
  double below = 0;
  for (const auto& face : faces) {
    below += face.area;
    measure.stretch_p99 = face.ratio;
    if (below >= 0.99 * area) break;
  }
}

}  // namespace

AtlasMeasure measure_areas(const TriangleMesh& mesh, std::span<const glm::vec2> uvs, int resolution) {
  AtlasMeasure measure;
  const auto side = static_cast<std::size_t>(resolution);
  std::vector<float> texel_areas(side * side, 0.f);
  std::vector<Stretch> faces;
  faces.reserve(mesh.triangle_count());
  const auto texel = [&](double x, double y) -> float& {
    const auto column = std::min<std::size_t>(static_cast<std::size_t>(x), side - 1);
    return texel_areas[std::min<std::size_t>(static_cast<std::size_t>(y), side - 1) * side + column];
  };
  double uv_area = 0;
  TexelPieces pieces;
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f) measure.area += area_of(mesh, f);
  // Relative to the mean face, so that nanometre and megametre models stay inside float.
  const double scale = measure.area > 0 ? static_cast<double>(mesh.triangle_count()) / measure.area : 1;
  for (std::size_t f = 0; f < mesh.triangle_count(); ++f) {
    const double area = area_of(mesh, f);
    pieces.set(glm::dvec2(uvs[3 * f]) * double(resolution), glm::dvec2(uvs[3 * f + 1]) * double(resolution),
               glm::dvec2(uvs[3 * f + 2]) * double(resolution));
    if (pieces.area() == 0) measure.area_without_uv += area;
    if (area == 0) continue;
    uv_area += pieces.area();
    faces.push_back(
        {static_cast<float>(area * scale / std::max(pieces.area(), 1e-12)), static_cast<float>(area * scale)});
    if (pieces.is_line()) {
      texel(pieces.centroid().x, pieces.centroid().y) += static_cast<float>(area * scale);
    } else {
      const double area_per_texel = area * scale / pieces.area();
      pieces.for_each(0, resolution,
                      [&](int x, int y, double piece) { texel(x, y) += static_cast<float>(piece * area_per_texel); });
    }
  }
  for (const float area : texel_areas) measure.texel_area_max = std::max(measure.texel_area_max, double{area} / scale);
  sum_stretch(std::move(faces), measure.area * scale, uv_area, measure);
  return measure;
}

TexelOwners count_owners(const TriangleMesh& mesh, std::span<const glm::vec2> uvs, int resolution) {
  TexelOwners result;
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

AtlasReport to_report(const TexelOwners& owners, const AtlasMeasure& measure, int resolution) {
  AtlasReport report;
  report.lowest_resolution = resolution;
  const auto covered = static_cast<double>(owners.covered);
  report.coverage = covered / (double(resolution) * resolution);
  report.overlap = covered > 0 ? static_cast<double>(owners.shared) / covered : 0;
  report.stretch_mean = measure.stretch_mean;
  report.stretch_p99 = measure.stretch_p99;
  report.texel_area_max = measure.texel_area_max;
  return report;
}

}  // namespace strata::mesh
