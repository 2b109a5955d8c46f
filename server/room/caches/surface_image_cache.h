#pragma once

#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/memory_ledger.h"
#include "domain/scene/surface_image.h"
#include "media/picture.h"
#include "render/renderer.h"
#include "room/view_settings.h"
#include "store/store.h"

namespace strata::room {

// The looks that are visible by default, bottom to top, of all by order: the topmost where a view
// takes no more.
std::vector<SurfaceImageView> surface_images_shown(const std::vector<SurfaceImage>& by_order);

// The looks of an open model. A look's texture is made when a view first shows it, on a worker, and
// kept while the room is open; its encoded bytes are kept with it, so that it comes back after a
// lost context without the database. Up to 16384² is shown, which OpenGL 4.5 guarantees, or less
// where the GPU's memory has no room for it. Its pixels are reserved in `memory` until they are on
// the GPU; where there is no room a JPEG is decoded smaller. Thread-safe.
class SurfaceImageCache : public std::enable_shared_from_this<SurfaceImageCache> {
 public:
  // `ready` is called, on any thread, whenever a texture that was asked for is there.
  SurfaceImageCache(store::Store& store, render::Renderer& renderer,
                    boost::asio::thread_pool& workers, MemoryLedger& memory,
                    std::function<void()> ready);

  void put(const SurfaceImage& image);
  void drop(SurfaceImageId id);
  std::vector<SurfaceImage> all() const;                           // by order
  std::optional<SurfaceImage> find(const std::string& ref) const;  // id or slug
  // Forgets the textures, which went with the old handle; they are made again when they are asked
  // for.
  void set_model(render::ModelHandle model);
  void stop();  // nothing more is loaded, and `ready` not called

  // What a view is to show of `wanted` (nothing: what is visible by default, the topmost where
  // there are too many). Textures that are not there yet are left out, and on their way.
  std::vector<render::SurfaceImageStyle> styles(
      const std::optional<std::vector<SurfaceImageView>>& wanted);
  // The same, once all are there. Blocks.
  Result<std::vector<render::SurfaceImageStyle>> wait(
      const std::optional<std::vector<SurfaceImageView>>& wanted);

 private:
  using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;
  using Loaded = std::function<void(const Result<render::SurfaceImageHandle>&)>;
  struct Slot {
    SurfaceImage image;
    Bytes encoded;
    render::SurfaceImageHandle handle = 0;
    bool loading = false;
    MemoryLedger::Share memory;   // of its pixels while it loads
    std::optional<Error> damage;  // the picture cannot be shown, ever
    std::vector<Loaded> waiting;
  };
  // under the mutex
  std::vector<SurfaceImage> by_order() const;
  // under the mutex
  std::vector<SurfaceImageView> shown(
      const std::optional<std::vector<SurfaceImageView>>& wanted) const;
  void request(SurfaceImageId id, const Loaded& loaded);
  void load(SurfaceImageId id, int largest_side);
  Result<Bytes> encoded_bytes(SurfaceImageId id);
  // what its sides are to be divided by
  Result<int> reserve_pixels(SurfaceImageId id, const PictureInfo& info);
  Result<std::shared_ptr<const render::MipmappedPicture>> read(SurfaceImageId id, int largest_side);
  void add(SurfaceImageId id, int largest_side,
           const Result<std::shared_ptr<const render::MipmappedPicture>>& image);
  void on_added(SurfaceImageId id, render::ModelHandle model, int largest_side,
                const Result<render::SurfaceImageHandle>& handle);
  void finish(SurfaceImageId id, const Result<render::SurfaceImageHandle>& handle);

  store::Store& store_;
  render::Renderer& renderer_;
  boost::asio::thread_pool& workers_;
  MemoryLedger& memory_;
  const std::function<void()> ready_;
  mutable std::mutex mutex_;
  std::map<SurfaceImageId, Slot> slots_;
  render::ModelHandle model_ = 0;
  bool stopped_ = false;
};

}  // namespace strata::room
