#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/ids.h"

namespace strata::store {

class Pool;

// How single users show the layers of models. Part of Store: its rules for threads and errors hold.
class PersonalViews {
 public:
  explicit PersonalViews(Pool& pool) : pool_(pool) {}

  // Returns the user's display of the layers of a model: `layers` of the protocol's PersonalView,
  // with layers by id, also deleted ones. Empty: the default display.
  Result<nlohmann::json> find(const std::string& user, ModelId model_id);
  // Replaces the stored value. too_large: more than 512 KiB.
  Result<void> keep(const std::string& user, ModelId model_id, const nlohmann::json& layers);
  // Shows this user a layer that is hidden by default.
  Result<void> show_layer_to(const std::string& user, ModelId model_id, LayerId layer_id);

 private:
  Pool& pool_;
};

}  // namespace strata::store
