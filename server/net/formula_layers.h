#pragma once

#include "core/progress.h"
#include "net/api/routes.h"
#include "net/http/job_book.h"

namespace strata::net {

// Layers that are computed by an expression over others (Layer::formula). All of it blocks.

// A number or a condition. Refused (422 at `expression`, with the character): what cannot be read.
Result<Expression> parse_formula(const std::string& text);

// What the text reads on this model: names of layers, columns of their records, the surface.
// `self`: the layer that it is for, where there is one; `visibility`: of that layer, whoever sees
// which must see all that it reads. Refused (422 at `expression`, with the character): what cannot
// be read, or names nothing.
Result<LayerFormula> read_formula(const room::Room& room, const std::string& text, bool automatic,
                                  Visibility visibility, std::optional<std::int64_t> self = {});

// Computes the layer's content anew, as one edit of the author, and tells who looks. `overwrites`:
// also where it was edited by hand since (409 without). Returns it as it is then. The normals, the
// height, the slope and the curvature that an expression reads are worked out first, which takes as
// long as their layers do.
Result<Layer> compute_layer(const RouteContext& context, const std::shared_ptr<room::Room>& room,
                            const Layer& layer, const Author& author, Progress& progress,
                            bool overwrites = false);

// POST …/layers with `expression`: makes the layer and computes it; nothing is left of one that
// cannot be computed. 201, or 202 with a job where the surface's shape has to be worked out.
// Without a palette of its own its colours run over the values it has.
Result<Response> create_formula_layer(const RouteContext& context, JobBook& book,
                                      const Request& request,
                                      const std::shared_ptr<room::Room>& room, Layer layer,
                                      bool has_palette,
                                      const std::function<Response(const Layer&)>& answer);

}  // namespace strata::net
