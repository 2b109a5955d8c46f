#include "app/strokes/brush_shape_cache.h"
#include "store/content/tools.h"

namespace strata::app {

Result<FoundTool> BrushShapeCache::find(const std::string& ref) {
  auto tool = STRATA_TRY(store_.tools().find(ref));
  {
    std::lock_guard lock(mutex_);
    if (const auto found = ready_.find(tool.id); found != ready_.end())
      return FoundTool{tool.id, found->second};
  }
  auto bits = STRATA_TRY(store_.tools().shape(tool.id));
  auto shape = std::make_shared<const ShapeTexture>(bits);
  std::lock_guard lock(mutex_);
  // Strokes in progress keep their shapes, and later requests load the shapes again.
  if (ready_.size() >= kMaxReady) ready_.clear();
  ready_[tool.id] = shape;
  return FoundTool{tool.id, std::move(shape)};
}

}  // namespace strata::app
