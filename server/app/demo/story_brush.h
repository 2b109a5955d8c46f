#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "app/demo/story_places.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile.h"
#include "mesh/texels/surface_map.h"
#include "store/journal/journal.h"

namespace strata::app {

// Paints the strokes of the demo on the outside of the pot. Runs on the CPU and is deterministic.
class StoryBrush {
 public:
  struct Stroke {
    std::vector<StoryPlaces::Place> path;
    double radius_mm = 5;
  };
  using Content = std::map<TileAddress, TileData>;  // content of a layer

  // Both arguments must outlive the object.
  StoryBrush(const StoryPlaces& places, const mesh::SurfaceMap& map) : places_(places), map_(map) {}

  // Writes a value to `content`, or erases the texels if there is no value. Returns the revisions
  // and the result of the edit. The border of the stroke is ragged, as if painted by hand.
  store::JournalEntry paint(const Layer& layer, Content& content, const Stroke& stroke,
                            std::optional<std::uint32_t> value, double metres_per_unit) const;

 private:
  const StoryPlaces& places_;
  const mesh::SurfaceMap& map_;
};

}  // namespace strata::app
