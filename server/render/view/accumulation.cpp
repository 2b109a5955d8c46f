#include "render/view/accumulation.h"

#include <glm/gtc/matrix_transform.hpp>

namespace strata::render {
namespace {

constexpr std::uint64_t kBytesPerPixel = 8;

// The steps of the recurrence R2: 1 / φ₂ and 1 / φ₂², where φ₂³ = φ₂ + 1.
constexpr glm::dvec2 kStep{0.7548776662466927, 0.5698402909980532};

glm::dvec2 place(int index) {
  const glm::dvec2 sum = kStep * double(index);
  return sum - glm::floor(sum);
}

}  // namespace

glm::dvec2 sample_offset(int index, int count) {
  glm::dvec2 mean{0};
  for (int i = 0; i < count; ++i) mean += place(i) / double(count);
  return place(index) - mean;
}

glm::dvec2 smooth_sample_offset(int index, int count) {
  return index == 0 ? glm::dvec2(0) : sample_offset(index - 1, count - 1);
}

Camera jittered(const Camera& camera, int width, int height, glm::dvec2 offset) {
  Camera moved = camera;
  moved.projection =
      glm::translate(glm::dmat4(1), {2 * offset.x / width, 2 * offset.y / height, 0}) *
      camera.projection;
  return moved;
}

Result<Accumulation> Accumulation::create(int width, int height, GpuMemory& memory) {
  Accumulation made;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  made.share = STRATA_TRY(memory.reserve(pixels * kBytesPerPixel, "a refined picture"));
  made.sum = STRATA_TRY(gl::Texture::create_2d(GL_RGBA16, width, height, "samples"));
  made.target = STRATA_TRY(gl::Framebuffer::create({&made.sum}, nullptr, "samples"));
  glClearTexImage(made.sum.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  return made;
}

Result<AccumulationPass> AccumulationPass::create(const std::filesystem::path& shader_dir) {
  AccumulationPass pass;
  pass.program_ =
      STRATA_TRY(gl::Program::load(shader_dir, {"picture.vert", "accumulate_pass.frag"}, {}));
  return pass;
}

void AccumulationPass::add(const gl::Texture& picture, Accumulation& to, int count) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.target.id());
  glViewport(0, 0, picture.width(), picture.height());
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  const float share = 1.0f / static_cast<float>(count);
  glBlendColor(share, share, share, share);
  glBlendFunc(GL_CONSTANT_COLOR, GL_ONE);
  glEnable(GL_BLEND);
  picture.bind(0);
  program_.use();
  no_vertices_.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

}  // namespace strata::render
