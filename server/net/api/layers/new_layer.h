#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "protocol/messages.h"

// The metadata of layers in requests.
namespace strata::net {

bool is_automatic(const std::optional<protocol::Recompute>& recompute);

// Removes blanks at both ends. Returns nothing for an empty name.
std::optional<std::string> group_of(const std::string& text);

// Returns the layer that the body describes, without its table and its formula. `others` are the
// other layers of the model. Refuses members that do not fit together or the model (422).
Result<Layer> new_layer(const protocol::LayerCreate& body, const Model& model,
                        const std::vector<Layer>& others);

}  // namespace strata::net
