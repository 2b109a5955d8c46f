#include "render/view/mark_pass.h"

namespace strata::render {

Result<MarkPass> MarkPass::create(const std::filesystem::path& shader_dir) {
  MarkPass pass;
  auto program =
      STRATA_TRY(gl::Program::load(shader_dir, {"mark_pass.vert", "mark_pass.frag"}, {}));
  pass.program_ = std::move(program);
  for (auto [phase, made] :
       {std::pair{"CLOSE_GAPS 0", &pass.sight_}, {"CLOSE_GAPS 1", &pass.gaps_}}) {
    auto built = STRATA_TRY(gl::Program::load(shader_dir, {"mark_sight_pass.comp"}, {phase}));
    *made = std::move(built);
  }
  return pass;
}

Result<void> MarkPass::look(std::span<const shader::MarkSegment> segments, const gl::Texture& depth,
                            bool cut_open, MarkBuffer& marks) const {
  marks.count = 0;
  if (segments.empty()) return {};
  STRATA_TRY(marks.segments.replace(segments));
  marks.count = segments.size();
  marks.segments.bind_storage(0);
  depth.bind(0);
  for (const gl::Program* phase : {&sight_, &gaps_}) {
    phase->use();
    phase->set(0, static_cast<GLuint>(segments.size()));
    if (phase == &sight_) phase->set(1, cut_open ? shader::kMarkCutOpen : 0u);
    glDispatchCompute(static_cast<GLuint>((segments.size() + 63) / 64), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  return {};
}

Result<void> MarkPass::draw(const MarkBuffer& marks, const gl::Framebuffer& target, int width,
                            int height, const PixelRect& rect) {
  if (marks.count == 0 || rect.width == 0 || rect.height == 0) return {};
  marks.segments.bind_storage(0);
  program_.use();
  no_vertices_.bind();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  glViewport(0, 0, width, height);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  // the picture stays opaque
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.x, height - rect.y - rect.height, rect.width, rect.height);
  Result<void> sent;
  for (const float part : {0.0f, 1.0f}) {
    const shader::MarkUniforms uniforms{glm::vec4(width, height, part, 0)};
    sent = uniforms_.replace(std::span(&uniforms, 1));
    if (!sent) break;
    uniforms_.bind_uniform(0);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * marks.count));
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  return sent;
}

}  // namespace strata::render
