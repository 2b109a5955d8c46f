#include "bench/peers/paper.h"
#include "support/shader_dirs.h"

#include <array>
#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <span>

namespace strata::bench {
namespace {

constexpr int kPaddingGroup = 16;  // texels along one side of a work group of texture_padding.comp

// Sets all texels of a texture to the same number.
void fill(const gl::Texture& texture, std::uint32_t value) {
  const GLenum type = texture.format() == GL_R8UI ? GL_UNSIGNED_BYTE : GL_UNSIGNED_INT;
  glClearTexImage(texture.id(), 0, GL_RED_INTEGER, type, &value);
}

}  // namespace

Result<std::unique_ptr<PaperEditor>> PaperEditor::create(const mesh::Geometry& geometry,
                                                         int resolution) {
  auto editor = std::make_unique<PaperEditor>();
  editor->resolution_ = resolution;
  editor->origin_ = geometry.origin;
  editor->index_count_ = static_cast<GLsizei>(geometry.indices.size());
  auto vertices = gl::Buffer::create(geometry.vertices.size() * sizeof(mesh::Vertex),
                                     gl::Buffer::Use::fixed, "paper vertices");
  auto indices = gl::Buffer::create(geometry.indices.size() * sizeof(std::uint32_t),
                                    gl::Buffer::Use::fixed, "paper indices");
  if (!vertices) return tl::unexpected(vertices.error());
  if (!indices) return tl::unexpected(indices.error());
  vertices->upload_values(0, std::span(geometry.vertices));
  indices->upload_values(0, std::span(geometry.indices));
  editor->vertices_ = std::move(*vertices);
  editor->indices_ = std::move(*indices);
  const std::array<gl::VertexAttribute, 2> attributes{
      {{0, 3, GL_FLOAT, false, offsetof(mesh::Vertex, position)},
       {1, 2, GL_FLOAT, false, offsetof(mesh::Vertex, uv)}}};
  editor->mesh_array_ = gl::VertexArray(editor->vertices_, sizeof(mesh::Vertex), attributes,
                                        editor->indices_, "paper mesh");
  editor->empty_array_ = gl::VertexArray("paper texture pass");
  const struct {
    gl::Program& program;
    std::vector<std::string> files;
  } programs[] = {{editor->cover_, {"texture_space.vert", "cover.frag"}},
                  {editor->outline_pass_, {"whole_texture.vert", "outline.frag"}},
                  {editor->texture_editing_, {"texture_space.vert", "texture_editing.frag"}},
                  {editor->texture_padding_, {"whole_texture.vert", "texture_padding.frag"}},
                  {editor->compute_padding_, {"texture_padding.comp"}}};
  for (const auto& [program, files] : programs) {
    auto loaded = gl::Program::load(test::peer_shader_dir(), files);
    if (!loaded) return tl::unexpected(loaded.error());
    program = std::move(*loaded);
  }
  if (auto made = editor->make_textures(); !made) return tl::unexpected(made.error());
  editor->make_outline();
  return editor;
}

Result<void> PaperEditor::make_textures() {
  for (auto* texture : {&data_, &mask_, &coverage_, &outline_}) {
    auto made = gl::Texture::create_2d(GL_R8UI, resolution_, resolution_, "paper texture");
    if (!made) return tl::unexpected(made.error());
    *texture = std::move(*made);
    fill(*texture, 0);
  }
  // The edited area stores edit numbers instead of flags, so it needs no clearing before each edit.
  auto edited = gl::Texture::create_2d(GL_R32UI, resolution_, resolution_, "paper edited area");
  if (!edited) return tl::unexpected(edited.error());
  edited_ = std::move(*edited);
  fill(edited_, 0);
  const auto make = [](gl::Framebuffer& target, std::initializer_list<const gl::Texture*> colors,
                       const char* label) -> Result<void> {
    auto made = gl::Framebuffer::create(colors, nullptr, label);
    if (!made) return tl::unexpected(made.error());
    target = std::move(*made);
    return {};
  };
  if (auto made = make(editing_, {&data_, &mask_, &edited_}, "paper editing"); !made) return made;
  if (auto made = make(padding_, {&data_, &mask_}, "paper padding"); !made) return made;
  if (auto made = make(coverage_target_, {&coverage_}, "paper coverage"); !made) return made;
  return make(outline_target_, {&outline_}, "paper outline");
}

void PaperEditor::make_outline() {
  cover_.use();
  draw_mesh(coverage_target_);
  outline_pass_.use();
  coverage_.bind(0);
  draw_texture(outline_target_);
}

void PaperEditor::draw_mesh(const gl::Framebuffer& target) const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  glViewport(0, 0, resolution_, resolution_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  mesh_array_.bind();
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void PaperEditor::draw_texture(const gl::Framebuffer& target) const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  glViewport(0, 0, resolution_, resolution_);
  glDisable(GL_DEPTH_TEST);
  empty_array_.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void PaperEditor::edit(const Camera& camera, const gl::Texture& depth, glm::dvec2 center,
                       double radius_px, std::uint8_t value, Padding padding) {
  const glm::mat4 clip = clip_from_model(camera, origin_);
  const glm::vec2 lower_left(center.x, camera.height - center.y);
  ++edit_number_;
  const GLuint editing = texture_editing_.id();
  const gl::Program& padder = padding == Padding::raster ? texture_padding_ : compute_padding_;
  glProgramUniformMatrix4fv(editing, 0, 1, GL_FALSE, glm::value_ptr(clip));
  glProgramUniform2f(editing, 1, static_cast<float>(camera.width),
                     static_cast<float>(camera.height));
  glProgramUniform2f(editing, 2, lower_left.x, lower_left.y);
  glProgramUniform1f(editing, 3, static_cast<float>(radius_px));
  glProgramUniform1f(editing, 4, static_cast<float>(kPaperDepthBias));
  for (const GLuint program : {editing, padder.id()}) {
    glProgramUniform1ui(program, 5, value);
    glProgramUniform1ui(program, 6, edit_number_);
  }
  texture_editing_.use();
  depth.bind(0);
  draw_mesh(editing_);
  padder.use();
  outline_.bind(0);
  edited_.bind(1);
  if (padding == Padding::raster) {
    draw_texture(padding_);
    return;
  }
  data_.bind_image(0, GL_WRITE_ONLY);
  mask_.bind_image(1, GL_WRITE_ONLY);
  const auto groups = static_cast<GLuint>(resolution_ / kPaddingGroup);
  glDispatchCompute(groups, groups, 1);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                  GL_FRAMEBUFFER_BARRIER_BIT);
}

void PaperEditor::clear() {
  fill(data_, 0);
  fill(mask_, 0);
}

std::vector<std::uint8_t> PaperEditor::read(const gl::Texture& texture) {
  std::vector<std::uint8_t> texels(texture.bytes());
  glGetTextureImage(texture.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                    static_cast<GLsizei>(texels.size()), texels.data());
  return texels;
}

}  // namespace strata::bench
