#pragma once

#include <optional>
#include <string_view>

namespace strata {

// How a layer's colors are combined with what is below them.
enum class LayerBlend {
  normal,    // covers it
  multiply,  // filters it: only darker, so relief and photographs stay visible
  screen,    // lightens it: only lighter
};
std::optional<LayerBlend> parse_layer_blend(std::string_view name);
std::string_view name(LayerBlend blend);

}  // namespace strata
