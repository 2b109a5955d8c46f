#include "render/memory/gpu_layer.h"

namespace strata::render {
namespace {

constexpr int kTilesPerStep = 64;

}  // namespace

Result<bool> GpuLayer::bring() {
  if (is_here_) return true;
  if (!coming_) {
    const auto held = mirror_->snapshot().tiles;
    coming_.emplace(held.begin(), held.end());
  }
  if (auto brought = bring_some(); !brought) {
    leave();
    return tl::unexpected(brought.error());
  }
  if (!coming_->empty()) return false;
  coming_.reset();
  is_here_ = true;
  return true;
}

Result<void> GpuLayer::bring_some() {
  for (int i = 0; i < kTilesPerStep && !coming_->empty(); ++i) {
    const auto& [address, data] = coming_->back();
    auto page = STRATA_TRY(textures_->pool().allocate());
    textures_->pool().upload(page, *data);
    textures_->put_page(address, page);
    coming_->pop_back();
  }
  return {};
}

bool GpuLayer::can_leave() const {
  return mirror_ && textures_->page_count() > 0 && users_.use_count() == 1 && !mirror_->held();
}

void GpuLayer::leave() {
  textures_->free_pages();
  coming_.reset();
  is_here_ = false;
}

}  // namespace strata::render
