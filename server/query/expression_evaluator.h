#pragma once

#include "core/expression.h"
#include "core/problem.h"
#include "query/texel_selection.h"
#include "query/values.h"

namespace strata::query {

// The surface texels of the map where the condition holds (never gutter texels, and none where it is unknown). A layer of
// another resolution counts by the texel that holds the centre of the map's texel. Refused (422 at `field`): a layer that is not
// among `layers`. Runs on up to `threads` threads.
Result<TexelSelection> select_where(const Expression& condition, const std::vector<LayerView>& layers,
                                    const mesh::SurfaceMap& map, const std::string& field, int threads = 2);

}  // namespace strata::query
