#pragma once

#include <span>
#include <vector>

#include "domain/scene/model.h"
#include "mesh/atlas/outline.h"
#include "mesh/atlas/packing.h"

namespace strata::mesh {

// share of the texels that lie on the surface; a smaller one is explained
constexpr double kPromisedCoverage = 0.6;

// Why an atlas of these charts uses `coverage` of its texels, less than kPromisedCoverage: at least
// one reason, the weightiest first. Empty where it uses more. `gap`: texels between charts.
std::vector<AtlasReport::Limit> limits_of_packing(std::span<const Outline> outlines,
                                                  const Packing& packing, int side, int gap,
                                                  double coverage);

// Of the file's own coordinates.
std::vector<AtlasReport::Limit> limits_of_file(double coverage);

}  // namespace strata::mesh
