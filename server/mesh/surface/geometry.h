#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/error.h"
#include "domain/scene/model_part.h"
#include "mesh/atlas/atlas.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// A vertex in the GPU layout, 32 bytes. Positions are in model space: world minus
// `Geometry::origin`, in file units.
struct Vertex {
  glm::vec3 position;
  std::uint32_t normal;  // snorm 10:10:10:2 (GL_INT_2_10_10_10_REV), unit length
  glm::vec2 uv;
  // red in the low byte; stone gray if the scan has no color; highest byte: openness
  std::uint32_t color;
  std::uint32_t position_index;  // of the welded position, shared by vertices split at seams
};
static_assert(sizeof(Vertex) == 32);

glm::vec3 normal_of(const Vertex& vertex);  // unit length

// The box of a run of triangles, in model space.
struct ClusterBox {
  glm::vec3 min{0}, max{0};
};

// An imported model. It is the immutable input for rendering, for the surface map and for the
// search tree.
struct Geometry {
  // center of the box, rounded to whole units if the box is larger than 16
  glm::dvec3 origin{0};
  std::vector<glm::dvec3> positions;   // in world coordinates, double, welded
  std::vector<Vertex> vertices;        // corners with the same position and UV share a vertex
  std::vector<std::uint32_t> indices;  // 3 per triangle, in an order that keeps neighbors together
  glm::vec3 box_min{0}, box_max{0};    // in model space
  // one for each run of kTrianglesPerCluster triangles; the last run has fewer
  std::vector<ClusterBox> clusters;
  // The end of each part's triangles, ascending (domain/scene/model_part.h). Parts share no vertex
  // and no position. Empty: the model is one part.
  std::vector<std::uint32_t> part_ends;

  static constexpr std::size_t kTrianglesPerCluster = 1024;

  std::size_t triangle_count() const { return indices.size() / 3; }
  std::size_t bytes() const;
  int part_of(std::uint32_t triangle) const;  // 0 if the model is one part
};

// A run of triangles.
struct TriangleRange {
  std::uint32_t begin = 0, end = 0;
};
// Returns the triangles of all parts except the hidden ones, as ranges that do not touch.
std::vector<TriangleRange> visible_ranges(const Geometry& geometry, const PartSet& hidden_parts);
// Returns the positions of all parts except the hidden ones.
std::vector<glm::dvec3> positions_without(const Geometry& geometry, const PartSet& hidden_parts);

// Computes the boxes from vertices and indices.
void find_boxes(Geometry& geometry);

Geometry build_geometry(const TriangleMesh& mesh, const Atlas& atlas);

double surface_area(const Geometry& geometry);  // unit²

// The stored form is versioned and compressed with zstd. Decoding checks every bound and index.
std::vector<std::uint8_t> encode_geometry(const Geometry& geometry);
Result<Geometry> decode_geometry(std::span<const std::uint8_t> bytes);

}  // namespace strata::mesh
