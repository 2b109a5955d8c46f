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

// Returns the offset of sample `index` of `count`, in pixels from the center of a pixel. The
// samples cover a square of one pixel evenly, and their mean is the center. They follow the
// additive recurrence R2 (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"),
// moved so that its mean is 0.
glm::dvec2 sample_offset(int index, int count);

// Like `sample_offset`, for a frame with smooth edges. The first sample is the center of the pixel,
// and the others surround it.
glm::dvec2 smooth_sample_offset(int index, int count);

// Returns a camera that moves the scene in a frame of `width` × `height` pixels by `offset` pixels
// (x to the right, y upwards).
Camera jittered(const Camera& camera, int width, int height, glm::dvec2 offset);

// The mean of several frames with the same size.
struct Accumulation {
  gl::Texture sum;  // RGBA16: the sum of the weighted frames so far
  gl::Framebuffer target;
  GpuMemory::Share share;

  static Result<Accumulation> create(int width, int height, GpuMemory& memory);
};

// Adds frames to an Accumulation. Sets all GL state that it needs, and disables blending at the
// end.
class AccumulationPass {
 public:
  static Result<AccumulationPass> create(const std::filesystem::path& shader_dir);
  // Adds `picture`, multiplied by 1 / `count`. It must have the size of the sum.
  void add(const gl::Texture& picture, Accumulation& to, int count);

 private:
  gl::Program program_;
  gl::VertexArray no_vertices_{"accumulation"};
};

}  // namespace strata::render
