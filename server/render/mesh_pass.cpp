#include "render/mesh_pass.h"

#include <algorithm>
#include <array>
#include <span>

namespace strata::render {

Result<MeshPass> MeshPass::create(Kind kind, const std::filesystem::path& shader_dir, std::size_t triangles_per_slice) {
  auto program = gl::Program::load(shader_dir, {"mesh.vert", kind == Kind::depth ? "depth_pass.frag" : "gbuffer_pass.frag"});
  if (!program) return tl::unexpected(program.error());
  auto uniforms = gl::Buffer::create(sizeof(shader::MeshUniforms), gl::Buffer::Use::fixed, "mesh uniforms");
  if (!uniforms) return tl::unexpected(uniforms.error());
  MeshPass pass;
  pass.kind_ = kind;
  pass.program_ = std::move(*program);
  pass.uniforms_ = std::move(*uniforms);
  pass.triangles_per_slice_ = triangles_per_slice;
  return pass;
}

bool MeshPass::draw_slice(const MeshBuffers& mesh, const shader::MeshUniforms& uniforms, const gl::Framebuffer& target,
                          int width, int height, MeshProgress& progress) const {
  if (!progress.cleared) {
    const float farthest = 1;
    glClearNamedFramebufferfv(target.id(), GL_DEPTH, 0, &farthest);
    if (kind_ == Kind::gbuffer) {
      const std::array<GLuint, 4> background{shader::kBackground, 0, 0, 0};
      const std::array<float, 4> dark{0, 0, 0, 0};
      glClearNamedFramebufferuiv(target.id(), GL_COLOR, 0, background.data());
      glClearNamedFramebufferfv(target.id(), GL_COLOR, 1, dark.data());
    }
    progress.cleared = true;
  }
  uniforms_.upload_values(0, std::span(&uniforms, 1));
  uniforms_.bind_uniform(0);
  program_.use();
  mesh.vertex_array().bind();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  glViewport(0, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  const std::size_t count = std::min(triangles_per_slice_, mesh.triangle_count() - progress.next_triangle);
  const std::size_t first_byte = progress.next_triangle * 3 * sizeof(std::uint32_t);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count * 3), GL_UNSIGNED_INT, reinterpret_cast<const void*>(first_byte));
  glFlush();  // lets the driver draw this slice while the next is prepared
  progress.next_triangle += count;
  return progress.next_triangle == mesh.triangle_count();
}

shader::MeshUniforms mesh_uniforms(const Camera& camera, const glm::dvec3& origin) {
  const glm::dmat4 world_from_view = glm::inverse(camera.view);
  const auto direction = [&](const glm::dvec3& in_view) {
    return glm::vec4(glm::normalize(glm::vec3(glm::dmat3(world_from_view) * in_view)), 0);
  };
  shader::MeshUniforms uniforms;
  uniforms.clip_from_model = clip_from_model(camera, origin);
  uniforms.eye = is_orthographic(camera) ? direction({0, 0, 1}) : glm::vec4(glm::vec3(eye_in_world(camera) - origin), 1);
  uniforms.key_light = direction({-0.45, 0.60, 0.75});
  uniforms.fill_light = direction({0.80, 0.05, 0.45});
  uniforms.up = direction({0, 1, 0.15});
  return uniforms;
}

}  // namespace strata::render
