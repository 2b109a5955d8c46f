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

// The data with which the server finds the texels of an edit. It does not change while one edit is
// computed.
struct RegionContext {
  const mesh::SurfaceMap& map;                  // for the resolution of the edited layer
  const TileMap& tiles;                         // of the edited layer
  const std::vector<query::LayerView>& layers;  // all layers of the model
  double metres;                                // meters per model unit
  store::Store& store;
  SurfaceLookup& surface;
  render::Renderer& renderer;
  render::ModelHandle model;
  Visibility visibility;  // of the edited layer
  Role author;
};

// A position on the surface: its texel (numbered as in mesh::TexelGraph) and its point in model
// space. `find_place` returns an `invalid` error at `field` if there is no texel.
struct PlaceOnSurface {
  std::uint32_t texel = 0;
  glm::vec3 position{0};
};
Result<PlaceOnSurface> find_place(const Place& place, const mesh::SurfaceMap& map,
                                  SurfaceLookup& surface, const std::string& field);
// Combines the selected texels with the texels of another outline.
void combine(TileMasks& selected, const TileMasks& other, Combination combination);
// Returns the texels of an outline and its steps, including the gutter. Waits for the GPU, which
// must have the map.
Result<TileMasks> texels_in(const Outline& outline, const mesh::SurfaceMap& map,
                            const SurfaceLookup& surface, render::Renderer& renderer,
                            render::ModelHandle model);

// These functions return the changes of a fill or a polygon. They block, so call them on worker
// threads. They return the error `invalid` for an expression over missing layers, and for a
// position that is not on the model. They also return errors of the GPU.
Result<std::vector<TileChange>> fill_changes(const FillEdit& fill, ValueType type,
                                             const RegionContext& context);
Result<std::vector<TileChange>> polygon_changes(const PolygonEdit& polygon, ValueType type,
                                                const RegionContext& context);

}  // namespace strata::room
