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

namespace strata::room {

// Records of a database layer that are to be seen before all others.
struct Highlight {
  // keys, ascending; or a condition over columns
  std::variant<std::vector<std::uint32_t>, Expression> records;
  bool isolate = false;  // the others are not drawn at all
  bool operator==(const Highlight&) const = default;
};

// Layers as one person sees them; what is not set follows the layer's default.
struct LayerView {
  LayerId layer_id = 0;
  std::optional<bool> visible;
  std::optional<double> opacity;
  std::optional<Palette> palette;
  std::optional<Highlight> highlight;  // database layers
  std::optional<int> order{};          // drawn ascending, as Layer::order
};

struct SurfaceImageView {
  SurfaceImageId surface_image_id = 0;
  double opacity = 1;
};

// What one person's view shows.
struct ViewSettings {
  std::vector<LayerView> layers;
  std::optional<std::vector<SurfaceImageView>>
      images;  // bottom to top; nothing: those visible by default
  Light light;
  Background background{};

  // What it says of a layer; of one that it does not name, nothing.
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

// Layers, or what has one as `layer`, from bottom to top as somebody sees them; `of`: what they set
// of a layer, by id.
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
