#include "render/depth_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/stroke.h"
#include "shared/depth_probe.h"

namespace strata::render {
namespace {

constexpr std::size_t kRecent = 4;
constexpr int kCell = static_cast<int>(shader::kDepthCell);
constexpr std::size_t kMaxPathPoints = 4096;

std::vector<float> floats_of(const gl::Readback& readback) {
  std::vector<float> values(readback.size() / sizeof(float));
  std::memcpy(values.data(), readback.data().data(), values.size() * sizeof(float));
  return values;
}

}  // namespace

void DepthBuffer::start(const DepthKey& new_key) {
  key = new_key;
  complete = false;
  std::fill(grid.begin(), grid.end(), -1.0f);
}

Result<DepthBuffers> DepthBuffers::create(const std::filesystem::path& shader_dir, std::size_t triangles_per_slice,
                                          GpuMemory& memory, gl::ReadbackPool& readback) {
  auto pass = MeshPass::create(MeshPass::Kind::depth, shader_dir, triangles_per_slice);
  if (!pass) return tl::unexpected(pass.error());
  auto grid = gl::Program::load(shader_dir, {"depth_grid_pass.comp"});
  if (!grid) return tl::unexpected(grid.error());
  auto gather = gl::Program::load(shader_dir, {"depth_gather_pass.comp"});
  if (!gather) return tl::unexpected(gather.error());
  auto pixels = gl::Buffer::create(kMaxPathPoints * sizeof(glm::ivec2), gl::Buffer::Use::fixed, "depth gather pixels");
  if (!pixels) return tl::unexpected(pixels.error());
  DepthBuffers buffers;
  buffers.memory_ = &memory;
  buffers.readback_ = &readback;
  buffers.pass_ = std::move(*pass);
  buffers.grid_program_ = std::move(*grid);
  buffers.gather_program_ = std::move(*gather);
  buffers.pixels_ = std::move(*pixels);
  return buffers;
}

Result<std::shared_ptr<DepthBuffer>> DepthBuffers::make(const DepthKey& key) {
  auto share = memory_->reserve(std::uint64_t{4} * static_cast<unsigned>(key.width) * static_cast<unsigned>(key.height),
                                "a depth buffer");
  if (!share) return tl::unexpected(share.error());
  auto texture = gl::Texture::create_2d(GL_DEPTH_COMPONENT32F, key.width, key.height, "depth");
  if (!texture) return tl::unexpected(texture.error());
  auto buffer = std::make_shared<DepthBuffer>();
  buffer->share = std::move(*share);
  buffer->texture = std::move(*texture);
  buffer->framebuffer = gl::Framebuffer({}, &buffer->texture, "depth only");
  buffer->grid_width = (key.width + kCell - 1) / kCell;
  buffer->grid_height = (key.height + kCell - 1) / kCell;
  buffer->grid.resize(static_cast<std::size_t>(buffer->grid_width) * static_cast<std::size_t>(buffer->grid_height));
  buffer->start(key);
  return buffer;
}

void DepthBuffers::offer(const std::shared_ptr<DepthBuffer>& buffer) {
  std::erase_if(offered_, [](const auto& other) { return other.expired(); });
  const bool known = std::any_of(offered_.begin(), offered_.end(), [&](const auto& o) { return o.lock() == buffer; });
  if (!known) offered_.push_back(buffer);
}

std::shared_ptr<DepthBuffer> DepthBuffers::find(const DepthKey& key) {
  for (const auto& weak : offered_) {
    if (auto buffer = weak.lock(); buffer && buffer->complete && buffer->key == key) return buffer;
  }
  const auto found = std::find_if(recent_.begin(), recent_.end(), [&](const auto& b) { return b->key == key; });
  if (found == recent_.end()) return nullptr;
  auto buffer = *found;
  recent_.erase(found);
  recent_.push_front(buffer);
  return buffer;
}

Result<std::shared_ptr<DepthBuffer>> DepthBuffers::get(const DepthKey& key, const MeshBuffers& mesh, const Camera& camera) {
  if (auto found = find(key)) return found;
  std::shared_ptr<DepthBuffer> buffer;
  if (recent_.size() >= kRecent) {
    auto oldest = std::move(recent_.back());
    recent_.pop_back();
    const bool reusable = oldest.use_count() == 1 && oldest->key.width == key.width && oldest->key.height == key.height;
    if (reusable) {
      buffer = std::move(oldest);
      buffer->start(key);
    }
  }
  if (!buffer) {
    auto made = make(key);
    if (!made) return made;
    buffer = std::move(*made);
  }
  const auto uniforms = mesh_uniforms(camera, mesh.geometry().origin);
  MeshProgress progress;
  while (!pass_.draw_slice(mesh, uniforms, buffer->framebuffer, key.width, key.height, progress)) {
  }
  buffer->complete = true;
  recent_.push_front(buffer);
  return buffer;
}

bool DepthBuffers::evict_one() {
  if (recent_.empty()) return false;
  recent_.pop_back();
  return true;
}

void DepthBuffers::forget_model(std::uint64_t model) {
  std::erase_if(recent_, [&](const auto& buffer) { return buffer->key.model == model; });
}

Result<void> DepthBuffers::fill_grid(DepthBuffer& buffer, double x0, double y0, double x1, double y1) {
  const auto cell = [](double pixel, int count) { return std::clamp(static_cast<int>(std::floor(pixel / kCell)), 0, count - 1); };
  const int first_x = cell(x0, buffer.grid_width), last_x = cell(x1, buffer.grid_width);
  const int first_y = cell(y0, buffer.grid_height), last_y = cell(y1, buffer.grid_height);
  const auto at = [&](int x, int y) -> float& {
    return buffer.grid[static_cast<std::size_t>(y) * static_cast<std::size_t>(buffer.grid_width) + static_cast<std::size_t>(x)];
  };
  bool known = true;
  for (int y = first_y; y <= last_y && known; ++y)
    for (int x = first_x; x <= last_x && known; ++x) known = at(x, y) >= 0;
  if (known) return {};

  const int width = last_x - first_x + 1, height = last_y - first_y + 1;
  auto readback = readback_->begin(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(float));
  if (!readback) return tl::unexpected(readback.error());
  grid_program_.use();
  grid_program_.set(0, first_x, first_y);
  grid_program_.set(1, width, height);
  buffer.texture.bind(0);
  readback->buffer().bind_storage(0);
  glDispatchCompute(static_cast<GLuint>(width + 7) / 8, static_cast<GLuint>(height + 7) / 8, 1);
  readback->submit();
  readback->wait();
  const auto cells = floats_of(*readback);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      at(first_x + x, first_y + y) = cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  return {};
}

Result<std::vector<float>> DepthBuffers::gather(const DepthBuffer& buffer, std::span<const glm::ivec2> pixels) {
  auto readback = readback_->begin(pixels.size() * sizeof(float));
  if (!readback) return tl::unexpected(readback.error());
  pixels_.upload_values(0, pixels);
  gather_program_.use();
  gather_program_.set(0, static_cast<GLuint>(pixels.size()));
  buffer.texture.bind(0);
  pixels_.bind_storage(0);
  readback->buffer().bind_storage(1);
  glDispatchCompute(static_cast<GLuint>(pixels.size() + 63) / 64, 1, 1);
  readback->submit();
  readback->wait();
  return floats_of(*readback);
}

}  // namespace strata::render
