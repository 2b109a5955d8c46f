#pragma once

#include <vector>

#include "domain/layers/tile_mirror.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "query/sampling/values.h"
#include "room/caches/surface_lookup.h"
#include "room/edit.h"
#include "room/pipeline/seen_texels.h"
#include "room/pipeline/tile_changes.h"
#include "store/store.h"

namespace strata::room {

// The data in which the texels of an edit are found. All of it is constant while one edit is
// computed.
struct RegionContext {
  const mesh::SurfaceMap& map;                  // of the edited layer's resolution
  const TileMap& tiles;                         // of the edited layer
  const std::vector<query::LayerView>& layers;  // of the model
  double metres;                                // of a model unit
  store::Store& store;
  SurfaceLookup& surface;
  render::Renderer& renderer;
  render::ModelHandle model;
  Visibility visibility;  // of the edited layer
  Role author;
};

// A place as a surface texel (numbered as in mesh::TexelGraph) and a point in model space. Refused
// (invalid at `field`) if there is no texel.
struct PlaceOnSurface {
  std::uint32_t texel = 0;
  glm::vec3 position{0};
};
Result<PlaceOnSurface> find_place(const Place& place, const mesh::SurfaceMap& map,
                                  SurfaceLookup& surface, const std::string& field);
// Changes the selected texels by those of another outline.
void combine(TileMasks& selected, const TileMasks& other, Combination combination);
// Returns the texels of an outline and its steps, including the gutter. Waits for the GPU, which
// must have the map.
Result<TileMasks> texels_in(const Outline& outline, const mesh::SurfaceMap& map,
                            const SurfaceLookup& surface, render::Renderer& renderer,
                            render::ModelHandle model);

// Return the changes of a fill or a polygon. Block: for worker threads. Refused: an expression over
// layers that do not exist (invalid), a place that is not on the model (invalid), errors of the
// GPU.
Result<std::vector<TileChange>> fill_changes(const FillEdit& fill, ValueType type,
                                             const RegionContext& context);
Result<std::vector<TileChange>> polygon_changes(const PolygonEdit& polygon, ValueType type,
                                                const RegionContext& context);

}  // namespace strata::room
