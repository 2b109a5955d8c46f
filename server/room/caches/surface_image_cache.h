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

// Returns the surface images that are visible by default, bottom to top; the topmost ones if a view
// cannot show all.
std::vector<SurfaceImageView> surface_images_shown(const std::vector<SurfaceImage>& by_order);

// The surface images of an open model. A worker makes the texture of an image when a view first
// shows it; the texture stays while the room is open. Its encoded bytes are kept, too, so that
// after a lost context the texture is made without the database. Textures have up to 16384² texels,
// which OpenGL 4.5 guarantees, or fewer if the GPU's memory is insufficient. The pixels are
// reserved in `memory` until they are on the GPU; if there is not enough, a JPEG is decoded at a
// smaller size. Thread-safe.
class SurfaceImageCache : public std::enable_shared_from_this<SurfaceImageCache> {
 public:
  // `ready` is called, on any thread, whenever a requested texture is ready.
  SurfaceImageCache(store::Store& store, render::Renderer& renderer,
                    boost::asio::thread_pool& workers, MemoryLedger& memory,
                    std::function<void()> ready);

  void put(const SurfaceImage& image);
  void drop(SurfaceImageId id);
  std::vector<SurfaceImage> all() const;                           // by order
  std::optional<SurfaceImage> find(const std::string& ref) const;  // id or slug
  // Discards the textures, which were deleted with the old handle; they are made again on request.
  void set_model(render::ModelHandle model);
  void stop();  // loads nothing more, and does not call `ready`

  // Returns the images for a view out of `requested` (nothing: those visible by default, the
  // topmost ones if there are too many). Leaves out textures that are not ready yet, and starts
  // making them.
  std::vector<render::SurfaceImageStyle> styles(
      const std::optional<std::vector<SurfaceImageView>>& requested);
  // The same, but waits until all are ready. Blocks.
  Result<std::vector<render::SurfaceImageStyle>> wait(
      const std::optional<std::vector<SurfaceImageView>>& requested);

 private:
  using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;
  using Loaded = std::function<void(const Result<render::SurfaceImageHandle>&)>;
  struct Slot {
    SurfaceImage image;
    Bytes encoded;
    render::SurfaceImageHandle handle = 0;
    bool loading = false;
    MemoryLedger::Share memory;   // of its pixels while it loads
    std::optional<Error> damage;  // the picture can never be shown
    std::vector<Loaded> waiting;
  };
  // under the mutex
  std::vector<SurfaceImage> by_order() const;
  // under the mutex
  std::vector<SurfaceImageView> shown(
      const std::optional<std::vector<SurfaceImageView>>& requested) const;
  void request(SurfaceImageId id, const Loaded& loaded);
  void load(SurfaceImageId id, int largest_side);
  Result<Bytes> encoded_bytes(SurfaceImageId id);
  // divisor of its sides
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
