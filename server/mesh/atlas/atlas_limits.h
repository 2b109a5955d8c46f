#pragma once

#include <span>
#include <vector>

#include "domain/scene/model.h"
#include "mesh/atlas/outline.h"
#include "mesh/atlas/packing.h"

namespace strata::mesh {

// promised share of the texels with surface; the report explains a smaller share
constexpr double kPromisedCoverage = 0.6;

// Returns the reasons why an atlas of these charts has a `coverage` below kPromisedCoverage. The
// list has at least one reason and begins with the most important one. It is empty if the coverage
// is high enough. `gap` is the number of texels between charts.
std::vector<AtlasReport::Limit> limits_of_packing(std::span<const Outline> outlines,
                                                  const Packing& packing, int side, int gap,
                                                  double coverage);

// Returns the reasons for an atlas with the file's own coordinates.
std::vector<AtlasReport::Limit> limits_of_file(double coverage);

}  // namespace strata::mesh
