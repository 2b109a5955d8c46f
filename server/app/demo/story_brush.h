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

// Paints the demo's strokes on the outside of its pot, on the CPU. Deterministic.
class StoryBrush {
 public:
  struct Stroke {
    std::vector<StoryPlaces::Place> path;
    double radius_mm = 5;
  };
  using Content = std::map<TileAddress, TileData>;  // of a layer

  // both outlive it
  StoryBrush(const StoryPlaces& places, const mesh::SurfaceMap& map) : places_(places), map_(map) {}

  // Writes a value (nothing: erases) into `content`, and returns the revisions and the answer of
  // the edit. The border is ragged, as a hand paints.
  store::JournalEntry paint(const Layer& layer, Content& content, const Stroke& stroke,
                            std::optional<std::uint32_t> value, double metres_per_unit) const;

 private:
  const StoryPlaces& places_;
  const mesh::SurfaceMap& map_;
};

}  // namespace strata::app
