#include "render/view/mesh_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "shared/cluster.h"

namespace strata::render {
namespace {

const char* light_define(LightMode mode) {
  switch (mode) {
    case LightMode::museum: return nullptr;
    case LightMode::headlight: return "HEADLIGHT";
    case LightMode::raking: return "RAKING_LIGHT";
    case LightMode::unlit: return "UNLIT";
  }
  return nullptr;
}

// A plane that faces the eye is middle gray at any height of the light.
constexpr double kRakingOnPlane = 0.5, kMaxRaking = 3;

// Smaller triangles are lit at their vertices. There is no visible difference, and a software
// renderer saves a thirteenth of the time.
constexpr float kPixelsLitAtVertices = 10;

// 1 / kCullAfter of the remaining clusters is drawn before the others are culled. Fewer than
// kFewClusters clusters are not culled, because drawing them is faster.
constexpr std::size_t kCullAfter = 4, kFewClusters = 256;

std::size_t next_culling(const MeshProgress& progress) {
  const std::size_t rest = progress.clusters - progress.next_cluster;
  return rest < kFewClusters ? progress.clusters : progress.next_cluster + rest / kCullAfter;
}

// Limits clears and draws to the part of the target, until the end of the scope.
class PartScope {
 public:
  explicit PartScope(const MeshTarget& target) : is_limited_(target.part.has_value()) {
    if (!is_limited_) return;
    const PixelRect& part = *target.part;
    glEnable(GL_SCISSOR_TEST);
    glScissor(part.x, target.depth.height() - part.y - part.height, part.width, part.height);
  }
  ~PartScope() {
    if (is_limited_) glDisable(GL_SCISSOR_TEST);
  }
  PartScope(const PartScope&) = delete;
  PartScope& operator=(const PartScope&) = delete;

 private:
  const bool is_limited_;
};

// Returns the transformation after which the clip volume is that of the target's part, with one
// more pixel on each side.
glm::mat4 clip_of_part(const glm::mat4& clip_from_model, const MeshTarget& target) {
  if (!target.part) return clip_from_model;
  const glm::dvec2 size(target.depth.width(), target.depth.height());
  const PixelRect& part = *target.part;
  const glm::dvec2 low(part.x - 1, size.y - part.y - part.height - 1);
  const glm::dvec2 half(part.width / 2.0 + 1, part.height / 2.0 + 1);
  const glm::dvec2 scale = size / (2.0 * half);
  const glm::dvec2 center = (low + half) / size * 2.0 - 1.0;
  glm::dmat4 crop(1);
  crop[0][0] = scale.x;
  crop[1][1] = scale.y;
  crop[3][0] = -center.x * scale.x;
  crop[3][1] = -center.y * scale.y;
  return glm::mat4(crop * glm::dmat4(clip_from_model));
}

// Adds the draws of a cluster's triangles that are in the ranges.
void add_draws(std::uint32_t cluster, std::span<const mesh::TriangleRange> ranges,
               std::vector<shader::DrawCommand>& commands) {
  constexpr std::uint32_t kTriangles = mesh::Geometry::kTrianglesPerCluster;
  const std::uint32_t first = cluster * kTriangles;
  auto range = std::ranges::upper_bound(ranges, first, {}, &mesh::TriangleRange::end);
  for (; range != ranges.end() && range->begin < first + kTriangles; ++range) {
    const std::uint32_t begin = std::max(first, range->begin),
                        end = std::min(first + kTriangles, range->end);
    commands.push_back({3 * (end - begin), 1, 3 * begin, 0, 0});
  }
}

}  // namespace

Result<MeshPass> MeshPass::create(Kind kind, const std::filesystem::path& shader_dir,
                                  std::size_t triangles_per_slice) {
  auto uniforms =
      gl::Buffer::create(sizeof(shader::MeshUniforms), gl::Buffer::Use::fixed, "mesh uniforms");
  if (!uniforms) return tl::unexpected(uniforms.error());
  auto culler = STRATA_TRY(ClusterCuller::create(shader_dir));
  MeshPass pass;
  pass.culler_ = std::move(culler);
  pass.kind_ = kind;
  pass.shader_dir_ = shader_dir;
  pass.uniforms_ = std::move(*uniforms);
  pass.clusters_per_slice_ =
      std::max<std::size_t>(1, triangles_per_slice / mesh::Geometry::kTrianglesPerCluster);
  STRATA_TRY(pass.program({}, false));
  return pass;
}

Result<const gl::Program*> MeshPass::program(const MeshView& view, bool lit_at_vertices) {
  std::vector<std::string> defines;
  if (view.is_cut) defines.emplace_back("SECTION");
  if (kind_ == Kind::gbuffer) {
    if (const char* light = light_define(view.light)) defines.emplace_back(light);
    if (lit_at_vertices) defines.emplace_back("LIT_VERTICES");
    if (view.is_exposed) defines.emplace_back("EXPOSED");
    defines.push_back("LOOKS " + std::to_string(view.images.size()));
  }
  if (const auto built = programs_.find(defines); built != programs_.end()) return &built->second;
  auto program = STRATA_TRY(gl::Program::load(
      shader_dir_, {"mesh.vert", kind_ == Kind::depth ? "depth_pass.frag" : "gbuffer_pass.frag"},
      defines));
  return &programs_.emplace(std::move(defines), std::move(program)).first->second;
}

Result<void> MeshPass::begin(const MeshBuffers& mesh, const MeshView& view,
                             const MeshTarget& target, MeshProgress& progress) {
  const GLuint framebuffer = target.framebuffer.id();
  const PartScope scope(target);
  const float farthest = 1;
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &farthest);
  if (kind_ == Kind::gbuffer) {
    const std::array<GLuint, 4> background{shader::kBackground, 0, 0, 0};
    const std::array<float, 4> dark{0, 0, 0, 0};
    glClearNamedFramebufferuiv(framebuffer, GL_COLOR, 0, background.data());
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 1, dark.data());
  }
  const auto ranges = mesh::visible_ranges(mesh.geometry(), view.hidden_parts);
  std::vector<shader::DrawCommand> commands;
  for (const auto cluster : mesh.visible_clusters(
           clip_of_part(view.uniforms.clip_from_model, target), view.uniforms.eye))
    add_draws(cluster, ranges, commands);
  progress.clusters = commands.size();
  for (const shader::DrawCommand& command : commands) progress.triangles += command.count / 3;
  progress.next_culling = next_culling(progress);
  progress.cleared = true;
  if (commands.empty()) return {};
  const auto bytes = std::as_bytes(std::span(commands));
  auto buffer =
      STRATA_TRY(gl::Buffer::create(bytes.size(), gl::Buffer::Use::fixed, "draws of clusters"));
  buffer.upload(0, bytes);
  progress.commands = std::move(buffer);
  return {};
}

