#include "room/caches/surface_lookup.h"

#include <algorithm>

#include "domain/people/question.h"

namespace strata::room {

std::shared_ptr<const mesh::SearchTree> SurfaceLookup::tree() {
  const Question::Aside aside;  // questions of other users use the result, too
  std::call_once(tree_once_, [&] { tree_ = std::make_shared<const mesh::SearchTree>(geometry_); });
  return tree_;
}

Result<std::shared_ptr<const mesh::TexelGraph>> SurfaceLookup::graph(const mesh::SurfaceMap& map) {
  auto graph = STRATA_TRY(find_or_build(map));
  // Reserves memory before locking `graphs_mutex_`, because `reserve` may call `drop_graphs`.
  auto share = memory_.reserve(graph->bytes(), "the neighbors of a surface map's texels");
  std::lock_guard lock(graphs_mutex_);
  const auto found = graphs_.find(map.resolution);
  if (found == graphs_.end() || found->second.share.bytes() > 0) return graph;
  if (!share) {
    graphs_.erase(found);
    return tl::unexpected(share.error());
  }
  found->second.share = std::move(*share);
  return graph;
}

Result<std::shared_ptr<const mesh::TexelGraph>> SurfaceLookup::find_or_build(
    const mesh::SurfaceMap& map) {
  const Question::Aside aside;
  // Held during the build, because concurrent callers need the same graph.
  std::lock_guard lock(graphs_mutex_);
  if (const auto found = graphs_.find(map.resolution); found != graphs_.end())
    return found->second.graph;
  auto built = STRATA_TRY(mesh::build_texel_graph(*geometry_, map, progress_));
  auto graph = std::make_shared<const mesh::TexelGraph>(std::move(built));
  graphs_[map.resolution].graph = graph;
  return graph;
}

Result<std::shared_ptr<const mesh::FittedSheet>> SurfaceLookup::sheet(
    const mesh::FitRequest& request, const std::optional<double>& cut, const std::string& up) {
  const auto is_same = [&](const Sheet& each) {
    return each.request == request && each.cut == cut && each.up == up;
  };
  {
    const std::lock_guard lock(sheets_mutex_);
    const auto found = std::ranges::find_if(sheets_, is_same);
    if (found != sheets_.end()) {
      sheets_.splice(sheets_.begin(), sheets_, found);
      return found->sheet;
    }
  }
  // Without the lock, because the question of each user must be able to end.
  auto fitted =
      STRATA_TRY(mesh::fit_sheet([this] { return tree(); }, *geometry_, request, cut, up));
  auto sheet = std::make_shared<const mesh::FittedSheet>(std::move(fitted));
  const std::lock_guard lock(sheets_mutex_);
  std::erase_if(sheets_, is_same);
  sheets_.push_front({request, cut, up, sheet});
  if (sheets_.size() > kSheets) sheets_.pop_back();
  return sheet;
}

bool SurfaceLookup::drop_graphs() {
  const std::unique_lock lock(graphs_mutex_, std::try_to_lock);
  if (!lock || graphs_.empty()) return false;
  graphs_.clear();
  return true;
}

}  // namespace strata::room
