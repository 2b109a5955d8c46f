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
#include "room/caches/held_picture.h"
#include "room/view_settings.h"
#include "store/store.h"

namespace strata::room {

// Returns the surface images that are visible by default, from bottom to top. If a view cannot show
// all of them, returns the topmost images.
std::vector<SurfaceImageView> surface_images_shown(const std::vector<SurfaceImage>& by_order);

// The surface images of an open model. A worker makes the texture of an image when a view first
// shows the image. The texture stays while the room is open. The cache also keeps the encoded
// bytes, so it can make the texture again after a lost context without the database. A texture has
// up to 16384² texels, which OpenGL 4.5 guarantees, or fewer if the GPU has too little memory. The
// pixels are reserved in `memory` until they are on the GPU. If `memory` is not sufficient, a JPEG
// is decoded at a smaller size. Thread-safe.
class SurfaceImageCache : public std::enable_shared_from_this<SurfaceImageCache> {
 public:
  // `ready` is called, on any thread, when a requested texture is ready.
  SurfaceImageCache(store::Store& store, render::Renderer& renderer,
                    boost::asio::thread_pool& workers, MemoryLedger& memory,
                    std::function<void()> ready);

  void put(const SurfaceImage& image);
  void drop(SurfaceImageId id);
  std::vector<SurfaceImage> all() const;                           // by order
  std::optional<SurfaceImage> find(const std::string& ref) const;  // id or slug
  // Returns the pixels of an image. A JPEG may be reduced to a longer side of at least `side`.
  // Blocks.
  Result<HeldPicture> picture(SurfaceImageId id, int side);
  // Drops the textures, which were deleted with the old handle. They are made again on request.
  void set_model(render::ModelHandle model);
  void stop();  // stops loading, and no longer calls `ready`

  // Returns the images for a view. nullopt requests the images that are visible by default. If
  // there are too many, only the topmost images are returned. Leaves out textures that are not
  // ready yet, and starts to make them.
  std::vector<render::SurfaceImageStyle> styles(
      const std::optional<std::vector<SurfaceImageView>>& requested);
  // Like `styles`, but waits until all textures are ready. Blocks.
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
    MemoryLedger::Share memory;   // for the pixels while the image is loading
    std::optional<Error> damage;  // the reason why the image can never be shown
    std::vector<Loaded> waiting;
  };
  // Call while holding the mutex.
  std::vector<SurfaceImage> by_order() const;
  // Call while holding the mutex.
  std::vector<SurfaceImageView> shown(
      const std::optional<std::vector<SurfaceImageView>>& requested) const;
  void request(SurfaceImageId id, const Loaded& loaded);
  void load(SurfaceImageId id, int largest_side);
  Result<Bytes> encoded_bytes(SurfaceImageId id);
  // Reserves memory for the pixels. Returns the number by which the sides must be divided.
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
