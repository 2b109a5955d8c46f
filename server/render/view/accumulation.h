#pragma once

#include <filesystem>
#include <glm/vec2.hpp>

#include "domain/scene/camera.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "render/memory/gpu_memory.h"

namespace strata::render {

// Where sample `index` of `count` looks, in pixels from the middle of a pixel. The samples cover a
// square of one pixel evenly, and their mean is the middle: the additive recurrence R2 (Roberts
// 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"), moved by its mean.
glm::dvec2 sample_offset(int index, int count);

// The same for a frame with smooth edges: the first sample is the middle of the pixel, the others
// surround it.
glm::dvec2 smooth_sample_offset(int index, int count);

// `camera`, whose picture of `width` × `height` pixels shows the scene at `offset` pixels (x to the
// right, y upwards) from where `camera` shows it.
Camera jittered(const Camera& camera, int width, int height, glm::dvec2 offset);

// The mean of several pictures of one size.
struct Accumulation {
  gl::Texture sum;  // RGBA16: the shares of the pictures so far
  gl::Framebuffer target;
  GpuMemory::Share share;

  static Result<Accumulation> create(int width, int height, GpuMemory& memory);
};

// Adds pictures to an Accumulation. Sets all state it needs, and leaves blending off.
class AccumulationPass {
 public:
  static Result<AccumulationPass> create(const std::filesystem::path& shader_dir);
  // Adds a `count`th of `picture`, which has the size of the sum.
  void add(const gl::Texture& picture, Accumulation& to, int count);

 private:
  gl::Program program_;
  gl::VertexArray no_vertices_{"accumulation"};
};

}  // namespace strata::render
