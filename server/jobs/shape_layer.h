#pragma once

#include <memory>

#include "core/progress.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "jobs/shape_recipe.h"
#include "mesh/surface/geometry.h"
#include "store/store.h"

namespace strata::jobs {

// A layer's content, and what is to be said of it.
struct ShapeLayer {
  TileMap tiles;
  std::string unit, description;
  Palette palette;
  nlohmann::json recipe;  // complete: the same again from the same mesh gives the same texels
};

// Computes what the recipe says on the whole surface of the model, as values of `type` at
// `resolution`. `recipe` is completed; `store` is read for the other model and for source files.
// Refused (invalid, not_found, naming the member) where the other model or the property cannot be
// used, where the model is closed and the distance to its boundary is asked for, and where values
// do not fit the type. Long: reports progress, honours cancel. Thread: any that may block.
Result<ShapeLayer> compute_shape_layer(store::Store& store, const Model& model,
                                       const std::shared_ptr<const mesh::Geometry>& geometry,
                                       const ShapeRecipe& recipe, ValueType type, int resolution,
                                       Progress& progress);

// One component (0…2) of the surface's normal at each texel, as f32.
Result<TileMap> paint_normals(const std::shared_ptr<const mesh::Geometry>& geometry, int axis,
                              int resolution, Progress& progress);

// A source file of the model, whole, in memory.
Result<std::vector<std::uint8_t>> read_source(store::Store& store, const Model& model,
                                              const std::string& source, Progress& progress);

// Paints values of a geometry's welded positions (NaN: none): between them for float types, that of
// the nearest position for whole numbers, which are keys or classes. `invalid` naming `type` where
// one does not fit. Otherwise as above.
Result<TileMap> paint_vertex_values(const std::shared_ptr<const mesh::Geometry>& geometry,
                                    std::vector<double> values, ValueType type, int resolution,
                                    Progress& progress);

}  // namespace strata::jobs
