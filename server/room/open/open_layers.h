#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/ids.h"
#include "room/layers.h"
#include "room/open/open_room.h"

namespace strata::room {

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
                                Visibility layer) const override;

  // For a room that follows another node (room/open/following.h): loads and unloads layers until
  // the room has the stored ones, with their properties and types. The content of other layers
  // stays. Blocks.
  Result<void> take(const std::vector<Layer>& stored);

  // Marks computed layers that match `reads` as stale, and notifies listeners. Runs on the strand.
  void outdate(const std::function<bool(const LayerFormula&)>& reads);
  // Replaces the layer of the room by the stored one, and notifies listeners. Runs on the strand.
  Layer replace(const Layer& stored);

 private:
  Result<void> unload(LayerId id, const std::function<Result<void>()>& in_store);
  // Loads a restored layer. Must run within `exclusively`.
  Result<void> load(LayerId id);
  // Loads a layer whose type has changed. Must run within `exclusively`.
  Result<void> reload(const Layer& stored);

  OpenRoom& room_;
};

}  // namespace strata::room
