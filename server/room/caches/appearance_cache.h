#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/memory_ledger.h"
#include "core/progress.h"
#include "domain/scene/surface_image.h"
#include "query/sampling/texel_appearance.h"
#include "room/caches/held_picture.h"

namespace strata::room {

// The colors and normals of a model's texels, for selections of similar surface. They take 4 bytes
// per texel. They are made on first use. This takes 12 bytes per texel and the decoded images, and
// seconds for a map of 4096² texels, in proportion to their number. The calls block, so call them
// from worker threads. Thread-safe.
class AppearanceCache {
 public:
  using Texels = std::shared_ptr<const query::TexelAppearance>;
  // Returns the pixels of an image, which may be reduced to a longer side of at least `side`.
  using ReadImage = std::function<Result<HeldPicture>(const SurfaceImage& image, int side)>;
  // What the colors consist of.
  struct Sources {
    bool vertices = true;              // the colors of the vertices
    std::vector<SurfaceImage> images;  // over them, from bottom to top, with their opacity
  };

  // `memory` must outlive this object.
  AppearanceCache(std::shared_ptr<const mesh::Geometry> geometry, MemoryLedger& memory)
      : geometry_(std::move(geometry)), memory_(memory) {}

  Result<Texels> normals(const mesh::SurfaceMap& map);
  // Returns an `invalid` error without a field if the model has no colors.
  Result<Texels> colors(const mesh::SurfaceMap& map, Sources sources, const ReadImage& read);
  // Drops everything, which is then made again on use. Returns false if there is nothing.
  bool drop();
  // Ends the work on an entry soon. It then fails.
  void stop() { progress_.cancel(); }

 private:
  static constexpr std::size_t kMaxEntries = 4;
  struct Entry {
    std::string key;  // the resolution and the sources
    Texels texels;
    MemoryLedger::Share share;
  };
  using Make = std::function<Result<query::TexelAppearance>()>;
  Texels find(const std::string& key);
  Result<Texels> find_or_make(const std::string& key, const mesh::SurfaceMap& map,
                              const Make& make);
  Result<query::TexelAppearance> make_colors(const mesh::SurfaceMap& map, const Sources& sources,
                                             const ReadImage& read);

  const std::shared_ptr<const mesh::Geometry> geometry_;
  MemoryLedger& memory_;
  Progress progress_;
  // Held while an entry is made, because concurrent callers need the same one. `mutex_` is not held
  // then: a reservation of memory may call `drop`.
  std::mutex making_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // the oldest first
};

}  // namespace strata::room
