#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "core/progress.h"
#include "mesh/search_tree.h"
#include "mesh/texel_graph.h"

namespace strata::room {

// What questions about a model's surface need, made when first asked for: the calls block meanwhile, so they are for worker
// threads. Thread-safe.
class SurfaceLookup {
 public:
  explicit SurfaceLookup(std::shared_ptr<const mesh::Geometry> geometry) : geometry_(std::move(geometry)) {}

  const mesh::Geometry& geometry() const { return *geometry_; }
  std::shared_ptr<const mesh::SearchTree> tree();
  Result<std::shared_ptr<const mesh::TexelGraph>> graph(const mesh::SurfaceMap& map);
  void stop() { progress_.cancel(); }

 private:
  const std::shared_ptr<const mesh::Geometry> geometry_;
  Progress progress_;
  std::once_flag tree_once_;
  std::shared_ptr<const mesh::SearchTree> tree_;
  std::mutex graphs_mutex_;
  std::map<int, std::shared_ptr<const mesh::TexelGraph>> graphs_;  // by resolution
};

}  // namespace strata::room
