#include "room/open/contents.h"

#include <algorithm>
#include <future>
#include <iterator>

#include "room/caches/await.h"
#include "room/pipeline/provisional.h"
#include "room/pipeline/tile_changes.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/surface_images.h"
#include "store/journal/journal_reads.h"

namespace strata::room {

LayerState new_state(Layer layer) {
  LayerState state;
  state.mirror = std::make_shared<TileMirror>(layer.type, layer.resolution);
  state.provisional = std::make_shared<TileMirror>(ValueType::u8, layer.resolution);
  state.palette = std::make_shared<const Palette>(layer.palette);
  state.layer = std::move(layer);
  return state;
}

Result<LayerState> read_layer_state(store::Store& store, Layer layer) {
  auto tiles = STRATA_TRY(store.journal().load_tiles(layer));
  auto provisional = STRATA_TRY(read_provisional(store, layer));
  LayerState state = new_state(std::move(layer));
  state.mirror->put(tiles.tiles, tiles.sequence);
  state.provisional->put(provisional, tiles.sequence);
  return state;
}

Result<JournalContents> read_journal(store::Store& store, ModelId model_id,
                                     const std::vector<LayerState>& held) {
  JournalContents contents;
  // The state is read before the tiles. If the tiles contain later edits, the next commit detects
  // the difference, and everything is read again.
  const auto journal = STRATA_TRY(store.journal().state(model_id, {}));
  contents.last_sequence = journal.last_sequence;
  contents.epoch = journal.epoch;
  auto layers = STRATA_TRY(store.layers().of_model(model_id, Role::owner));
  for (Layer& layer : layers) {
    auto state = STRATA_TRY(read_layer_state(store, std::move(layer)));
    for (const LayerState& old : held) {
      if (old.layer.id != state.layer.id) continue;
      auto differing =
          differing_tiles(old.mirror->snapshot().tiles, state.mirror->snapshot().tiles);
      std::ranges::move(
          differing_tiles(old.provisional->snapshot().tiles, state.provisional->snapshot().tiles),
          std::back_inserter(differing));
      if (!differing.empty()) contents.differing[old.layer.id] = std::move(differing);
    }
    contents.layers.push_back(std::move(state));
  }
  return contents;
}

Result<ModelMetadata> read_metadata(store::Store& store, ModelId model_id) {
  auto model = STRATA_TRY(store.models().find(to_string(model_id)));
  auto layers = STRATA_TRY(store.layers().of_model(model_id, Role::owner));
  auto images = STRATA_TRY(store.surface_images().of_model(model_id));
  return ModelMetadata{std::move(model), std::move(layers), std::move(images)};
}

namespace {

using Level = std::shared_ptr<const mesh::Geometry>;

Result<Level> decode(std::span<const std::uint8_t> bytes) {
  auto geometry = STRATA_TRY(mesh::decode_geometry(bytes));
  return std::make_shared<const mesh::Geometry>(std::move(geometry));
}

Result<std::vector<Level>> read_coarser_levels(store::Store& store, ModelId model_id) {
  auto stored = STRATA_TRY(store.models().detail_levels(model_id));
  std::vector<Level> levels;
  for (auto& bytes : stored) {
    auto level = STRATA_TRY(decode(bytes));
    levels.push_back(std::move(level));
    bytes = {};
  }
  return levels;
}

}  // namespace

Result<render::ModelGeometry> read_geometry(store::Store& store, ModelId model_id) {
  // Reading all coarser levels takes about as long as the full mesh, so both are read in parallel.
  auto coarser_later =
      std::async(std::launch::async, [&] { return read_coarser_levels(store, model_id); });
  auto bytes = STRATA_TRY(store.models().geometry(model_id));
  auto full = STRATA_TRY(decode(bytes));
  auto coarser = STRATA_TRY(coarser_later.get());
  return render::ModelGeometry{std::move(full), std::move(coarser)};
}

Result<render::LayerHandle> add_layer(render::Renderer& renderer, render::ModelHandle model,
                                      std::shared_ptr<const TileMirror> mirror) {
  return await<render::LayerHandle>(
      [&](auto done) { renderer.add_layer(model, std::move(mirror), std::move(done)); });
}

Result<LayerHandles> add_layer(render::Renderer& renderer, render::ModelHandle model,
                               const LayerState& layer) {
  auto content = STRATA_TRY(add_layer(renderer, model, layer.mirror));
  auto provisional = add_layer(renderer, model, layer.provisional);
  if (!provisional) {
    renderer.remove_layer(content);
    return tl::unexpected(provisional.error());
  }
  return LayerHandles{content, *provisional};
}

void remove_layer(render::Renderer& renderer, const LayerHandles& handles) {
  renderer.remove_layer(handles.content);
  renderer.remove_layer(handles.provisional);
}

Result<GpuContents> fill_gpu(render::Renderer& renderer, const render::ModelGeometry& geometry,
                             const std::vector<LayerState>& layers) {
  auto model =
      await<render::ModelHandle>([&](auto done) { renderer.add_model(geometry, std::move(done)); });
  if (!model) return tl::unexpected(model.error());
  GpuContents contents{*model, {}};
  for (const LayerState& layer : layers) {
    auto handles = add_layer(renderer, *model, layer);
    if (!handles) {
      renderer.remove_model(*model);
      return tl::unexpected(handles.error());
    }
    contents.layers[layer.layer.id] = *handles;
  }
  return contents;
}

}  // namespace strata::room
