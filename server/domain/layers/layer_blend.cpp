#include "domain/layers/layer_blend.h"

#include <array>

namespace strata {
namespace {
constexpr std::array<std::string_view, 3> kNames{"normal", "multiply", "screen"};
}

std::optional<LayerBlend> parse_layer_blend(std::string_view text) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == text) return static_cast<LayerBlend>(i);
  return std::nullopt;
}

std::string_view name(LayerBlend blend) { return kNames[static_cast<std::size_t>(blend)]; }

}  // namespace strata
