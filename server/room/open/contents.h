#pragma once

#include <map>
#include <memory>
#include <vector>

#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "domain/scene/surface_image.h"
#include "mesh/surface/geometry.h"
#include "room/pipeline/layer_state.h"
#include "store/store.h"

namespace strata::room {

// The contents of an open room: the layers as in the journal, and their copies on the GPU. All
// functions block.

LayerState new_state(Layer layer);  // empty and not on the GPU

struct JournalContents {
  std::int64_t last_sequence = 0;
  std::int64_t epoch = 0;          // epoch of the model's newest claim (store/nodes/nodes.h)
  std::vector<LayerState> layers;  // with mirrors, without handles
  // By layer: the tiles that differ from `held`.
  std::map<LayerId, std::vector<TileAddress>> differing;
};
Result<JournalContents> read_journal(store::Store& store, ModelId model_id,
                                     const std::vector<LayerState>& held);

// What a room keeps of a model in addition to its geometry and its tiles.
struct ModelMetadata {
  Model model;
  std::vector<Layer> layers;
  std::vector<SurfaceImage> images;
};
Result<ModelMetadata> read_metadata(store::Store& store, ModelId model_id);

// The result has tile mirrors, but no handles of GPU layers.
Result<LayerState> read_layer_state(store::Store& store, Layer layer);

// Returns the mesh of the model and its coarser copies.
Result<render::ModelGeometry> read_geometry(store::Store& store, ModelId model_id);

struct GpuContents {
  render::ModelHandle model = 0;
  std::map<LayerId, LayerHandles> layers;  // by id
};
// Uploads a model, and its layers from their mirrors. On failure, uploads nothing.
Result<GpuContents> fill_gpu(render::Renderer& renderer, const render::ModelGeometry& geometry,
                             const std::vector<LayerState>& layers);
Result<render::LayerHandle> add_layer(render::Renderer& renderer, render::ModelHandle model,
                                      std::shared_ptr<const TileMirror> mirror);
// Adds a layer and the mask of its texels that wait for review. On failure, adds neither.
Result<LayerHandles> add_layer(render::Renderer& renderer, render::ModelHandle model,
                               const LayerState& layer);
void remove_layer(render::Renderer& renderer, const LayerHandles& handles);

}  // namespace strata::room
