#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/error.h"
#include "domain/layers/layer.h"
#include "query/regions/surface_values.h"
#include "query/regions/water_falls.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct Geometry;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

// Water that runs down a surface.
struct RunOff {
  // The water that passes each texel per length across its way, as f32: in the unit of `rain` times
  // model units. Rain in l/m² on a model in metres gives litres per metre of width.
  SurfaceValues passing;
  // In the unit of `rain` times model units². The water that fell equals the sum of what left the
  // model at edges and from overhangs, and of what stayed in pools.
  double fallen = 0, over_edges = 0, dripped = 0, pooled = 0;
  // The water that fell from edges and overhangs on other parts of the surface, in the same unit.
  double landed = 0;
};

// Water falls off where the surface faces down by more than this angle, in degrees.
inline constexpr double kDripAngle = 30;

inline constexpr int kMaxVisits = 4;

// Returns the texels where water falls off, one word per slot. `map` belongs to the geometry. Needs
// 12 bytes of memory per texel of the map. Fails when cancelled.
Result<std::vector<std::uint64_t>> dripping_texels(
    const std::shared_ptr<const mesh::Geometry>& geometry, const mesh::SurfaceMap& map,
    glm::dvec3 up, Progress& progress, int threads = 1);

// Lets the rain on each texel run down along the surface, from texel to texel. It leaves at the
// open edges of the mesh and at the texels whose bits are set in `drips` (64 per slot): places
// where the surface faces so far down that water falls off. Hollows are full and run over. On a
// piece of surface without such places, the water collects at the lowest texel. Water that leaves
// runs on from the texel where it lands, if there is one (`falls`).
//
// `rain` are amounts per area of the surface; no value, a negative value and a value that is not a
// number are no rain. `type` is their type. `up` is in model axes and has length 1.
//
// From each texel, the water flows to its lower neighbors in proportion to the slopes (Quinn et al.
// 1991), which on a plane is exact for all directions in the atlas. Hollows are filled with
// priority-flood (Barnes, Lehman and Mulla 2014). A narrow stream becomes wider: by about the
// square root of the length of its way, in texels. Water at an open edge flows along the edge while
// a neighbor is lower.
//
// Texels are visited once, from high to low. Where water lands on a texel that was visited before,
// all texels are visited again, at most kMaxVisits times. The rest then counts as pooled: this is
// mostly water in caves without an outlet.
//
// Needs about 32 bytes of memory per texel of the map. Fails when cancelled.
Result<RunOff> run_off(const SurfaceValues& rain, ValueType type, glm::dvec3 up,
                       std::span<const std::uint64_t> drips, const WaterFalls& falls,
                       const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                       Progress& progress);

}  // namespace strata::query
