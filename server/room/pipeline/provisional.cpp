#include "room/pipeline/provisional.h"

#include "domain/layers/mask_texels.h"
#include "room/pipeline/tile_past.h"
#include "store/journal/journal_reads.h"

namespace strata::room {

Result<TileMap> read_provisional(store::Store& store, const Layer& layer) {
  const auto waiting = STRATA_TRY(store.journal().under_review(layer.id, Decision::accept, {}));
  if (waiting.edits.empty()) return TileMap{};
  std::vector<std::int64_t> sequences;
  for (const auto& edit : waiting.edits) sequences.push_back(edit.sequence);
  return read_provisional(store, layer, sequences, {});
}

Result<TileMap> read_provisional(store::Store& store, const Layer& layer,
                                 std::span<const std::int64_t> edits, const TileMap& before) {
  const auto written = STRATA_TRY(store.journal().written_by(layer, edits));
  TileMap tiles;
  for (const auto& [tile, texels] : written) {
    // The values of the texels do not affect the result.
    const auto resolver = STRATA_TRY(
        resolve_tile(TileData(layer.type), texels, layer, tile, store, [](PastRevision&) {}));
    const auto known = before.find(tile);
    if (known != before.end() || resolver.provisional().any())
      tiles[tile] = with_provisional(known == before.end() ? nullptr : known->second,
                                     {tile, nullptr, nullptr, texels, resolver.provisional()});
  }
  return tiles;
}

std::shared_ptr<const TileData> with_provisional(const std::shared_ptr<const TileData>& before,
                                                 const TileChange& change) {
  auto after =
      before ? std::make_shared<TileData>(*before) : std::make_shared<TileData>(ValueType::u8);
  for_each_texel(change.written, [&](int texel) {
    if (change.provisional.test(texel))
      after->write(texel, 1);
    else
      after->clear(texel);
  });
  return after;
}

std::shared_ptr<const Palette> provisional_palette() {
  // Dark lines. They are distinct in grayscale and on the colors of any palette, and leave the
  // content below readable.
  static const auto kHatch =
      std::make_shared<const Palette>(Palette{.mode = PaletteMode::categorical,
                                              .points = {{.at = 1,
                                                          .color = {24, 24, 24, 230},
                                                          .label = {},
                                                          .value = {},
                                                          .pattern = Pattern::hatch,
                                                          .angle = 135}},
                                              .column = {}});
  return kHatch;
}

void add_styles(const render::LayerStyle& style, std::optional<render::LayerHandle> waiting,
                std::vector<render::LayerStyle>& styles) {
  styles.push_back(style);
  if (waiting)
    styles.push_back({.layer = *waiting,
                      .palette = provisional_palette(),
                      .opacity = style.opacity,
                      .bare = true});
}

}  // namespace strata::room
