#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/layers/palette.h"
#include "domain/scene/background.h"
#include "domain/scene/light.h"
#include "expression/expression.h"
#include "room/at.h"

namespace strata::room {

// The highlighted records of a database layer.
struct Highlight {
  // Either keys, ascending, or a condition over columns.
  std::variant<std::vector<std::uint32_t>, Expression> records;
  bool isolate = false;  // other records are not drawn
  bool operator==(const Highlight&) const = default;
};

// A user's settings for a layer. For an empty member, the default of the layer applies.
struct LayerView {
  LayerId layer_id = 0;
  std::optional<bool> visible;
  std::optional<double> opacity;
  std::optional<Palette> palette;
  std::optional<Highlight> highlight;  // for database layers
  std::optional<int> order{};          // layers are drawn in ascending order, like Layer::order
};

struct SurfaceImageView {
  SurfaceImageId surface_image_id = 0;
  double opacity = 1;
};

// The settings of one view of a user.
struct ViewSettings {
  std::vector<LayerView> layers;
  // From bottom to top. nullopt: the images that are visible by default.
  std::optional<std::vector<SurfaceImageView>> images;
  Light light;
  Background background{};
  At at{};  // a durable edit, for the state of the layers; nullopt: always the newest state

  // Returns the settings for a layer, or empty settings.
  const LayerView& of(LayerId layer_id) const {
    static const LayerView kNothing;
    const auto last = std::find_if(layers.rbegin(), layers.rend(),
                                   [&](const auto& own) { return own.layer_id == layer_id; });
    return last == layers.rend() ? kNothing : *last;
  }
};

inline const Layer& layer_in(const Layer& layer) { return layer; }
template <class State>
const Layer& layer_in(const State& state) {
  return state.layer;
}

// Sorts layers, or objects with a `layer`, from bottom to top as a user sees them. `of` returns the
// user's settings for a layer, by id.
template <class Layers, class Of>
void sort_as_shown(Layers& layers, const Of& of) {
  const auto place = [&](const auto& each) {
    const Layer& layer = layer_in(each);
    const LayerView* own = of(layer.id);
    return own && own->order ? *own->order : layer.order;
  };
  std::stable_sort(layers.begin(), layers.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
}
template <class Layers>
void sort_as_shown(Layers& layers, const ViewSettings& shown) {
  sort_as_shown(layers, [&](LayerId id) { return &shown.of(id); });
}

}  // namespace strata::room
