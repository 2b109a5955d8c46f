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
  nlohmann::json recipe;  // complete, so the same mesh always results in the same texels
};

// Computes the layer of the recipe on the whole surface of the model, as values of `type` at
// `resolution`. `recipe` must be the result of `completed`, and not of the kind `lightness`, whose
// colors a room has. Reads the other model and source files
// from `store`. Returns the Error `invalid` or `not_found`, with the name of the field, if the
// other model or the property cannot be used. Also returns an Error for the boundary distance of a
// closed model, and for values that do not fit the type. Takes long, reports progress and can be
// canceled. Blocks, so call it only on a thread that is allowed to block.
Result<ShapeLayer> compute_shape_layer(store::Store& store, const Model& model,
                                       const std::shared_ptr<const mesh::Geometry>& geometry,
                                       const ShapeRecipe& recipe, ValueType type, int resolution,
                                       Progress& progress);

// Returns the layer with this content, of values of `type`. `other` is as in description_of.
ShapeLayer described(TileMap tiles, const ShapeRecipe& recipe, const Model& model, ValueType type,
                     const std::string& other);

// Returns one component (0…2) of the surface normal at each texel, as f32.
Result<TileMap> paint_normals(const std::shared_ptr<const mesh::Geometry>& geometry, int axis,
                              int resolution, Progress& progress);

// Returns the whole content of a source file of the model.
Result<std::vector<std::uint8_t>> read_source(store::Store& store, const Model& model,
                                              const std::string& source, Progress& progress);

// Paints values that are given for a geometry's welded positions (NaN: no value). Float types are
// interpolated. Integer types are keys or classes and get the value of the nearest position.
// Returns the Error `invalid` with the field `type` if a value does not fit the type. Takes
// long, reports progress and can be canceled.
Result<TileMap> paint_vertex_values(const std::shared_ptr<const mesh::Geometry>& geometry,
                                    std::vector<double> values, ValueType type, int resolution,
                                    Progress& progress);

}  // namespace strata::jobs