Result<bool> MeshPass::draw_slice(const MeshBuffers& mesh, const MeshView& view,
                                  const MeshTarget& target, MeshProgress& progress) {
  const bool lit_at_vertices = kind_ == Kind::gbuffer && view.light == LightMode::museum &&
                               mesh.triangle_pixels(view.uniforms.clip_from_model,
                                                    target.depth.height()) <= kPixelsLitAtVertices;
  auto built = STRATA_TRY(program(view, lit_at_vertices));
  if (!progress.cleared) {
    STRATA_TRY(begin(mesh, view, target, progress));
  }
  if (progress.clusters == 0) return true;
  const std::size_t rest = progress.clusters - progress.next_cluster;
  if (progress.next_cluster == progress.next_culling) {
    STRATA_TRY(culler_.hide(target.depth, mesh, view.uniforms.clip_from_model, progress.commands,
                            progress.next_cluster, rest));
    progress.next_culling = next_culling(progress);
  }
  uniforms_.upload_values(0, std::span(&view.uniforms, 1));
  uniforms_.bind_uniform(0);
  built->use();
  for (std::size_t i = 0; i < view.images.size(); ++i) view.images[i]->bind(static_cast<GLuint>(i));
  mesh.vertex_array().bind();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer.id());
  glViewport(0, 0, target.depth.width(), target.depth.height());
  const PartScope scope(target);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glFrontFace(view.is_mirrored ? GL_CW : GL_CCW);
  for (GLuint i = 0; view.is_cut && i < shader::kSectionPlanes; ++i)
    glEnable(GL_CLIP_DISTANCE0 + i);
  const std::size_t count =
      std::min({clusters_per_slice_, progress.clusters - progress.next_cluster,
                progress.next_culling - progress.next_cluster});
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, progress.commands.id());
  glMultiDrawElementsIndirect(
      GL_TRIANGLES, GL_UNSIGNED_INT,
      // NOLINTNEXTLINE(performance-no-int-to-ptr): GL takes the offset into the buffer as a pointer
      reinterpret_cast<const void*>(progress.next_cluster * sizeof(shader::DrawCommand)),
      static_cast<GLsizei>(count), 0);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
  progress.next_cluster += count;
  for (GLuint i = 0; view.is_cut && i < shader::kSectionPlanes; ++i)
    glDisable(GL_CLIP_DISTANCE0 + i);
  glFlush();  // the driver can draw this slice during the preparation of the next one
  return progress.next_cluster == progress.clusters;
}

MeshView mesh_view(const Camera& camera, const glm::dvec3& origin, const Light& light) {
  const glm::dmat4 world_from_view = glm::inverse(camera.view);
  const auto direction = [&](const glm::dvec3& in_view) {
    return glm::vec4(glm::normalize(glm::vec3(glm::dmat3(world_from_view) * in_view)), 0);
  };
  MeshView view;
  shader::MeshUniforms& uniforms = view.uniforms;
  uniforms.clip_from_model = clip_from_model(camera, origin);
  uniforms.eye = is_orthographic(camera) ? direction({0, 0, 1})
                                         : glm::vec4(glm::vec3(eye_in_world(camera) - origin), 1);
  uniforms.key_light = direction({-0.45, 0.60, 0.75});
  if (light.mode == LightMode::raking) {
    const glm::dvec3 towards = glm::normalize(light.direction);
    uniforms.key_light = direction(towards);
    uniforms.key_light.w =
        static_cast<float>(std::min(kRakingOnPlane / std::max(towards.z, 1e-3), kMaxRaking));
  }
  view.light = light.mode;
  view.is_exposed = light.exposure_ev != 0;
  uniforms.fill_light = direction({0.80, 0.05, 0.45});
  uniforms.fill_light.w = static_cast<float>(light.fill);
  uniforms.rim_light = direction({0.35, 0.75, -0.45});
  uniforms.rim_light.w = static_cast<float>(std::exp2(light.exposure_ev / 2));
  uniforms.up = direction({0, 1, 0.15});
  std::ranges::copy(section_in_model(camera, origin), uniforms.section);
  uniforms.eye_is_cut_away = eye_is_cut_away(camera) ? 1 : 0;
  view.is_cut = !camera.section.empty();
  view.hidden_parts = camera.hidden_parts;
  // Clip space is left-handed, so for a camera without mirroring the product is negative.
  view.is_mirrored = glm::determinant(camera.projection) * glm::determinant(camera.view) > 0;
  return view;
}

}  // namespace strata::render
