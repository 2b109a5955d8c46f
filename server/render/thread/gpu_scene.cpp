#include "render/thread/gpu_scene.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <utility>

namespace strata::render {
namespace {

// A slice of a long drawing takes 1 to 2 ms. llvmpipe needs 27 to 59 ns per triangle, and draws a
// slice while the next one is prepared.
constexpr std::size_t kTrianglesPerSliceSoftware = 32 * 1024;
constexpr std::size_t kTrianglesPerSliceHardware = 2 * 1024 * 1024;
constexpr int kLowestResolution = kTileSize, kMaxResolution = 16384;
// Partial frames of views without buffers. One is drawn while another is read back.
constexpr std::size_t kMaxSharedBuffers = 2;
// A user who pauses for so long between strokes still acts.
constexpr std::chrono::seconds kActedLately{60};
constexpr std::uint64_t kShareOfViews = 4, kLeastViews = 8;
constexpr std::uint64_t kDefaultBudget = std::uint64_t{4} << 30;

std::string text(GLenum name) {
  const auto* value = reinterpret_cast<const char*>(glGetString(name));
  return value ? value : "";
}

int integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

GpuInfo read_info() {
  GpuInfo info{text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION)};
  for (const char* name : {"llvmpipe", "softpipe", "SWR"}) {
    info.software = info.software || info.renderer.find(name) != std::string::npos;
  }
  info.max_texture_size = integer(GL_MAX_TEXTURE_SIZE);
  info.max_array_layers = integer(GL_MAX_ARRAY_TEXTURE_LAYERS);
  info.max_texture_units = integer(GL_MAX_TEXTURE_IMAGE_UNITS);
  info.max_image_units = integer(GL_MAX_IMAGE_UNITS);
  return info;
}

// Returns 70 % of the dedicated memory if the driver reports it.
std::uint64_t default_budget() {
  if (epoxy_has_gl_extension("GL_NVX_gpu_memory_info")) {
    const int total_kib = integer(GL_GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX);
    if (total_kib > 0) return static_cast<std::uint64_t>(total_kib) * 1024 * 7 / 10;
  }
  return kDefaultBudget;
}

template <class Pass>
Result<void> keep(std::optional<Pass>& place, Result<Pass> pass) {
  if (!pass) return tl::unexpected(pass.error());
  place.emplace(std::move(*pass));
  return {};
}

}  // namespace

GpuScene::GpuScene(const RendererOptions& options, std::uint64_t generation, GpuMemory& memory)
    : options_(options),
      generation_(generation),
      memory_(memory),
      pool_1_(1, memory),
      pool_2_(2, memory),
      pool_4_(4, memory),
      tables_(memory) {}

GpuScene::~GpuScene() { memory_.set_evictor(nullptr); }

Result<std::unique_ptr<GpuScene>> GpuScene::create(const RendererOptions& options,
                                                   std::uint64_t generation, GpuMemory& memory,
                                                   gl::DebugMessages& messages) {
  auto context = STRATA_TRY(gl::EglContext::create({options.debug}));
  std::unique_ptr<GpuScene> scene(new GpuScene(options, generation, memory));
  scene->context_ = std::move(context);
  if (options.debug) messages.install();
  STRATA_TRY(scene->load());
  return scene;
}

Result<void> GpuScene::load() {
  info_ = read_info();
  info_.edit_path = options_.edit_path != EditPath::automatic ? options_.edit_path
                    : info_.software                          ? EditPath::kernel
                                                              : EditPath::compute;
  memory_.set_budget(options_.gpu_memory_bytes > 0 ? options_.gpu_memory_bytes : default_budget());
  memory_.set_evictor([this] { return evict_one(); });
  for (PagePool* pool : {&pool_1_, &pool_2_, &pool_4_})
    pool->set_evictor([this, pool] { return let_a_layer_leave(pool); });
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glDisable(GL_DITHER);
  const auto slice = info_.software ? kTrianglesPerSliceSoftware : kTrianglesPerSliceHardware;
  const std::string& dir = options_.shader_dir;
  detail_budget_ = DetailBudget(info_.software);
  STRATA_TRY(keep(depths_, DepthBuffers::create(dir, slice, memory_, readback_)));
  STRATA_TRY(keep(edit_culler_, EditCuller::create(dir, readback_)));
  STRATA_TRY(keep(edit_pass_, EditPass::create(dir, readback_)));
  STRATA_TRY(keep(tile_reader_, TileReader::create(dir, readback_)));
  STRATA_TRY(keep(gbuffer_pass_, MeshPass::create(MeshPass::Kind::gbuffer, dir, slice)));
  STRATA_TRY(keep(contact_shadow_pass_, ContactShadowPass::create(dir)));
  STRATA_TRY(keep(feature_pass_, FeaturePass::create(dir)));
  STRATA_TRY(keep(accumulation_pass_, AccumulationPass::create(dir)));
  return keep(shade_pass_, ShadePass::create(dir, info_.software));
}

// Evicts the first of these that exists: pages that no layer uses; depth buffers of cameras that no
// view has; shared buffers; the least recently used layer; the buffers of the least recently used
// view.
bool GpuScene::evict_one() {
  for (PagePool* pool : {&pool_1_, &pool_2_, &pool_4_}) {
    if (pool->drop_empty_chunk()) return true;
  }
  if (depths_ && depths_->evict_one()) return true;
  if (!shared_buffers_.empty()) {
    shared_buffers_.pop_back();
    return true;
  }
  if (let_a_layer_leave()) return true;
  View* const oldest = least_recent_view();
  if (!oldest) return false;
  oldest->drop_buffers();
  return true;
}

