#include "render/memory/mesh_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace strata::render {
namespace {

constexpr std::size_t kSliceBytes = std::size_t{4} << 20;  // ≈ 1 ms of copying
constexpr std::size_t kTrianglesMeasured = 4096;

constexpr unsigned kCorners = 8;

glm::vec4 corner_of(const mesh::ClusterBox& box, unsigned corner) {
  return {(corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
          (corner & 4) != 0 ? box.max.z : box.min.z, 1};
}

// Returns whether all corners are outside one side of the clip volume. The slack covers the
// rounding of the vertex stage.
bool outside(const mesh::ClusterBox& box, const glm::mat4& clip_from_model) {
  constexpr float kSlack = 1e-5f;
  unsigned beyond = 0x3f;  // one bit for each side
  for (unsigned corner = 0; corner < kCorners && beyond != 0; ++corner) {
    const glm::vec4 clip = clip_from_model * corner_of(box, corner);
    for (int axis = 0; axis < 3; ++axis) {
      const float slack = kSlack * (std::abs(clip[axis]) + std::abs(clip.w));
      if (clip[axis] <= clip.w + slack) beyond &= ~(1u << (2 * axis));
      if (clip[axis] >= -clip.w - slack) beyond &= ~(2u << (2 * axis));
    }
  }
  return beyond != 0;
}

constexpr std::array<gl::VertexAttribute, 4> kAttributes{{
    {0, 3, GL_FLOAT, false, offsetof(mesh::Vertex, position)},
    {1, 4, GL_INT_2_10_10_10_REV, true, offsetof(mesh::Vertex, normal)},
    {2, 2, GL_FLOAT, false, offsetof(mesh::Vertex, uv)},
    {3, 4, GL_UNSIGNED_BYTE, true, offsetof(mesh::Vertex, color)},
}};

// Returns the mean side of some thousand triangles from the whole mesh. The mean is weighted by
// area, because a few large triangles may cover most of a view.
float side_of_triangles(const mesh::Geometry& geometry) {
  const auto corner = [&](std::size_t i) -> const glm::vec3& {
    return geometry.vertices[geometry.indices[i]].position;
  };
  const std::size_t step = 1 + geometry.triangle_count() / kTrianglesMeasured;
  double sum = 0, sum_of_squares = 0;
  for (std::size_t i = 0; i < geometry.triangle_count(); i += step) {
    const glm::vec3 a = corner(3 * i), b = corner(3 * i + 1), c = corner(3 * i + 2);
    const double area = glm::length(glm::cross(b - a, c - a)) / 2;
    sum += area;
    sum_of_squares += area * area;
  }
  return sum > 0 ? static_cast<float>(std::sqrt(2 * sum_of_squares / sum)) : 0.0f;
}

}  // namespace

Result<std::unique_ptr<MeshBuffers>> MeshBuffers::create(
    std::shared_ptr<const mesh::Geometry> geometry, GpuMemory& memory) {
  auto mesh = std::make_unique<MeshBuffers>();
  mesh->geometry_ = std::move(geometry);
  mesh->triangle_side_ = side_of_triangles(*mesh->geometry_);
  auto share = memory.reserve(mesh->vertex_bytes() + mesh->index_bytes(), "a model's triangles");
  if (!share) return tl::unexpected(share.error());
  mesh->share_ = std::move(*share);
  auto vertices = gl::Buffer::create(mesh->vertex_bytes(), gl::Buffer::Use::fixed, "mesh vertices");
  if (!vertices) return tl::unexpected(vertices.error());
  auto indices = gl::Buffer::create(mesh->index_bytes(), gl::Buffer::Use::fixed, "mesh indices");
  if (!indices) return tl::unexpected(indices.error());
  const auto boxes = std::as_bytes(std::span(mesh->geometry_->clusters));
  auto cluster_boxes =
      STRATA_TRY(gl::Buffer::create(boxes.size(), gl::Buffer::Use::fixed, "mesh clusters"));
  cluster_boxes.upload(0, boxes);
  mesh->cluster_boxes_ = std::move(cluster_boxes);
  mesh->vertices_ = std::move(*vertices);
  mesh->indices_ = std::move(*indices);
  mesh->vertex_array_ =
      gl::VertexArray(mesh->vertices_, sizeof(mesh::Vertex), kAttributes, mesh->indices_, "mesh");
  return mesh;
}

std::size_t MeshBuffers::visible_triangles(const glm::mat4& clip_from_model) const {
  const auto clusters =
      std::count_if(geometry_->clusters.begin(), geometry_->clusters.end(),
                    [&](const mesh::ClusterBox& box) { return !outside(box, clip_from_model); });
  return static_cast<std::size_t>(clusters) * mesh::Geometry::kTrianglesPerCluster;
}

float MeshBuffers::triangle_pixels(const glm::mat4& clip_from_model, int height) const {
  const mesh::ClusterBox box{geometry_->box_min, geometry_->box_max};
  float nearest = std::numeric_limits<float>::infinity();
  for (unsigned corner = 0; corner < kCorners; ++corner)
    nearest = std::min(nearest, (clip_from_model * corner_of(box, corner)).w);
  if (nearest <= 0) return std::numeric_limits<float>::infinity();
  const glm::vec3 upwards(clip_from_model[0][1], clip_from_model[1][1], clip_from_model[2][1]);
  return triangle_side_ * glm::length(upwards) / nearest * 0.5f * static_cast<float>(height);
}

std::vector<std::uint32_t> MeshBuffers::visible_clusters(const glm::mat4& clip_from_model,
                                                         const glm::vec4& eye) const {
  std::vector<std::pair<float, std::uint32_t>> by_distance;
  for (std::size_t i = 0; i < geometry_->clusters.size(); ++i) {
    const mesh::ClusterBox& box = geometry_->clusters[i];
    if (outside(box, clip_from_model)) continue;
    const glm::vec3 center = (box.min + box.max) * 0.5f;
    const glm::vec3 to_eye = glm::vec3(eye) - center * eye.w;
    const float distance = eye.w > 0 ? glm::dot(to_eye, to_eye) : -glm::dot(center, to_eye);
    by_distance.emplace_back(distance, static_cast<std::uint32_t>(i));
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::uint32_t> clusters;
  clusters.reserve(by_distance.size());
  for (const auto& [distance, cluster] : by_distance) clusters.push_back(cluster);
  return clusters;
}

bool MeshBuffers::upload_slice() {
  const bool in_vertices = uploaded_ < vertex_bytes();
  const auto source = in_vertices ? std::as_bytes(std::span(geometry_->vertices))
                                  : std::as_bytes(std::span(geometry_->indices));
  const std::size_t offset = in_vertices ? uploaded_ : uploaded_ - vertex_bytes();
  const std::size_t count = std::min(kSliceBytes, source.size() - offset);
  (in_vertices ? vertices_ : indices_).upload(offset, source.subspan(offset, count));
  uploaded_ += count;
  return complete();
}

}  // namespace strata::render
