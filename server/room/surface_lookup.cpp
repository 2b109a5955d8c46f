#include "room/surface_lookup.h"

namespace strata::room {

std::shared_ptr<const mesh::SearchTree> SurfaceLookup::tree() {
  std::call_once(tree_once_, [&] { tree_ = std::make_shared<const mesh::SearchTree>(geometry_); });
  return tree_;
}

Result<std::shared_ptr<const mesh::TexelGraph>> SurfaceLookup::graph(const mesh::SurfaceMap& map) {
  std::lock_guard lock(graphs_mutex_);  // held while it is built: who else asks wants the same
  auto& graph = graphs_[map.resolution];
  if (!graph) {
    auto built = mesh::build_texel_graph(*geometry_, map, progress_);
    if (!built) return tl::unexpected(built.error());
    graph = std::make_shared<const mesh::TexelGraph>(std::move(*built));
  }
  return graph;
}

}  // namespace strata::room