std::unique_ptr<View> GpuScene::take_shared_buffers(int width, int height) {
  const auto same =
      std::ranges::find_if(shared_buffers_, [&](const std::unique_ptr<View>& buffers) {
        return buffers->key.width == width && buffers->key.height == height;
      });
  if (same == shared_buffers_.end()) return std::make_unique<View>();
  auto taken = std::move(*same);
  shared_buffers_.erase(same);
  return taken;
}

void GpuScene::return_shared_buffers(std::unique_ptr<View> buffers) {
  if (!buffers->has_buffers()) return;
  shared_buffers_.insert(shared_buffers_.begin(), std::move(buffers));
  if (shared_buffers_.size() > kMaxSharedBuffers) shared_buffers_.pop_back();
}

void GpuScene::limit_buffers(const View& of, int width, int height) {
  const auto bytes_of = [](const View& view) {
    return View::bytes_of_buffers(view.key.width, view.key.height);
  };
  const std::uint64_t bytes = View::bytes_of_buffers(width, height);
  const std::uint64_t limit = std::max(memory_.budget() / kShareOfViews, kLeastViews * bytes);
  std::uint64_t used = bytes;
  for (const auto& [handle, view] : views_)
    if (view.has_buffers() && &view != &of) used += bytes_of(view);
  while (used > limit) {
    View* const oldest = least_recent_view(&of);
    if (!oldest) return;
    used -= bytes_of(*oldest);
    oldest->drop_buffers();
  }
}

// Returns the least recently used view with buffers that can be freed, except `besides`, or null.
// Views of onlookers come first: they need buffers less than users who turn the model or paint.
View* GpuScene::least_recent_view(const View* besides) {
  const auto since = std::chrono::steady_clock::now() - kActedLately;
  const auto rank = [&](const View& view) {
    return std::pair(view.acted && *view.acted > since, view.last_used);
  };
  View* oldest = nullptr;
  for (auto& [handle, view] : views_)
    if (view.has_buffers() && !view.drawing && &view != besides &&
        (!oldest || rank(view) < rank(*oldest)))
      oldest = &view;
  return oldest;
}

bool GpuScene::let_a_layer_leave(const PagePool* pool) {
  GpuLayer* oldest = nullptr;
  for (auto& [handle, layer] : layers_) {
    if (!layer.can_leave() || (pool && &layer.textures().pool() != pool)) continue;
    if (!oldest || layer.last_used() < oldest->last_used()) oldest = &layer;
  }
  if (!oldest) return false;
  oldest->leave();
  return true;
}

Error GpuScene::unknown(const char* what, std::uint64_t handle) const {
  const bool old = handle != 0 && handle >> 40 != generation_;
  return {ErrorCode::not_found, std::string("Unknown ") + what,
          old ? std::string("The handle belongs to a GPU context that was lost. Add the ") + what +
                    " again."
              : std::string("The GPU has no such ") + what + ". It may have been removed.",
          what};
}

ModelHandle GpuScene::add(Model model) {
  const ModelHandle handle = next_handle();
  models_.emplace(handle, std::move(model));
  return handle;
}

SurfaceImageHandle GpuScene::add(SurfaceImage image) {
  const SurfaceImageHandle handle = next_handle();
  images_.emplace(handle, std::move(image));
  return handle;
}

Result<LayerHandle> GpuScene::add_layer(
    ModelHandle model_handle, ValueType type, int resolution,
    // NOLINTNEXTLINE(performance-unnecessary-value-param): moved
    std::shared_ptr<const TileMirror> mirror) {
  STRATA_TRY(model(model_handle));
  if (resolution < kLowestResolution || resolution > kMaxResolution ||
      !std::has_single_bit(static_cast<unsigned>(resolution))) {
    return fail(ErrorCode::invalid, "Resolution out of range",
                "The resolution of a layer must be a power of two from 128 to 16384.",
                "resolution");
  }
  const int bytes = strata::bytes_per_texel(type);
  auto textures = STRATA_TRY(LayerTextures::create(type, resolution, tables_,
                                                   bytes == 1   ? pool_1_
                                                   : bytes == 2 ? pool_2_
                                                                : pool_4_));
  const LayerHandle handle = next_handle();
  layers_.try_emplace(handle, model_handle, std::move(textures), std::move(mirror));
  return handle;
}

Result<ViewHandle> GpuScene::add_view(ModelHandle model_handle) {
  STRATA_TRY(model(model_handle));
  const ViewHandle handle = next_handle();
  views_[handle].model = model_handle;
  return handle;
}

Result<GpuScene::Model*> GpuScene::model(ModelHandle handle) {
  const auto found = models_.find(handle);
  if (found == models_.end()) return tl::unexpected(unknown("model", handle));
  return &found->second;
}

Result<GpuLayer*> GpuScene::layer(LayerHandle handle) {
  const auto found = layers_.find(handle);
  if (found == layers_.end()) return tl::unexpected(unknown("layer", handle));
  return &found->second;
}

Result<View*> GpuScene::view(ViewHandle handle) {
  const auto found = views_.find(handle);
  if (found == views_.end()) return tl::unexpected(unknown("view", handle));
  return &found->second;
}

Result<GpuScene::SurfaceImage*> GpuScene::image(SurfaceImageHandle handle) {
  const auto found = images_.find(handle);
  if (found == images_.end()) return tl::unexpected(unknown("look", handle));
  return &found->second;
}

void GpuScene::remove_model(ModelHandle handle) {
  std::erase_if(images_, [&](const auto& entry) { return entry.second.model == handle; });
  std::erase_if(layers_, [&](const auto& entry) { return entry.second.model() == handle; });
  std::erase_if(views_, [&](const auto& entry) { return entry.second.model == handle; });
  if (depths_) depths_->forget_model(handle);
  models_.erase(handle);
}

}  // namespace strata::render
