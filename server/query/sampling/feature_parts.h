#pragma once

#include <vector>

#include "domain/tables/surface_feature.h"
#include "mesh/surface/search_tree.h"

namespace strata::query {

// Sets `KeyFeature::part` to the part of the model that is nearest to the first position of each
// feature.
void find_parts(std::vector<KeyFeature>& features, const mesh::Geometry& geometry,
                const mesh::SearchTree& tree);

}  // namespace strata::query
