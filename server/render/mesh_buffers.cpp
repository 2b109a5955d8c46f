#include "render/mesh_buffers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace strata::render {
namespace {

constexpr std::size_t kSliceBytes = std::size_t{4} << 20;  // ≈ 1 ms of copying

// A centre need not be exact: it orders drawing, no more.
constexpr std::size_t kTrianglesPerSample = 256;

std::vector<glm::vec3> cluster_centers(const mesh::Geometry& geometry) {
  std::vector<glm::vec3> centers;
  for (std::size_t first = 0; first < geometry.triangle_count(); first += MeshBuffers::kTrianglesPerCluster) {
    const std::size_t end = std::min(first + MeshBuffers::kTrianglesPerCluster, geometry.triangle_count());
    glm::vec3 sum{0};
    float samples = 0;
    for (std::size_t triangle = first; triangle < end; triangle += kTrianglesPerSample, ++samples) {
      sum += geometry.vertices[geometry.indices[3 * triangle]].position;
    }
    centers.push_back(sum / samples);
  }
  return centers;
}

constexpr std::array<gl::VertexAttribute, 4> kAttributes{{
    {0, 3, GL_FLOAT, false, offsetof(mesh::Vertex, position)},
    {1, 4, GL_INT_2_10_10_10_REV, true, offsetof(mesh::Vertex, normal)},
    {2, 2, GL_FLOAT, false, offsetof(mesh::Vertex, uv)},
    {3, 4, GL_UNSIGNED_BYTE, true, offsetof(mesh::Vertex, color)},
}};

}  // namespace

Result<std::unique_ptr<MeshBuffers>> MeshBuffers::create(std::shared_ptr<const mesh::Geometry> geometry,
                                                         GpuMemory& memory) {
  auto mesh = std::make_unique<MeshBuffers>();
  mesh->geometry_ = std::move(geometry);
  mesh->cluster_centers_ = cluster_centers(mesh->geometry());
  auto share = memory.reserve(mesh->vertex_bytes() + mesh->index_bytes(), "a model's triangles");
  if (!share) return tl::unexpected(share.error());
  mesh->share_ = std::move(*share);
  auto vertices = gl::Buffer::create(mesh->vertex_bytes(), gl::Buffer::Use::fixed, "mesh vertices");
  if (!vertices) return tl::unexpected(vertices.error());
  auto indices = gl::Buffer::create(mesh->index_bytes(), gl::Buffer::Use::fixed, "mesh indices");
  if (!indices) return tl::unexpected(indices.error());
  mesh->vertices_ = std::move(*vertices);
  mesh->indices_ = std::move(*indices);
  mesh->vertex_array_ = gl::VertexArray(mesh->vertices_, sizeof(mesh::Vertex), kAttributes, mesh->indices_, "mesh");
  return mesh;
}

std::vector<std::uint32_t> MeshBuffers::clusters_from(const glm::vec4& eye) const {
  std::vector<std::pair<float, std::uint32_t>> by_distance;
  by_distance.reserve(cluster_centers_.size());
  for (const glm::vec3& center : cluster_centers_) {
    const glm::vec3 to_eye = glm::vec3(eye) - center * eye.w;
    const float distance = eye.w > 0 ? glm::dot(to_eye, to_eye) : -glm::dot(center, to_eye);
    by_distance.emplace_back(distance, static_cast<std::uint32_t>(by_distance.size()));
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::uint32_t> clusters;
  clusters.reserve(by_distance.size());
  for (const auto& [distance, cluster] : by_distance) clusters.push_back(cluster);
  return clusters;
}

bool MeshBuffers::upload_slice() {
  const bool in_vertices = uploaded_ < vertex_bytes();
  const auto source =
      in_vertices ? std::as_bytes(std::span(geometry_->vertices)) : std::as_bytes(std::span(geometry_->indices));
  const std::size_t offset = in_vertices ? uploaded_ : uploaded_ - vertex_bytes();
  const std::size_t count = std::min(kSliceBytes, source.size() - offset);
  (in_vertices ? vertices_ : indices_).upload(offset, source.subspan(offset, count));
  uploaded_ += count;
  return complete();
}

}  // namespace strata::render
