#pragma once

#include <span>
#include <vector>

#include "domain/scene/model.h"
#include "mesh/atlas/outline.h"
#include "mesh/atlas/packing.h"

namespace strata::mesh {

// promised share of the texels that lie on the surface; a smaller one is explained
constexpr double kPromisedCoverage = 0.6;

// The reasons why an atlas of these charts has a `coverage` below kPromisedCoverage: at least one,
// the most important first. Empty where the coverage is high enough. `gap`: texels between charts.
std::vector<AtlasReport::Limit> limits_of_packing(std::span<const Outline> outlines,
                                                  const Packing& packing, int side, int gap,
                                                  double coverage);

// For the file's own coordinates.
std::vector<AtlasReport::Limit> limits_of_file(double coverage);

}  // namespace strata::mesh
