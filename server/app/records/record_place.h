#pragma once

#include <optional>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"

namespace strata::app {

// The table of the records in a request, named directly or as the table of a layer.
struct RecordPlace {
  Table table;  // as visible to the user
  std::optional<Model> model;
  std::optional<Layer> layer;
};

}  // namespace strata::app
