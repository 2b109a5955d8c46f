#include "render/view/depth_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace strata::render {
namespace {

constexpr std::size_t kRecent = 4;

}  // namespace

DepthKey depth_key(std::uint64_t model, const Camera& camera, int width, int height) {
  return {model,  camera.view, camera.projection, width,
          height, 0,           camera.section,    camera.hidden_parts};
}

void DepthBuffer::start(const DepthKey& new_key) {
  key = new_key;
  complete = false;
  has_grid = false;
  copy.reset();
}

Result<DepthBuffers> DepthBuffers::create(const std::filesystem::path& shader_dir,
                                          std::size_t triangles_per_slice, GpuMemory& memory,
                                          gl::ReadbackPool& readback) {
  auto pass = STRATA_TRY(MeshPass::create(MeshPass::Kind::depth, shader_dir, triangles_per_slice));
  auto grid = STRATA_TRY(DepthGridPass::create(shader_dir));
  auto gather = STRATA_TRY(gl::Program::load(shader_dir, {"depth_gather_pass.comp"}));
  auto pixels = STRATA_TRY(gl::Buffer::create(kMaxPathPoints * sizeof(glm::ivec2),
                                              gl::Buffer::Use::fixed, "depth gather pixels"));
  DepthBuffers buffers;
  buffers.memory_ = &memory;
  buffers.readback_ = &readback;
  buffers.pass_ = std::move(pass);
  buffers.grid_pass_ = std::move(grid);
  buffers.gather_program_ = std::move(gather);
  buffers.pixels_ = std::move(pixels);
  return buffers;
}

Result<std::shared_ptr<DepthBuffer>> DepthBuffers::make(const DepthKey& key) {
  auto share = memory_->reserve(
      std::uint64_t{4} * static_cast<unsigned>(key.width) * static_cast<unsigned>(key.height),
      "a depth buffer");
  if (!share) return tl::unexpected(share.error());
  auto texture =
      STRATA_TRY(gl::Texture::create_2d(GL_DEPTH_COMPONENT32F, key.width, key.height, "depth"));
  auto framebuffer = STRATA_TRY(gl::Framebuffer::create({}, &texture, "depth only"));
  auto buffer = std::make_shared<DepthBuffer>();
  buffer->share = std::move(*share);
  buffer->texture = std::move(texture);
  buffer->framebuffer = std::move(framebuffer);
  buffer->start(key);
  return buffer;
}

void DepthBuffers::offer(const std::shared_ptr<DepthBuffer>& buffer) {
  std::erase_if(offered_, [](const auto& other) { return other.expired(); });
  const bool known = std::any_of(offered_.begin(), offered_.end(),
                                 [&](const auto& o) { return o.lock() == buffer; });
  if (!known) offered_.push_back(buffer);
}

std::shared_ptr<DepthBuffer> DepthBuffers::find(const DepthKey& key) {
  for (const auto& weak : offered_) {
    if (auto buffer = weak.lock(); buffer && buffer->complete && buffer->key == key) return buffer;
  }
  const auto found =
      std::find_if(recent_.begin(), recent_.end(), [&](const auto& b) { return b->key == key; });
  if (found == recent_.end()) return nullptr;
  auto buffer = *found;
  recent_.erase(found);
  recent_.push_front(buffer);
  return buffer;
}

Result<std::shared_ptr<DepthBuffer>> DepthBuffers::start(const DepthKey& key) {
  if (recent_.size() >= kRecent) {
    auto oldest = std::move(recent_.back());
    recent_.pop_back();
    if (oldest.use_count() == 1 && oldest->key.width == key.width &&
        oldest->key.height == key.height) {
      oldest->start(key);
      return oldest;
    }
  }
  return make(key);
}

Result<bool> DepthBuffers::draw_slice(const std::shared_ptr<DepthBuffer>& buffer,
                                      const MeshBuffers& mesh, const Camera& camera,
                                      MeshProgress& progress) {
  const auto drawn = pass_.draw_slice(mesh, mesh_view(camera, mesh.geometry().origin),
                                      {buffer->framebuffer, buffer->texture}, progress);
  if (!drawn || !*drawn) return drawn;
  buffer->complete = true;
  recent_.push_front(buffer);
  return true;
}

bool DepthBuffers::evict_one() {
  if (recent_.empty()) return false;
  recent_.pop_back();
  return true;
}

void DepthBuffers::forget_model(std::uint64_t model) {
  std::erase_if(recent_, [&](const auto& buffer) { return buffer->key.model == model; });
}

void DepthBuffers::copy_to_memory(DepthBuffer& buffer, int threads) {
  const int width = buffer.key.width, height = buffer.key.height;
  std::vector<float> depth(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glGetTextureImage(buffer.texture.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                    static_cast<GLsizei>(depth.size() * sizeof(float)), depth.data());
  buffer.copy =
      std::make_shared<const DepthCopy>(make_depth_copy(std::move(depth), width, height, threads));
}

Result<void> DepthBuffers::make_grid(DepthBuffer& buffer) const {
  if (buffer.has_grid) return {};
  STRATA_TRY(grid_pass_.run(buffer.texture, buffer.grid));
  buffer.has_grid = true;
  return {};
}

Result<gl::Readback> DepthBuffers::begin_gather(const DepthBuffer& buffer,
                                                std::span<const glm::ivec2> pixels) {
  auto depths = STRATA_TRY(readback_->begin(pixels.size() * sizeof(float)));
  pixels_.upload_values(0, pixels);
  gather_program_.use();
  gather_program_.set(0, static_cast<GLuint>(pixels.size()));
  buffer.texture.bind(0);
  pixels_.bind_storage(0);
  depths.buffer().bind_storage(1);
  glDispatchCompute(static_cast<GLuint>(pixels.size() + 63) / 64, 1, 1);
  depths.submit();
  return depths;
}

std::vector<float> DepthBuffers::finish_gather(const gl::Readback& depths) {
  std::vector<float> values(depths.size() / sizeof(float));
  std::memcpy(values.data(), depths.data().data(), values.size() * sizeof(float));
  return values;
}

}  // namespace strata::render
