#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/ids.h"

namespace strata::store {

class Pool;

// The display settings of each user for the layers of models. Part of Store, whose rules for
// threads and errors apply.
class PersonalViews {
 public:
  explicit PersonalViews(Pool& pool) : pool_(pool) {}

  // Returns the settings of the user for the layers of a model: `layers` of PersonalView in the
  // protocol, with layers by id, also deleted ones. Returns an empty value for the default display.
  Result<nlohmann::json> find(const std::string& user, ModelId model_id);
  // Replaces the stored value. Returns a `too_large` error for more than 512 KiB.
  Result<void> keep(const std::string& user, ModelId model_id, const nlohmann::json& layers);
  // Makes a layer that is hidden by default visible to this user.
  Result<void> show_layer_to(const std::string& user, ModelId model_id, LayerId layer_id);

 private:
  Pool& pool_;
};

}  // namespace strata::store
