#pragma once

#include <memory>

#include "core/progress.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "jobs/shape_recipe.h"
#include "store/store.h"

namespace strata::mesh {
struct Geometry;
}  // namespace strata::mesh

namespace strata::jobs {

// A layer's content and its metadata.
struct ShapeLayer {
  TileMap tiles;
  std::string unit, description;
  Palette palette;
  nlohmann::json recipe;  // complete: with the same mesh it gives the same texels
};

// Computes the layer of the recipe on the whole surface of the model, as values of `type` at
// `resolution`. `recipe` must be completed; `store` is read for the other model and for source
// files. Refused (invalid, not_found, naming the member): another model or a property that cannot
// be used, a distance to the boundary of a closed model, and values that do not fit the type. Long:
// reports progress, honors cancel. Thread: any that may block.
Result<ShapeLayer> compute_shape_layer(store::Store& store, const Model& model,
                                       const std::shared_ptr<const mesh::Geometry>& geometry,
                                       const ShapeRecipe& recipe, ValueType type, int resolution,
                                       Progress& progress);

// Returns one component (0…2) of the surface's normal at each texel, as f32.
Result<TileMap> paint_normals(const std::shared_ptr<const mesh::Geometry>& geometry, int axis,
                              int resolution, Progress& progress);

// Returns a source file of the model, whole, in memory.
Result<std::vector<std::uint8_t>> read_source(store::Store& store, const Model& model,
                                              const std::string& source, Progress& progress);

// Paints values of a geometry's welded positions (NaN: no value): interpolated for float types, the
// value of the nearest position for whole numbers, which are keys or classes. `invalid` naming
// `type` if a value does not fit. Otherwise as `compute_shape_layer`.
Result<TileMap> paint_vertex_values(const std::shared_ptr<const mesh::Geometry>& geometry,
                                    std::vector<double> values, ValueType type, int resolution,
                                    Progress& progress);

}  // namespace strata::jobs
