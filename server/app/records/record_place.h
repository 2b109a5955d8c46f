#pragma once

#include <optional>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"

namespace strata::app {

// The table whose records a user works with, on its own or as the table of a layer.
struct RecordPlace {
  Table table;  // as the user sees it
  std::optional<Model> model;
  std::optional<Layer> layer;
};

}  // namespace strata::app
