#pragma once

#include <optional>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"

namespace strata::app {

// The table of the records in a request. The request names the table or a layer of the table.
struct RecordPlace {
  Table table;  // as visible to the user
  std::optional<Model> model;
  std::optional<Layer> layer;
};

}  // namespace strata::app
