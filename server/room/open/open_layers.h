#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/ids.h"
#include "room/layers.h"
#include "room/open/open_room.h"

namespace strata::room {

// Returns whether the stored properties of a layer, or its last computation, are newer than those
// that a room has. A computation does not change the version.
bool is_newer(const Layer& stored, const Layer& held);

class OpenRoom::LayersPart final : public Layers {
 public:
  explicit LayersPart(OpenRoom& room) : room_(room) {}
  std::vector<Layer> all() const override;
  Result<Layer> find(const std::string& ref) const override;
  Result<Layer> create(Layer layer, const store::IdempotentResponse<Layer>& answer,
                       std::vector<Column> columns) override;
  Result<Layer> update(Layer layer, const store::IdempotentResponse<Layer>& answer) override;
  Result<Layer> widen(const Layer& layer, ValueType type,
                      const store::IdempotentResponse<Layer>& answer) override;
  Result<void> erase(LayerId id, const store::IdempotentResponse<>& answer) override;
  Result<void> put_in_trash(LayerId id, const store::IdempotentResponse<>& answer) override;
  Result<store::TrashRestored> restore(
      const store::TrashEntry& entry,
      const store::IdempotentResponse<store::TrashRestored>& answer) override;
  Result<Layer> mark_computed(LayerId id, const std::string& expression, std::int64_t sequence,
                              const std::map<TableId, std::int64_t>& tables) override;
  void records_changed(TableId table_id) override;
  Result<void> check_expression(const Expression& expression, const std::string& field,
                                Visibility layer, const std::vector<Layer>& planned) const override;

  // For a room that follows another node (room/open/following.h): replaces the properties of the
  // layers by the stored ones, and unloads the layers that are not stored. Keeps the content of the
  // others. Returns the layers that the caller must load: new layers, and those whose type has
  // changed. Does not wait for the database or the GPU.
  std::vector<LayerId> take(const std::vector<Layer>& stored);
  // Loads a layer from the database, instead of its present content if the room has the layer.
  // Returns `gpu_lost` if the room has other data on the GPU at the end. In a room with a claim, it
  // must run within `exclusively`. Blocks.
  Result<void> load(LayerId id);

  // Marks computed layers that match `reads` as stale, and notifies listeners. Runs on the strand.
  void outdate(const std::function<bool(const LayerFormula&)>& reads);
  // Replaces the layer of the room by the stored one, and notifies listeners. Runs on the strand.
  Layer replace(const Layer& stored);

 private:
  Result<void> unload(LayerId id, const std::function<Result<void>()>& in_store);
  void drop(LayerId id);  // removes the layer from the room; on the strand
  // Adds or replaces a layer that was uploaded to this model on the GPU. Returns false if the room
  // has another one, or is about to have one. Runs on the strand.
  bool put(const LayerState& state, render::ModelHandle model);

  OpenRoom& room_;
};

}  // namespace strata::room
