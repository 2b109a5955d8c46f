#include "room/caches/surface_image_cache.h"

#include <algorithm>
#include <boost/asio/post.hpp>

#include "core/log.h"
#include "core/no_such.h"
#include "core/text/slug.h"
#include "media/picture.h"
#include "room/caches/await.h"
#include "store/content/surface_images.h"

namespace strata::room {
namespace {

constexpr int kMaxSide = 16384, kMinSide = 512;  // texels per side on the GPU
constexpr int kMaxDivided = 8;  // libjpeg-turbo can divide the sides by at most this number

}  // namespace

std::vector<SurfaceImageView> surface_images_shown(const std::vector<SurfaceImage>& by_order) {
  std::vector<SurfaceImageView> shown;
  for (const SurfaceImage& image : by_order)
    if (image.visible) shown.push_back({image.id, image.opacity});
  const std::size_t hidden = shown.size() - std::min(shown.size(), render::kMaxSurfaceImagesShown);
  shown.erase(shown.begin(), shown.begin() + static_cast<std::ptrdiff_t>(hidden));
  return shown;
}

SurfaceImageCache::SurfaceImageCache(store::Store& store, render::Renderer& renderer,
                                     boost::asio::thread_pool& workers, MemoryLedger& memory,
                                     std::function<void()> ready)
    : store_(store),
      renderer_(renderer),
      workers_(workers),
      memory_(memory),
      ready_(std::move(ready)) {}

void SurfaceImageCache::put(const SurfaceImage& image) {
  std::lock_guard lock(mutex_);
  slots_[image.id].image = image;
}

void SurfaceImageCache::drop(SurfaceImageId id) {
  Slot gone;
  {
    std::lock_guard lock(mutex_);
    const auto found = slots_.find(id);
    if (found == slots_.end()) return;
    gone = std::move(found->second);
    slots_.erase(found);
  }
  if (gone.handle) renderer_.remove_surface_image(gone.handle);
  for (const Loaded& loaded : gone.waiting)
    loaded(fail(ErrorCode::not_found, "Surface image not found", "The surface image was deleted."));
}

std::vector<SurfaceImage> SurfaceImageCache::all() const {
  std::lock_guard lock(mutex_);
  return by_order();
}

std::vector<SurfaceImage> SurfaceImageCache::by_order() const {
  std::vector<SurfaceImage> images;
  for (const auto& [id, slot] : slots_) images.push_back(slot.image);
  std::stable_sort(images.begin(), images.end(),
                   [](const SurfaceImage& a, const SurfaceImage& b) { return a.order < b.order; });
  return images;
}

std::optional<SurfaceImage> SurfaceImageCache::find(const std::string& ref) const {
  std::lock_guard lock(mutex_);
  for (const auto& [id, slot] : slots_)
    if (is_all_digits(ref) ? to_string(id) == ref : slot.image.slug == ref) return slot.image;
  return std::nullopt;
}

void SurfaceImageCache::set_model(render::ModelHandle model) {
  std::lock_guard lock(mutex_);
  model_ = model;
  for (auto& [id, slot] : slots_) slot.handle = 0;
}

void SurfaceImageCache::stop() {
  std::lock_guard lock(mutex_);
  stopped_ = true;
  for (auto& [id, slot] : slots_) slot.memory.reset();
}

std::vector<SurfaceImageView> SurfaceImageCache::shown(
    const std::optional<std::vector<SurfaceImageView>>& requested) const {
  return requested ? *requested : surface_images_shown(by_order());
}

std::vector<render::SurfaceImageStyle> SurfaceImageCache::styles(
    const std::optional<std::vector<SurfaceImageView>>& requested) {
  std::vector<render::SurfaceImageStyle> styles;
  std::vector<SurfaceImageId> missing;
  {
    std::lock_guard lock(mutex_);
    for (const SurfaceImageView& view : shown(requested)) {
      const auto slot = slots_.find(view.surface_image_id);
      if (slot == slots_.end()) continue;
      if (slot->second.handle)
        styles.push_back({slot->second.handle, static_cast<float>(view.opacity)});
      else
        missing.push_back(view.surface_image_id);
    }
  }
  for (const SurfaceImageId id : missing) request(id, {});
  return styles;
}

Result<std::vector<render::SurfaceImageStyle>> SurfaceImageCache::wait(
    const std::optional<std::vector<SurfaceImageView>>& requested) {
  std::vector<SurfaceImageView> views;
  {
    std::lock_guard lock(mutex_);
    views = shown(requested);
  }
  std::vector<render::SurfaceImageStyle> styles;
  for (const SurfaceImageView& view : views) {
    auto handle = await<render::SurfaceImageHandle>(
        [&](auto done) { request(view.surface_image_id, std::move(done)); });
    if (!handle) return tl::unexpected(handle.error());
    styles.push_back({*handle, static_cast<float>(view.opacity)});
  }
  return styles;
}

void SurfaceImageCache::request(SurfaceImageId id, const Loaded& loaded) {
  std::optional<Result<render::SurfaceImageHandle>> known;
  {
    std::lock_guard lock(mutex_);
    const auto found = slots_.find(id);
    if (stopped_ || found == slots_.end()) {
      known = no_such("look", to_string(id), "looks");
    } else if (Slot& slot = found->second; slot.handle) {
      known = slot.handle;
    } else if (slot.damage) {
      known = tl::unexpected(*slot.damage);
    } else {
      if (loaded) slot.waiting.push_back(loaded);
      if (std::exchange(slot.loading, true)) return;
    }
  }
  if (known) {
    if (loaded) loaded(*known);
    return;
  }
  const int gpu_side = renderer_.info().max_texture_size;
  load(id, gpu_side > 0 ? std::min(kMaxSide, gpu_side) : kMaxSide);
}

void SurfaceImageCache::load(SurfaceImageId id, int largest_side) {
  boost::asio::post(workers_, [self = shared_from_this(), id, largest_side] {
    self->add(id, largest_side, self->read(id, largest_side));
  });
}

Result<SurfaceImageCache::Bytes> SurfaceImageCache::encoded_bytes(SurfaceImageId id) {
  {
    std::lock_guard lock(mutex_);
    if (const auto found = slots_.find(id); found != slots_.end() && found->second.encoded)
      return found->second.encoded;
  }
  auto bytes = STRATA_TRY(store_.surface_images().picture(id));
  auto encoded = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  std::lock_guard lock(mutex_);
  if (const auto found = slots_.find(id); found != slots_.end()) found->second.encoded = encoded;
  return encoded;
}

Result<int> SurfaceImageCache::reserve_pixels(SurfaceImageId id, const PictureInfo& info) {
  for (int divisor = 1;; divisor *= 2) {
    // Four bytes per pixel, plus one third for the coarser levels.
    const auto pixels = static_cast<std::uint64_t>(info.width / divisor + 1) *
                        static_cast<std::uint64_t>(info.height / divisor + 1);
    auto share = memory_.reserve(pixels * 16 / 3, "a model's picture");
    if (share) {
      std::lock_guard lock(mutex_);
      const auto found = slots_.find(id);
      if (found != slots_.end() && !stopped_) found->second.memory = std::move(*share);
      return divisor;
    }
    if (info.format != PictureFormat::jpeg || divisor == kMaxDivided)
      return tl::unexpected(share.error());
  }
}

Result<HeldPicture> SurfaceImageCache::picture(SurfaceImageId id, int side) {
  const auto bytes = STRATA_TRY(encoded_bytes(id));
  const auto info = STRATA_TRY(inspect_picture(*bytes));
  auto memory =
      STRATA_TRY(memory_.reserve(std::uint64_t{8} * static_cast<std::uint64_t>(info.width) *
                                     static_cast<std::uint64_t>(info.height),
                                 "a model's picture"));
  auto picture = STRATA_TRY(decode_coarse(*bytes, side));
  return HeldPicture{std::move(picture), std::move(memory)};
}

Result<std::shared_ptr<const render::MipmappedPicture>> SurfaceImageCache::read(SurfaceImageId id,
                                                                                int largest_side) {
  const auto bytes = STRATA_TRY(encoded_bytes(id));
  const std::vector<std::uint8_t>& encoded = *bytes;
  const auto info = STRATA_TRY(inspect_picture(encoded));
  const auto divisor = STRATA_TRY(reserve_pixels(id, info));
  auto picture = STRATA_TRY(
      divisor == 1 ? decode_picture(encoded)
                   : decode_coarse(encoded, std::max(info.width, info.height) / divisor));
  return std::make_shared<const render::MipmappedPicture>(
      render::make_mipmaps(std::move(picture.rgba), picture.width, picture.height, largest_side));
}

void SurfaceImageCache::add(SurfaceImageId id, int largest_side,
                            const Result<std::shared_ptr<const render::MipmappedPicture>>& image) {
  if (!image) return finish(id, tl::unexpected(image.error()));
  render::ModelHandle model;
  {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    model = model_;
  }
  renderer_.add_surface_image(model, *image,
                              [self = shared_from_this(), id, model,
                               largest_side](const Result<render::SurfaceImageHandle>& handle) {
                                self->on_added(id, model, largest_side, handle);
                              });
}

void SurfaceImageCache::on_added(SurfaceImageId id, render::ModelHandle model, int largest_side,
                                 const Result<render::SurfaceImageHandle>& handle) {
  {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    // The texture was made for a lost context.
    if (model != model_ && slots_.contains(id)) return load(id, largest_side);
  }
  if (!handle && handle.error().code == ErrorCode::out_of_memory && largest_side > kMinSide)
    return load(id, largest_side / 2);
  finish(id, handle);
}

void SurfaceImageCache::finish(SurfaceImageId id,
                               const Result<render::SurfaceImageHandle>& handle) {
  std::vector<Loaded> waiting;
  bool is_stored = false;
  {
    std::lock_guard lock(mutex_);
    if (const auto found = slots_.find(id); found != slots_.end()) {
      Slot& slot = found->second;
      slot.loading = false;
      slot.memory.reset();
      waiting = std::exchange(slot.waiting, {});
      if (handle)
        slot.handle = *handle, is_stored = true;
      else if (!is_server_failure(handle.error().code))
        slot.damage = handle.error();
    }
  }
  if (handle && !is_stored) renderer_.remove_surface_image(*handle);  // the image was deleted
  if (!handle) log::warning("look " + to_string(id) + " cannot be shown: " + handle.error().detail);
  for (const Loaded& loaded : waiting) loaded(handle);
  if (is_stored && ready_) ready_();
}

}  // namespace strata::room
