#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/memory_ledger.h"
#include "core/progress.h"
#include "mesh/rollout/rollout_sheet.h"
#include "mesh/surface/search_tree.h"
#include "mesh/texels/texel_graph.h"

namespace strata::room {

// The data that questions about a model's surface need. It is built on first use. The calls block
// during the build, so call them from worker threads. Thread-safe.
class SurfaceLookup {
 public:
  // `memory` must outlive this object.
  SurfaceLookup(std::shared_ptr<const mesh::Geometry> geometry, MemoryLedger& memory)
      : geometry_(std::move(geometry)), memory_(memory) {}

  const mesh::Geometry& geometry() const { return *geometry_; }
  std::shared_ptr<const mesh::SearchTree> tree();
  // Returns the error `out_of_memory` if the budget of main memory is too small.
  Result<std::shared_ptr<const mesh::TexelGraph>> graph(const mesh::SurfaceMap& map);
  // Fits the sheet of a rollout (mesh::fit_sheet). Keeps the last sheets, because users paint many
  // parts on one sheet. Checks the current question.
  Result<std::shared_ptr<const mesh::FittedSheet>> sheet(const mesh::FitRequest& request,
                                                         const std::optional<double>& cut,
                                                         const std::string& up);
  // Drops all graphs, which are then built again on use. Returns false if there is no graph, or if
  // one is being built.
  bool drop_graphs();
  void stop() { progress_.cancel(); }

 private:
  const std::shared_ptr<const mesh::Geometry> geometry_;
  Progress progress_;
  std::once_flag tree_once_;
  std::shared_ptr<const mesh::SearchTree> tree_;
  Result<std::shared_ptr<const mesh::TexelGraph>> find_or_build(const mesh::SurfaceMap& map);

  struct Graph {
    std::shared_ptr<const mesh::TexelGraph> graph;
    MemoryLedger::Share share;  // empty until the memory was reserved
  };
  MemoryLedger& memory_;
  std::mutex graphs_mutex_;
  std::map<int, Graph> graphs_;  // by resolution

  struct Sheet {
    mesh::FitRequest request;
    std::optional<double> cut;
    std::string up;
    std::shared_ptr<const mesh::FittedSheet> sheet;
  };
  static constexpr std::size_t kSheets = 8;
  std::mutex sheets_mutex_;
  std::list<Sheet> sheets_;  // newest first
};

}  // namespace strata::room
