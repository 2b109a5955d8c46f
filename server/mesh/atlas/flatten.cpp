#include "mesh/atlas/flatten.h"

#include <algorithm>
#include <cmath>

#include "mesh/atlas/relax.h"
#include "mesh/parallel.h"
#include "mesh/surface/face_neighbours.h"

namespace strata::mesh {
namespace {

// faces with less than this share of their true area are repaired
constexpr float kBadArea = 0.4f;
constexpr float kGoodArea = 0.5f;  // target share after the repair
constexpr int kRings = 4;          // rings of faces around a bad face that may move
constexpr int kMaxSweeps = 40;

// Returns a negative area if the face is flipped.
float plane_area(std::span<const glm::vec2> plane, std::uint32_t face) {
  const glm::vec2* p = &plane[3 * std::size_t{face}];
  const glm::vec2 ab = p[1] - p[0], ac = p[2] - p[0];
  return (ab.x * ac.y - ab.y * ac.x) / 2;
}

class Flattener {
 public:
  Flattener(const ChartSurface& surface, std::span<const Chart> charts,
            std::vector<glm::vec2>& plane)
      : surface_(surface),
        charts_(charts),
        chart_of_face_(chart_of_faces(charts, surface.mesh.triangle_count())),
        ring_of_face_(surface.mesh.triangle_count(), kRings + 1),
        plane_(plane) {}

  void flatten(std::uint32_t chart);

 private:
  float area_of(std::uint32_t face) const { return plane_area(plane_, face); }
  // Returns the faces of the chart within kRings of a bad face, in the order of their rings.
  std::vector<std::uint32_t> around_bad_faces(std::uint32_t chart, float plane_per_surface);
  RelaxPatch make_patch(std::span<const std::uint32_t> faces, float plane_per_surface,
                        std::vector<std::uint32_t>& vertices) const;

  const ChartSurface& surface_;
  std::span<const Chart> charts_;
  std::vector<std::uint32_t> chart_of_face_;
  std::vector<std::uint8_t> ring_of_face_;  // in the face's patch; > kRings: in no patch
  std::vector<glm::vec2>& plane_;
};

std::vector<std::uint32_t> Flattener::around_bad_faces(std::uint32_t chart,
                                                       float plane_per_surface) {
  std::vector<std::uint32_t> patch;
  for (const auto face : charts_[chart].faces) {
    if (area_of(face) >= kBadArea * plane_per_surface * surface_.original_frames.areas[face])
      continue;
    ring_of_face_[face] = 0;
    patch.push_back(face);
  }
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const std::uint8_t ring = ring_of_face_[patch[i]];
    if (ring == kRings) break;  // the list is in the order of rings
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = surface_.neighbours[3 * std::size_t{patch[i]} + k];
      if (next == kNoTriangle || chart_of_face_[next] != chart || ring_of_face_[next] <= kRings)
        continue;
      ring_of_face_[next] = static_cast<std::uint8_t>(ring + 1);
      patch.push_back(next);
    }
  }
  return patch;
}

// `vertices` receives the vertex numbers in the mesh, one for each point of the patch.
RelaxPatch Flattener::make_patch(std::span<const std::uint32_t> faces, float plane_per_surface,
                                 std::vector<std::uint32_t>& vertices) const {
  const auto& triangles = surface_.mesh.triangles;
  RelaxPatch patch;
  vertices.clear();
  for (const auto face : faces)
    vertices.insert(vertices.end(), &triangles[3 * face], &triangles[3 * face] + 3);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  patch.points.resize(vertices.size());
  patch.is_fixed.assign(vertices.size(), 0);
  patch.faces.reserve(faces.size());
  const float scale = std::sqrt(plane_per_surface);
  const auto point_of = [&](std::uint32_t vertex) {
    return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), vertex) -
                                      vertices.begin());
  };
  for (const auto face : faces) {
    RelaxPatch::Face shape;
    for (int k = 0; k < 3; ++k) {
      shape.vertex[k] = point_of(triangles[3 * face + k]);
      patch.points[shape.vertex[k]] = plane_[3 * std::size_t{face} + k];
    }
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = surface_.neighbours[3 * std::size_t{face} + k];
      if (next != kNoTriangle && chart_of_face_[next] == chart_of_face_[face] &&
          ring_of_face_[next] <= kRings)
        continue;
      patch.is_fixed[shape.vertex[k]] = patch.is_fixed[shape.vertex[(k + 1) % 3]] = 1;
    }
    const glm::vec3 ab = (surface_.mesh.corner(face, 1) - surface_.mesh.corner(face, 0)) * scale;
    const glm::vec3 ac = (surface_.mesh.corner(face, 2) - surface_.mesh.corner(face, 0)) * scale;
    const float length = glm::length(ab);
    shape.b = {length, 0};
    if (length > 0) shape.c = {glm::dot(ac, ab) / length, glm::length(glm::cross(ab, ac)) / length};
    patch.faces.push_back(shape);
  }
  return patch;
}

void Flattener::flatten(std::uint32_t number) {
  const Chart& chart = charts_[number];
  double area = 0, plane = 0;
  for (const auto face : chart.faces) {
    for (int k = 0; k < 3; ++k)
      plane_[3 * std::size_t{face} + k] = chart.project(surface_.corner(chart, face, k));
    area += surface_.original_frames.areas[face];
    plane += std::abs(area_of(face));
  }
  if (chart.faces.size() == 1 || area <= 0 || plane <= 0) return;
  const auto faces = around_bad_faces(number, static_cast<float>(plane / area));
  if (!faces.empty()) {
    std::vector<std::uint32_t> vertices;
    RelaxPatch patch = make_patch(faces, static_cast<float>(plane / area), vertices);
    relax(patch, kGoodArea, kMaxSweeps);
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (int k = 0; k < 3; ++k)
        plane_[3 * std::size_t{faces[i]} + k] = patch.points[patch.faces[i].vertex[k]];
  }
  const auto scale = static_cast<float>(std::sqrt(area / plane));
  for (const auto face : chart.faces)
    for (int k = 0; k < 3; ++k) plane_[3 * std::size_t{face} + k] *= scale;
}

}  // namespace

std::vector<std::uint32_t> chart_of_faces(std::span<const Chart> charts,
                                          std::size_t triangle_count) {
  std::vector<std::uint32_t> chart_of_face(triangle_count, 0);
  for (std::uint32_t c = 0; c < charts.size(); ++c)
    for (const auto face : charts[c].faces) chart_of_face[face] = c;
  return chart_of_face;
}

void flatten(const ChartSurface& surface, std::span<const Chart> charts, std::size_t first,
             const Progress& progress, std::vector<glm::vec2>& plane, int threads) {
  plane.resize(3 * surface.mesh.triangle_count());
  Flattener flattener(surface, charts, plane);
  parallel_for(threads, static_cast<int>(charts.size() - first), [&](int i) {
    if (!progress.cancelled())
      flattener.flatten(static_cast<std::uint32_t>(first + static_cast<std::size_t>(i)));
  });
}

std::vector<std::uint32_t> squeezed_faces(const ChartSurface& surface,
                                          std::span<const glm::vec2> plane, float most_stretch,
                                          float least_area) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t face = 0; face < surface.mesh.triangle_count(); ++face) {
    const float area = surface.original_frames.areas[face];
    if (area >= least_area && plane_area(plane, face) * most_stretch < area) faces.push_back(face);
  }
  return faces;
}

}  // namespace strata::mesh
