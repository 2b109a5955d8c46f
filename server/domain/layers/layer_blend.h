#pragma once

#include <optional>
#include <string_view>

namespace strata {

// How the colors of a layer are combined with the content below it.
enum class LayerBlend {
  normal,    // covers the content
  multiply,  // only makes the content darker, so relief and photographs stay visible
  screen,    // only makes the content lighter
};
std::optional<LayerBlend> parse_layer_blend(std::string_view name);
std::string_view name(LayerBlend blend);

}  // namespace strata
