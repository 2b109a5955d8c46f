#include "render/mark_pass.h"

namespace strata::render {

Result<MarkPass> MarkPass::create(const std::filesystem::path& shader_dir) {
  auto program = gl::Program::load(shader_dir, {"mark_pass.vert", "mark_pass.frag"}, {});
  if (!program) return tl::unexpected(program.error());
  MarkPass pass;
  pass.program_ = std::move(*program);
  return pass;
}

Result<void> MarkPass::draw(std::span<const shader::MarkSegment> segments, const gl::Framebuffer& target, int width,
                            int height, const PixelRect& rect) {
  if (segments.empty() || rect.width == 0 || rect.height == 0) return {};
  if (auto sent = segments_.replace(segments); !sent) return sent;
  segments_.bind_storage(0);
  program_.use();
  no_vertices_.bind();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  glViewport(0, 0, width, height);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);  // the picture stays opaque
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.x, height - rect.y - rect.height, rect.width, rect.height);
  Result<void> sent;
  for (const float part : {0.0f, 1.0f}) {
    const shader::MarkUniforms uniforms{glm::vec4(width, height, part, 0)};
    sent = uniforms_.replace(std::span(&uniforms, 1));
    if (!sent) break;
    uniforms_.bind_uniform(0);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * segments.size()));
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  return sent;
}

}  // namespace strata::render
