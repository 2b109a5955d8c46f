#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gl/buffer.h"
#include "gl/vertex_array.h"
#include "mesh/surface/geometry.h"
#include "render/memory/gpu_memory.h"

namespace strata::render {

// A model's vertices and indices on the GPU, uploaded in slices.
class MeshBuffers {
 public:
  static Result<std::unique_ptr<MeshBuffers>> create(std::shared_ptr<const mesh::Geometry> geometry,
                                                     GpuMemory& memory);

  // Uploads the next few megabytes. Returns true when the upload is complete.
  bool upload_slice();
  bool complete() const { return uploaded_ == vertex_bytes() + index_bytes(); }

  const mesh::Geometry& geometry() const { return *geometry_; }
  const gl::VertexArray& vertex_array() const { return vertex_array_; }
  // The boxes of the geometry's clusters, 6 floats each.
  const gl::Buffer& cluster_boxes() const { return cluster_boxes_; }
  std::size_t triangle_count() const { return geometry_->triangle_count(); }

  // Returns the number of triangles in the clusters that intersect the window. Counts whole
  // clusters.
  std::size_t visible_triangles(const glm::mat4& clip_from_model) const;
  // Returns the length in pixels of the short sides of the model's triangles, in a window of
  // `height` pixels. Measured at the point of the model that is nearest to the eye. Infinite if the
  // model extends behind the eye.
  float triangle_pixels(const glm::mat4& clip_from_model, int height) const;
  // Returns the numbers of the clusters that intersect the window, the nearest to `eye` first. In
  // model space, `eye` is a point if its w is 1, or a direction towards the eye if its w is 0.
  std::vector<std::uint32_t> visible_clusters(const glm::mat4& clip_from_model,
                                              const glm::vec4& eye) const;

 private:
  std::size_t vertex_bytes() const { return geometry_->vertices.size() * sizeof(mesh::Vertex); }
  std::size_t index_bytes() const { return geometry_->indices.size() * sizeof(std::uint32_t); }

  std::shared_ptr<const mesh::Geometry> geometry_;
  float triangle_side_ = 0;  // in model space
  gl::Buffer vertices_, indices_, cluster_boxes_;
  gl::VertexArray vertex_array_;
  GpuMemory::Share share_;
  std::size_t uploaded_ = 0;
};

}  // namespace strata::render
