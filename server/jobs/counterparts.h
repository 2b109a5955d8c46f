#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "mesh/surface/search_tree.h"
#include "mesh/surface/surface_normals.h"
#include "mesh/texels/texel_owners.h"

namespace strata::jobs {

// One of two models in the same world coordinate system, with the data to find the counterparts of
// texels. Each model may have its own unit.
struct ComparedSide {
  std::shared_ptr<const mesh::Geometry> geometry;
  std::shared_ptr<const mesh::SearchTree> tree;
  mesh::SurfaceNormals normals;
  double metres;  // the length of one unit

  ComparedSide(std::shared_ptr<const mesh::Geometry> the_geometry,
               std::shared_ptr<const mesh::SearchTree> the_tree, double the_metres)
      : geometry(std::move(the_geometry)),
        tree(std::move(the_tree)),
        normals(geometry),
        metres(the_metres) {}
};

struct CounterpartTolerance {
  double metres;    // the largest distance
  float least_cos;  // the cosine of the largest angle between the surfaces
};

// Returns the nearest point of `to` within the tolerance whose triangle faces the same direction as
// the texel. Thread-safe.
std::optional<mesh::SearchTree::Hit> counterpart(const ComparedSide& from,
                                                 const mesh::TexelOwners& owners, std::size_t texel,
                                                 const ComparedSide& to,
                                                 const CounterpartTolerance& tolerance);

// The counterparts of the texels of one model on another model.
struct Counterparts {
  mesh::TexelOwners owners;
  // for each texel: the texture coordinate on the other model; x = kNone: no counterpart
  std::vector<glm::vec2> uv;
  static constexpr float kNone = -1;

  bool has(std::size_t texel) const { return uv[texel].x != kNone; }
  // Returns the texels with a counterpart, one word per slot.
  std::vector<std::uint64_t> matched() const;
};

// Finds the counterparts of all surface texels at `resolution`, for the part from `from` to `to` of
// the task. With `only`, one word per slot, searches only for these texels. Takes long and can be
// cancelled.
Result<Counterparts> find_counterparts(const ComparedSide& here, const ComparedSide& there,
                                       const CounterpartTolerance& tolerance, int resolution,
                                       Progress& progress, double from, double to,
                                       const std::vector<std::uint64_t>* only = nullptr);

// Returns the values of a layer of the other model at the counterparts, as a layer of this model.
Result<TileMap> values_at(const Counterparts& counterparts, const Layer& layer,
                          const TileMap& tiles, Progress& progress);

}  // namespace strata::jobs
