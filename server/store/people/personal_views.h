#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/ids.h"

namespace strata::store {

class Pool;

// How single people show the layers of models. Part of Store: its rules for threads and errors
// hold.
class PersonalViews {
 public:
  explicit PersonalViews(Pool& pool) : pool_(pool) {}

  // How the person shows the layers of a model: `layers` of the protocol's PersonalView, with
  // layers by id, also those that are gone. Empty: as everybody sees them at first.
  Result<nlohmann::json> find(const std::string& user, ModelId model_id);
  // In place of what was kept. too_large: more than a MiB.
  Result<void> keep(const std::string& user, ModelId model_id, const nlohmann::json& layers);
  // A layer that everybody else does not see at first: this person does.
  Result<void> show_layer_to(const std::string& user, ModelId model_id, LayerId layer_id);

 private:
  Pool& pool_;
};

}  // namespace strata::store
