#include "room/caches/surface_image_cache.h"

#include <algorithm>
#include <boost/asio/post.hpp>

#include "core/log.h"
#include "core/no_such.h"
#include "core/text/slug.h"
#include "media/picture.h"
#include "room/caches/await.h"
#include "store/content/looks.h"

namespace strata::room {
namespace {

constexpr int kLargestSide = 16384, kSmallestSide = 512;  // texels of a look on the GPU
constexpr int kMostDivided = 8;                           // as libjpeg-turbo divides the sides

}  // namespace

std::vector<LookView> looks_shown(const std::vector<Look>& by_order) {
  std::vector<LookView> shown;
  for (const Look& look : by_order)
    if (look.visible) shown.push_back({look.id, look.opacity});
  const std::size_t hidden = shown.size() - std::min(shown.size(), render::kMaxLooksShown);
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

void SurfaceImageCache::put(const Look& look) {
  std::lock_guard lock(mutex_);
  slots_[look.id].look = look;
}

void SurfaceImageCache::drop(std::int64_t id) {
  Slot gone;
  {
    std::lock_guard lock(mutex_);
    const auto found = slots_.find(id);
    if (found == slots_.end()) return;
    gone = std::move(found->second);
    slots_.erase(found);
  }
  if (gone.handle) renderer_.remove_look(gone.handle);
  for (const Loaded& loaded : gone.waiting)
    loaded(fail(ErrorCode::not_found, "No such look", "The look was deleted."));
}

std::vector<Look> SurfaceImageCache::all() const {
  std::lock_guard lock(mutex_);
  return by_order();
}

std::vector<Look> SurfaceImageCache::by_order() const {
  std::vector<Look> looks;
  for (const auto& [id, slot] : slots_) looks.push_back(slot.look);
  std::stable_sort(looks.begin(), looks.end(),
                   [](const Look& a, const Look& b) { return a.order < b.order; });
  return looks;
}

std::optional<Look> SurfaceImageCache::find(const std::string& ref) const {
  std::lock_guard lock(mutex_);
  for (const auto& [id, slot] : slots_)
    if (is_all_digits(ref) ? std::to_string(id) == ref : slot.look.slug == ref) return slot.look;
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

std::vector<LookView> SurfaceImageCache::shown(
    const std::optional<std::vector<LookView>>& wanted) const {
  return wanted ? *wanted : looks_shown(by_order());
}

std::vector<render::LookStyle> SurfaceImageCache::styles(
    const std::optional<std::vector<LookView>>& wanted) {
  std::vector<render::LookStyle> styles;
  std::vector<std::int64_t> missing;
  {
    std::lock_guard lock(mutex_);
    for (const LookView& view : shown(wanted)) {
      const auto slot = slots_.find(view.look_id);
      if (slot == slots_.end()) continue;
      if (slot->second.handle)
        styles.push_back({slot->second.handle, static_cast<float>(view.opacity)});
      else
        missing.push_back(view.look_id);
    }
  }
  for (const std::int64_t id : missing) request(id, {});
  return styles;
}

Result<std::vector<render::LookStyle>> SurfaceImageCache::wait(
    const std::optional<std::vector<LookView>>& wanted) {
  std::vector<LookView> views;
  {
    std::lock_guard lock(mutex_);
    views = shown(wanted);
  }
  std::vector<render::LookStyle> styles;
  for (const LookView& view : views) {
    auto handle =
        await<render::LookHandle>([&](auto done) { request(view.look_id, std::move(done)); });
    if (!handle) return tl::unexpected(handle.error());
    styles.push_back({*handle, static_cast<float>(view.opacity)});
  }
  return styles;
}

void SurfaceImageCache::request(std::int64_t id, const Loaded& loaded) {
  std::optional<Result<render::LookHandle>> known;
  {
    std::lock_guard lock(mutex_);
    const auto found = slots_.find(id);
    if (stopped_ || found == slots_.end()) {
      known = no_such("look", std::to_string(id), "looks");
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
  load(id, gpu_side > 0 ? std::min(kLargestSide, gpu_side) : kLargestSide);
}

void SurfaceImageCache::load(std::int64_t id, int largest_side) {
  boost::asio::post(workers_, [self = shared_from_this(), id, largest_side] {
    self->add(id, largest_side, self->read(id, largest_side));
  });
}

Result<SurfaceImageCache::Bytes> SurfaceImageCache::encoded_bytes(std::int64_t id) {
  {
    std::lock_guard lock(mutex_);
    if (const auto found = slots_.find(id); found != slots_.end() && found->second.encoded)
      return found->second.encoded;
  }
  auto bytes = STRATA_TRY(store_.looks().picture(id));
  auto encoded = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  std::lock_guard lock(mutex_);
  if (const auto found = slots_.find(id); found != slots_.end()) found->second.encoded = encoded;
  return encoded;
}

Result<int> SurfaceImageCache::reserve_pixels(std::int64_t id, const PictureInfo& info) {
  for (int divisor = 1;; divisor *= 2) {
    // Four bytes a pixel, and a third more for the coarser levels.
    const auto pixels = static_cast<std::uint64_t>(info.width / divisor + 1) *
                        static_cast<std::uint64_t>(info.height / divisor + 1);
    auto share = memory_.reserve(pixels * 16 / 3, "a model's picture");
    if (share) {
      std::lock_guard lock(mutex_);
      const auto found = slots_.find(id);
      if (found != slots_.end() && !stopped_) found->second.memory = std::move(*share);
      return divisor;
    }
    if (info.format != PictureFormat::jpeg || divisor == kMostDivided)
      return tl::unexpected(share.error());
  }
}

Result<std::shared_ptr<const render::LookImage>> SurfaceImageCache::read(std::int64_t id,
                                                                         int largest_side) {
  const auto bytes = STRATA_TRY(encoded_bytes(id));
  const std::vector<std::uint8_t>& encoded = *bytes;
  const auto info = STRATA_TRY(inspect_picture(encoded));
  const auto divisor = STRATA_TRY(reserve_pixels(id, info));
  auto picture = STRATA_TRY(
      divisor == 1 ? decode_picture(encoded)
                   : decode_coarse(encoded, std::max(info.width, info.height) / divisor));
  return std::make_shared<const render::LookImage>(render::make_look_image(
      std::move(picture.rgba), picture.width, picture.height, largest_side));
}

void SurfaceImageCache::add(std::int64_t id, int largest_side,
                            const Result<std::shared_ptr<const render::LookImage>>& image) {
  if (!image) return finish(id, tl::unexpected(image.error()));
  render::ModelHandle model;
  {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    model = model_;
  }
  renderer_.add_look(model, *image,
                     [self = shared_from_this(), id, model,
                      largest_side](const Result<render::LookHandle>& handle) {
                       self->on_added(id, model, largest_side, handle);
                     });
}

void SurfaceImageCache::on_added(std::int64_t id, render::ModelHandle model, int largest_side,
                                 const Result<render::LookHandle>& handle) {
  {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    // made for a context that is lost
    if (model != model_ && slots_.contains(id)) return load(id, largest_side);
  }
  if (!handle && handle.error().code == ErrorCode::out_of_memory && largest_side > kSmallestSide)
    return load(id, largest_side / 2);
  finish(id, handle);
}

void SurfaceImageCache::finish(std::int64_t id, const Result<render::LookHandle>& handle) {
  std::vector<Loaded> waiting;
  bool kept = false;
  {
    std::lock_guard lock(mutex_);
    if (const auto found = slots_.find(id); found != slots_.end()) {
      Slot& slot = found->second;
      slot.loading = false;
      slot.memory.reset();
      waiting = std::exchange(slot.waiting, {});
      if (handle)
        slot.handle = *handle, kept = true;
      else if (!is_server_failure(handle.error().code))
        slot.damage = handle.error();
    }
  }
  if (handle && !kept) renderer_.remove_look(*handle);  // deleted meanwhile
  if (!handle)
    log::warning("look " + std::to_string(id) + " cannot be shown: " + handle.error().detail);
  for (const Loaded& loaded : waiting) loaded(handle);
  if (kept && ready_) ready_();
}

}  // namespace strata::room
