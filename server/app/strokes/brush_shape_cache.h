#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "core/ids.h"
#include "media/shape_texture.h"
#include "store/store.h"

namespace strata::app {

// A tool of the site with its mask, ready for painting.
struct FoundTool {
  ToolId id = 0;
  std::shared_ptr<const ShapeTexture> shape;
};
// by id or slug; may block
using FindTool = std::function<Result<FoundTool>(const std::string& ref)>;

// Loads the tools of the site and keeps their shapes, which never change. Blocks, thread-safe.
class BrushShapeCache {
 public:
  explicit BrushShapeCache(store::Store& store) : store_(store) {}
  Result<FoundTool> find(const std::string& ref);

 private:
  static constexpr std::size_t kMaxReady = 64;  // 72 KiB each

  store::Store& store_;
  std::mutex mutex_;
  std::map<ToolId, std::shared_ptr<const ShapeTexture>> ready_;
};

}  // namespace strata::app
