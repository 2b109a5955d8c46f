#include "room/selection.h"

namespace strata::room {

void combine(query::TexelSelection& selected, const query::TexelSelection& other,
             Combination combination) {
  for (std::size_t slot = 0; slot < selected.size(); ++slot) switch (combination) {
      case Combination::add: selected[slot] |= other[slot]; break;
      case Combination::subtract: selected[slot] &= ~other[slot]; break;
      case Combination::intersect: selected[slot] &= other[slot]; break;
    }
}

std::vector<LayerRead> layers_compared(const Selection& selection) {
  std::vector<LayerRead> found;
  if (!selection.within) return found;
  (void)for_each_leaf(*selection.within, [&](const Selection::Region& leaf) -> Result<void> {
    const auto* like = std::get_if<Selection::Like>(&leaf.area);
    if (like && like->by == Selection::Like::By::value)
      found.push_back({like->layer, leaf.field + ".like.layer"});
    return {};
  });
  return found;
}

std::vector<std::string> layers_read_by(const Selection& selection) {
  std::vector<std::string> slugs;
  const auto add = [&](std::vector<std::string> more) {
    slugs.insert(slugs.end(), more.begin(), more.end());
  };
  if (selection.where) add(layers_of(*selection.where));
  if (selection.changed) add(selection.changed->layers);
  for (const LayerRead& layer : layers_compared(selection)) add({layer.slug});
  if (selection.within)
    (void)for_each_leaf(*selection.within, [&](const Selection::Region& leaf) -> Result<void> {
      if (const auto* where = std::get_if<Selection::Where>(&leaf.area))
        add(layers_of(where->condition));
      return {};
    });
  return slugs;
}

}  // namespace strata::room
