#include "render/view/contact_shadow_pass.h"

#include <glm/gtc/matrix_transform.hpp>

#include "shared/contact_shadow.h"

namespace strata::render {
namespace {

// Returns whether the eye is above the floor. The shadow is not visible from below.
bool is_above(const mesh::ContactShadow& shadow, const Camera& camera, const glm::dvec3& origin) {
  const glm::dvec3 up(shadow.up);
  if (is_orthographic(camera))
    return glm::dot(glm::dmat3(glm::inverse(camera.view)) * glm::dvec3(0, 0, 1), up) > 0;
  return glm::dot(eye_in_world(camera) - origin - glm::dvec3(shadow.corner), up) > 0;
}

// A point of the floor is corner + x * along_row + y * along_column, so (x, y, 1) has a linear map
// to pixels. The map has an inverse if the eye is not in the floor's plane.
glm::dmat3 map_from_pixel(const mesh::ContactShadow& shadow, const glm::dmat4& clip_from_model,
                          int width, int height) {
  const auto row = [](const glm::dvec4& clip) { return glm::dvec3(clip.x, clip.y, clip.w); };
  const glm::dmat3 clip_from_map(row(clip_from_model * glm::dvec4(shadow.along_row, 0)),
                                 row(clip_from_model * glm::dvec4(shadow.along_column, 0)),
                                 row(clip_from_model * glm::dvec4(shadow.corner, 1)));
  const glm::dmat3 pixel_from_clip(width / 2.0, 0, 0, 0, height / 2.0, 0, width / 2.0, height / 2.0,
                                   1);
  return glm::inverse(pixel_from_clip * clip_from_map);
}

}  // namespace

FrameRequest::Box box_of(const mesh::ContactShadow& shadow) {
  const glm::vec3 other = shadow.corner + shadow.along_row + shadow.along_column;
  return {glm::min(shadow.corner, other), glm::max(shadow.corner, other)};
}

Result<ContactShadowPass> ContactShadowPass::create(const std::filesystem::path& shader_dir) {
  ContactShadowPass pass;
  pass.program_ =
      STRATA_TRY(gl::Program::load(shader_dir, {"picture.vert", "contact_shadow_pass.frag"}, {}));
  return pass;
}

Result<const gl::Texture*> ContactShadowPass::texture(
    const std::shared_ptr<const mesh::ContactShadow>& shadow) {
  std::erase_if(entries_, [](const Entry& entry) { return entry.shadow.expired(); });
  for (const Entry& entry : entries_)
    if (entry.shadow.lock() == shadow) return &entry.cover;
  constexpr int kSize = mesh::ContactShadow::kSize;
  auto cover = STRATA_TRY(gl::Texture::create_mipmapped(GL_R8, kSize, kSize, 1, "contact shadow"));
  glTextureSubImage2D(cover.id(), 0, 0, 0, kSize, kSize, GL_RED, GL_UNSIGNED_BYTE,
                      shadow->cover.data());
  entries_.push_back({shadow, std::move(cover)});
  return &entries_.back().cover;
}

Result<void> ContactShadowPass::draw(const std::shared_ptr<const mesh::ContactShadow>& shadow,
                                     const Camera& camera, const glm::dvec3& origin,
                                     const gl::Framebuffer& target, int width, int height,
                                     const PixelRect& rect) {
  if (rect.width == 0 || rect.height == 0 || !is_above(*shadow, camera, origin)) return {};
  const glm::dmat4 clip = camera.projection * camera.view * glm::translate(glm::dmat4(1), origin);
  const glm::dmat3 map = map_from_pixel(*shadow, clip, width, height);
  shader::ContactShadowUniforms uniforms{};
  for (glm::length_t row = 0; row < 3; ++row)
    uniforms.map_from_pixel[row] = glm::vec4(map[0][row], map[1][row], map[2][row], 0);
  const gl::Texture* cover = STRATA_TRY(texture(shadow));
  STRATA_TRY(uniforms_.replace(std::span<const shader::ContactShadowUniforms>(&uniforms, 1)));

  uniforms_.bind_uniform(0);
  cover->bind(0);
  program_.use();
  no_vertices_.bind();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  glViewport(0, 0, width, height);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_EQUAL);  // no surface: the depth is still the farthest
  glEnable(GL_DEPTH_TEST);
  glBlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_ONE);
  glEnable(GL_BLEND);
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.x, height - rect.y - rect.height, rect.width, rect.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  return {};
}

}  // namespace strata::render
