#include "render/view/feature_pass.h"

namespace strata::render {

Result<FeaturePass> FeaturePass::create(const std::filesystem::path& shader_dir) {
  FeaturePass pass;
  auto program =
      STRATA_TRY(gl::Program::load(shader_dir, {"feature_pass.vert", "feature_pass.frag"}, {}));
  pass.program_ = std::move(program);
  for (auto [phase, made] :
       {std::pair{"CLOSE_GAPS 0", &pass.sight_}, {"CLOSE_GAPS 1", &pass.gaps_}}) {
    auto built = STRATA_TRY(gl::Program::load(shader_dir, {"feature_sight_pass.comp"}, {phase}));
    *made = std::move(built);
  }
  return pass;
}

Result<void> FeaturePass::test_sight(std::span<const shader::FeatureSegment> segments,
                                     const gl::Texture& depth, bool cut_open,
                                     FeatureBuffer& features) const {
  features.count = 0;
  if (segments.empty()) return {};
  STRATA_TRY(features.segments.replace(segments));
  features.count = segments.size();
  features.segments.bind_storage(0);
  depth.bind(0);
  for (const gl::Program* phase : {&sight_, &gaps_}) {
    phase->use();
    phase->set(0, static_cast<GLuint>(segments.size()));
    if (phase == &sight_) phase->set(1, cut_open ? shader::kFeatureCutOpen : 0u);
    glDispatchCompute(static_cast<GLuint>((segments.size() + 63) / 64), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  return {};
}

Result<void> FeaturePass::draw(const FeatureBuffer& features, const gl::Framebuffer& target,
                               int width, int height, const PixelRect& rect) {
  if (features.count == 0 || rect.width == 0 || rect.height == 0) return {};
  features.segments.bind_storage(0);
  program_.use();
  no_vertices_.bind();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  glViewport(0, 0, width, height);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  // The frame stays opaque.
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.x, height - rect.y - rect.height, rect.width, rect.height);
  Result<void> sent;
  for (const float part : {0.0f, 1.0f}) {
    const shader::FeatureUniforms uniforms{glm::vec4(width, height, part, 0)};
    sent = uniforms_.replace(std::span(&uniforms, 1));
    if (!sent) break;
    uniforms_.bind_uniform(0);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * features.count));
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  return sent;
}

}  // namespace strata::render
