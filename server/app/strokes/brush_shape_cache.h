#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "core/ids.h"
#include "media/shape_texture.h"
#include "store/store.h"

namespace strata::app {

// A tool of the site with its mask, ready to paint.
struct FoundTool {
  ToolId id = 0;
  std::shared_ptr<const ShapeTexture> shape;
};
// Finds a tool by id or slug. May block.
using FindTool = std::function<Result<FoundTool>(const std::string& ref)>;

// Loads the tools of the site and caches their shapes, which never change. Blocks. Thread-safe.
class BrushShapeCache {
 public:
  explicit BrushShapeCache(store::Store& store) : store_(store) {}
  Result<FoundTool> find(const std::string& ref);

 private:
  static constexpr std::size_t kMaxReady = 64;  // each needs 72 KiB

  store::Store& store_;
  std::mutex mutex_;
  std::map<ToolId, std::shared_ptr<const ShapeTexture>> ready_;
};

}  // namespace strata::app
