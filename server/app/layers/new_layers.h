#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/edits.h"
#include "core/ids.h"
#include "domain/layers/tile_mirror.h"
#include "store/content/idempotent_response.h"

namespace strata::app {

// Layers that a job creates together with their content. They are hidden until they are painted, so
// users never see an incomplete layer. They are removed if the job fails. Used on the thread of the
// job. Blocks.
class NewLayers {
 public:
  NewLayers(std::shared_ptr<room::Room> room, EditCounters& counters, Author author)
      : room_(std::move(room)), counters_(counters), author_(std::move(author)) {}

  // Creates the layer and paints it as one edit of the author. `recipe` becomes part of its
  // history.
  Result<Layer> add(Layer layer, TileMap tiles, nlohmann::json recipe);
  // Creates the layer and calls `fill`.
  Result<Layer> add(Layer layer, const std::function<Result<Layer>(const Layer&)>& fill);
  // Sets the requested visibility of the layers. The last update also stores `answer`.
  Result<void> show(const store::IdempotentResponse<Layer>& answer);
  void take_back();  // removes all added layers

  std::vector<LayerId> ids() const;

 private:
  Result<Layer> paint(const Layer& created, TileMap tiles, nlohmann::json recipe);

  struct Made {
    Layer layer;
    bool visible;  // as requested
  };
  std::shared_ptr<room::Room> room_;
  EditCounters& counters_;
  const Author author_;
  std::vector<Made> made_;
};

// Returns an `order` that is higher than the `order` of all other layers.
int order_on_top(const std::vector<Layer>& others);

}  // namespace strata::app
